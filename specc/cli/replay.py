"""`specc replay`: look at a recorded run again; nothing is simulated."""

from pathlib import Path
from typing import Annotated

import typer

from specc.cli.console import messages, print_text, progress_bar
from specc.cli.portrait import StyleOption
from specc.cli.showing import FilmOption, Pictures, PosterOption, SpeedOption, WatchOption
from specc.figures.style_names import Style


def replay(
    recording: Annotated[
        Path,
        typer.Argument(help="The recording of a scenario, by `specc simulate -o`.", metavar="RUN"),
    ],
    poster: PosterOption = None,
    film: FilmOption = None,
    watch: WatchOption = False,
    speed: SpeedOption = None,
    style: StyleOption = Style.SCREEN,
) -> None:
    """Look at a recorded run: draw a poster or a film of it, or watch it in the terminal.

    Everything comes from the recording: what is drawn is what was recorded, and no spec is needed.
    Without an option it is watched. It looks only, so the exit status is 0 where a requirement is
    violated too, for which `specc simulate` exits with 1; `specc verify` judges it.

    **Examples**

    `specc replay run.mcap --poster run.svg --style journal`

    `specc replay run.mcap --animate run.gif --speed 10`

    `specc replay run.mcap --watch --speed 4`
    """
    from specc.scenarios.replaying import replayed
    from specc.texts.simulation import replay_text

    pictures = Pictures(poster, film, speed, style)
    pictures.refuse_early()
    with progress_bar(f"reading {recording.name}") as bar:
        found = replayed(recording, lambda done, of: bar("reading", done, of))
    if pictures.are_wanted:
        with progress_bar(recording.name) as bar:
            pictures.draw(found.scene, found.trails, bar)
        pictures.tell_written()
    if watch or not pictures.are_wanted:
        from specc.scenarios.watching import rewatch

        rewatch(found.scene, found.trails, messages(), speed=speed or 1.0, style=style)
    print_text(replay_text(found))

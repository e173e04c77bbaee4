"""A run, or its recording, as a picture and as a film."""

from pathlib import Path

from runtime.progress import Progress
from specc.drawn import write_picture
from specc.figures.animation import animate
from specc.figures.scene import Scene, Trails
from specc.figures.style_names import Style
from specc.figures.world import draw_world
from specc.scenarios.pictured import pictured
from specc.scenarios.replaying import replayed
from specc.scenarios.simulating import Simulation


def draw_run(made: Simulation | Path | str, path: Path | str, style: str = Style.SCREEN) -> None:
    """Write the poster of a run as .svg, .png or .pdf.

    Args:
        made: a run, or the path of its recording; the light on the floor is drawn where it was
            kept (`light_every` of `simulate_scenario`).
        path: of the picture.
        style: screen, journal (in grey, with serifs) or dark.

    Raises:
        SpecError: another suffix, a file that can't be written, or no recording of a scenario.
    """
    write_picture(draw_world(*_seen(made), Style(style)), Path(path), Style(style))


def film_run(
    made: Simulation | Path | str,
    path: Path | str,
    *,
    speed: float | None = None,
    style: str = Style.SCREEN,
    progress: Progress | None = None,
) -> None:
    """Write a film of a run as .gif, or as .mp4 where ffmpeg is installed.

    Args:
        made: a run, or the path of its recording.
        path: of the film.
        speed: so many times as fast as real time; None: what makes it 30 s long at most.
        style: as of `draw_run`.
        progress: is told what is drawn, how much of it, and of how much.

    Raises:
        SpecError: another suffix, no ffmpeg, a file that can't be written, or no recording of a
            scenario.
    """
    scene, trails = _seen(made)
    animate(scene, trails, Path(path), progress, style=Style(style), speed=speed)


def _seen(made: Simulation | Path | str) -> tuple[Scene, Trails]:
    if isinstance(made, Simulation):
        return pictured(made.run, made.requirements)
    found = replayed(made)
    return found.scene, found.trails

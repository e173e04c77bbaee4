"""Options by which a run is looked at: a poster, a film, a live view. Shared by two commands."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, TypeAlias, final

import typer

from runtime.progress import Progress
from specc.cli.console import say
from specc.figures.style_names import Style

if TYPE_CHECKING:
    from specc.figures.scene import Scene, Trails

POSTERS: Final = (".svg", ".png", ".pdf")

PosterOption: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--poster",
        metavar="FILE",
        help="Draw the whole run as one picture: .svg, .png or .pdf.",
    ),
]
FilmOption: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--animate",
        metavar="FILE",
        help="Draw the run as a film: .gif, or .mp4 where ffmpeg is installed.",
    ),
]
WatchOption: TypeAlias = Annotated[
    bool,
    typer.Option(
        "--watch",
        "-w",
        help="Show the run while it goes on: in a window where there is a display, else in the "
        "terminal, and as lines where standard error is no terminal.",
    ),
]
SpeedOption: TypeAlias = Annotated[
    float | None,
    typer.Option(
        "--speed",
        min=0.01,
        metavar="TIMES",
        help="Of --watch and --animate: so many times as fast as real time. Default: 1 to watch, "
        "and for a film what makes it 30 s long at most.",
    ),
]


@final
@dataclass(frozen=True, slots=True)
class Pictures:
    """What is to be drawn of a run, and how."""

    poster: Path | None
    film: Path | None
    speed: float | None
    style: Style

    @property
    def are_wanted(self) -> bool:
        """Whether anything is drawn into a file."""
        return self.poster is not None or self.film is not None

    def refuse_early(self) -> None:
        """Refuse what could not be written in the end, before the run begins.

        Raises:
            SpecError: another suffix, or .mp4 without ffmpeg.
        """
        from specc.figures.animation import require_film
        from specc.files import require_suffix

        require_suffix(self.poster, *POSTERS)
        if self.film is not None:
            require_film(self.film)

    def draw(self, scene: "Scene", trails: "Trails", tell: Progress) -> None:
        """Write the files, each whole or not at all."""
        from specc.drawn import write_picture
        from specc.figures.animation import animate
        from specc.figures.world import draw_world

        if self.poster is not None:
            tell("drawing the poster", 0, 1)
            write_picture(draw_world(scene, trails, self.style), self.poster, self.style)
        if self.film is not None:
            animate(scene, trails, self.film, tell, style=self.style, speed=self.speed)

    def tell_written(self) -> None:
        """Name the files that were written."""
        for path in (self.poster, self.film):
            if path is not None:
                say(f"wrote {path} ({size_text(path.stat().st_size)})", "bold")


def size_text(size: int) -> str:
    """The size of a file.

    >>> size_text(812), size_text(48_900), size_text(2_340_000)
    ('812 bytes', '49 kB', '2.3 MB')
    """
    if size < 1000:
        return f"{size} bytes"
    return f"{size / 1e3:.0f} kB" if size < 1e6 else f"{size / 1e6:.1f} MB"

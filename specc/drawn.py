"""A portrait as a file: a picture, or its numbers."""

from pathlib import Path

from specc.figures.bifurcation import draw_bifurcations
from specc.figures.decisions import draw_decisions
from specc.figures.multiples import draw_multiples
from specc.figures.palettes import PALETTES
from specc.figures.portrait import draw_portrait
from specc.figures.style import Picture, rendered
from specc.figures.style_names import Style
from specc.files import json_bytes, unknown_suffix, write_atomically
from specc.portraying import Found, Sweep
from specc.portraying_arbiters import ArbiterPortrait, ArbiterSweep, FoundOfArbiter
from specc.texts.arbiter_portraits import record_of_arbiter
from specc.texts.portrait import record
from verifier.topology.branches.continuation import Branches
from verifier.topology.features import Portrait


def draw(found: Found | FoundOfArbiter, path: Path | str, style: str = Style.SCREEN) -> None:
    """Write a portrait, a sweep or a bifurcation diagram as .svg, .png, .pdf, or as .json.

    style: screen, journal (in grey, with serifs) or dark.
    """
    path = Path(path)
    if path.suffix.lower() == ".json":
        write_atomically(path, json_bytes(_record(found)))
    else:
        write_picture(picture_of(found, Style(style)), path, Style(style))


def _record(found: Found | FoundOfArbiter) -> dict[str, object]:
    if isinstance(found, ArbiterPortrait | ArbiterSweep):
        return record_of_arbiter(found)
    return record(found)


def picture_of(found: Found | FoundOfArbiter, style: Style) -> Picture:
    """The figure that shows what was found."""
    match found:
        case ArbiterPortrait() | ArbiterSweep():
            return draw_decisions(found, style)
        case Portrait():
            return draw_portrait(found, style)
        case Sweep():
            return draw_multiples(found.portraits, found.name, style)
        case Branches():
            return draw_bifurcations(found, style)


def write_picture(picture: Picture, path: Path, style: Style) -> None:
    """Write a figure as .svg, .png or .pdf."""
    palette = PALETTES[style]
    match path.suffix.lower():
        case ".svg":
            write_atomically(path, rendered(picture, "svg", palette))
        case ".png":
            write_atomically(path, rendered(picture, "png", palette))
        case ".pdf":
            write_atomically(path, rendered(picture, "pdf", palette))
        case _:
            raise unknown_suffix(path, ".svg, .png, .pdf, .json")

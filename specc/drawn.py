"""A portrait as a file: a picture, or its numbers."""

from pathlib import Path

from specc.figures.palettes import PALETTES, Style
from specc.figures.portrait import draw_portrait
from specc.figures.style import Picture, rendered
from specc.files import json_bytes, unknown_suffix, write_atomically
from verifier.topology.features import Portrait
from verifier.topology.portrait_json import as_json


def draw(portrait: Portrait, path: Path | str, style: str = Style.SCREEN) -> None:
    """Write a portrait as .svg, .png or .pdf, or its numbers as .json.

    style: screen, journal (in grey, with serifs) or dark.
    """
    path = Path(path)
    if path.suffix.lower() == ".json":
        write_atomically(path, json_bytes(as_json(portrait)))
    else:
        write_picture(draw_portrait(portrait, Style(style)), path, Style(style))


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

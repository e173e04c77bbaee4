"""A portrait as a file: a picture, or its numbers."""

from pathlib import Path

from specc.figures.portrait import draw_portrait
from specc.figures.style import rendered
from specc.files import json_bytes, unknown_suffix, write_atomically
from verifier.topology.features import Portrait
from verifier.topology.portrait_json import as_json


def draw(portrait: Portrait, path: Path | str) -> None:
    """Write a portrait as .svg, .png or .pdf, or its numbers as .json."""
    path = Path(path)
    suffix = path.suffix.lower()
    match suffix:
        case ".json":
            write_atomically(path, json_bytes(as_json(portrait)))
        case ".svg":
            write_atomically(path, rendered(draw_portrait(portrait), "svg"))
        case ".png":
            write_atomically(path, rendered(draw_portrait(portrait), "png"))
        case ".pdf":
            write_atomically(path, rendered(draw_portrait(portrait), "pdf"))
        case _:
            raise unknown_suffix(path, ".svg, .png, .pdf, .json")

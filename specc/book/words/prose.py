"""What every book says alike, from `prose.toml`."""

import tomllib
from functools import cache
from importlib.resources import files


def prose(name: str) -> tuple[str, ...]:
    """The paragraphs, or items, of that name."""
    return _all()[name]


@cache
def _all() -> dict[str, tuple[str, ...]]:
    text = files("specc.book.words").joinpath("prose.toml").read_text(encoding="utf-8")
    return {name: tuple(items) for name, items in tomllib.loads(text).items()}

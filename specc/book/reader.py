"""The reader of tables that goes into a book, as text."""

from importlib.resources import files
from typing import Final

READER: Final = "data/read_table.py"
"""Its place in a book."""


def reader_text() -> str:
    """`read_table.py`, which needs numpy alone."""
    return files("specc.book").joinpath("read_table.py").read_text(encoding="utf-8")

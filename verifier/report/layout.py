"""Plain text laid out: wrapped sentences, bullets, sections and tables."""

import re
import textwrap
from collections.abc import Sequence
from typing import Final

WIDTH: Final = 100
INDENT: Final = "  "
WIDEST: Final = 140
"""Of a table whose last column holds sentences."""
NARROWEST: Final = 40
"""Of such a column."""
NO_BREAK: Final = "\u00a0"


def wrapped(sentence: str, first: str = INDENT) -> str:
    """A sentence on as many lines as it needs; the later ones are indented like the first.

    No line ends between a number and its per cent or its doubt.
    """
    return textwrap.fill(
        re.sub(r" (?=[%±])|(?<=±) ", NO_BREAK, sentence),
        width=WIDTH,
        initial_indent=first,
        subsequent_indent=" " * len(first),
        break_on_hyphens=False,
        break_long_words=False,
    ).replace(NO_BREAK, " ")


def bullets(sentences: Sequence[str]) -> str:
    """A list, one sentence an item."""
    return "\n".join(wrapped(sentence, f"{INDENT}- ") for sentence in sentences)


def section(title: str, blocks: Sequence[str]) -> str:
    """A title over its blocks; nothing where all of them are empty."""
    filled = [block for block in blocks if block]
    return "\n".join([title, *filled]) if filled else ""


def wide_table(rows: Sequence[Sequence[str]]) -> str:
    """A table whose last column holds sentences, on as many lines as they need."""
    columns = range(len(rows[0]) - 1) if rows else range(0)
    used = sum(max(len(row[i]) for row in rows) + 2 for i in columns)
    width = max(WIDEST - used, NARROWEST)
    return table([line for row in rows for line in _lines_of(row, width)])


def _lines_of(row: Sequence[str], width: int) -> list[tuple[str, ...]]:
    """A row, and under it the further lines of its last cell."""
    first, *more = textwrap.wrap(
        row[-1], width, break_on_hyphens=False, break_long_words=False
    ) or [""]
    blank = [""] * (len(row) - 1)
    return [(*row[:-1], first), *((*blank, f"  {line}") for line in more)]


def table(rows: Sequence[Sequence[str]], indent: str = "") -> str:
    """Columns padded to their widest entry, two blanks apart."""
    if not rows:
        return ""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = [
        indent + "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        for row in rows
    ]
    return "\n".join(line.rstrip() for line in lines)

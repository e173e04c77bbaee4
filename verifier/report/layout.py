"""Plain text laid out: wrapped sentences, bullets, sections and tables."""

import re
import textwrap
from collections.abc import Sequence
from typing import Final

WIDTH: Final = 100
INDENT: Final = "  "
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

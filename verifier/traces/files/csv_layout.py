"""How a CSV file is written: its encoding, its header, what parts its cells, its decimal point."""

import csv
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

_DELIMITERS = ",;\t"
_NAMES = {",": "','", ";": "';'", "\t": "a tab"}
_CONTROL = re.compile(r"[\x00-\x08\x0e-\x1f]")
_DECIMAL_COMMA = re.compile(r"\s*[-+]?\d+,\d+(?:[eE][-+]?\d+)?\s*\Z")
_SAMPLE = 50


@final
class LayoutError(Exception):
    """Rows that do not belong to the header; the message says how, `help` what to write."""

    def __init__(self, message: str, help: str) -> None:  # noqa: A002  # as in Diagnostic
        self.message = message
        self.help = help
        super().__init__(message)


@final
@dataclass(frozen=True, slots=True)
class Layout:
    """names: of the columns, as they stand. above: how many lines end with the header.

    comma: whether numbers have a decimal comma.
    """

    names: tuple[str, ...]
    above: int
    delimiter: str
    comma: bool


def encoding_of(head: bytes) -> str:
    """The encoding of a file that begins with `head`."""
    return "utf-16" if head[:2] in {b"\xff\xfe", b"\xfe\xff"} else "utf-8-sig"


def is_csv(head: bytes) -> bool:
    """Whether a file that begins with `head` is text whose first line has several columns."""
    lines = [line for line in decoded(head).splitlines() if line.strip()]
    below = [line for line in lines if not line.startswith("#")]
    first = [line for line in (*lines[:1], *below[:1]) if _delimiter(line) in line]
    return bool(first) and not any(_CONTROL.search(line) or "\ufffd" in line for line in first)


def decoded(head: bytes) -> str:
    """The text; what is cut at its end or can't be decoded is replaced."""
    return head.decode(encoding_of(head), errors="replace")


def cells_of(line: str, delimiter: str) -> list[str]:
    """The cells of a line; none where a quote is not closed in it."""
    if '"' not in line:
        return line.rstrip("\r\n").split(delimiter)
    if line.count('"') % 2:
        return []
    try:
        return next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [])
    except csv.Error:
        return []


def find_layout(head: str) -> Layout:
    """The layout of a file that begins with `head`; raises LayoutError."""
    lines = head.splitlines()
    start = _header_line(lines)
    header = lines[start].lstrip("#").strip() if lines else ""
    # The last line of a long head may be cut.
    rows = [r for r in lines[start + 1 : -1] or lines[start + 1 :] if r.strip() and r[0] != "#"]
    rows = rows[:_SAMPLE]
    delimiter = max(_DELIMITERS, key=lambda d: (_fitting(header, rows, d), header.count(d)))
    names = tuple(name.strip() for name in cells_of(header, delimiter))
    if len(rows) > 2 and not _fitting(header, rows, delimiter):
        raise _strangers(header, rows, names, delimiter)
    return Layout(names, start + 1, delimiter, comma=_has_commas(rows, delimiter))


def _fitting(header: str, rows: Sequence[str], delimiter: str) -> int:
    """How many rows have as many cells as the header, by this delimiter."""
    count = len(cells_of(header, delimiter))
    return sum(len(cells_of(row, delimiter)) == count for row in rows) if count > 1 else -1


def _strangers(
    header: str, rows: Sequence[str], names: Sequence[str], delimiter: str
) -> LayoutError:
    """Why no row has as many cells as the header."""
    other = _delimiter(rows[0])
    count = len(names)
    usual = Counter(len(cells_of(row, delimiter)) for row in rows).most_common(1)[0][0]
    if other in rows[0] and other != _delimiter(header):
        message = (
            f"the header is separated by {_NAMES[_delimiter(header)]}, the rows by {_NAMES[other]}"
        )
        return LayoutError(message, "write one of them throughout")
    if delimiter == "," and usual in {2 * count, 2 * count - 1}:
        message = f"the rows have {usual} cells, the header {count}: decimal commas?"
        return LayoutError(message, "write decimal points, or separate the cells by ';'")
    message = f"the rows have {usual} cells, the header {count}"
    return LayoutError(message, "give each column one name in the first line")


def _has_commas(rows: Sequence[str], delimiter: str) -> bool:
    """Whether some column's cells are all numbers with a decimal comma."""
    if delimiter == "," or not rows:
        return False
    columns = zip(*(cells_of(row, delimiter) for row in rows), strict=False)
    return any(all(map(_DECIMAL_COMMA.match, column)) for column in columns)


def _header_line(lines: Sequence[str]) -> int:
    """The first line that is no comment, or the comment right above it if that names columns."""
    first = next((i for i, line in enumerate(lines) if line.strip() and line[0] != "#"), 0)
    if first and lines[first - 1].startswith("#"):
        above, below = lines[first - 1], lines[first]
        delimiter = _delimiter(below)
        same = above.count(delimiter) == below.count(delimiter) > 0
        if same and re.match(r'\s*"?[-+.\d]', below):
            return first - 1
    return first


def _delimiter(line: str) -> str:
    return max(_DELIMITERS, key=line.count)

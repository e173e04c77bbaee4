"""CSV files: a header line, one row per instant, and a time column that is found and stated."""

import csv
import io
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import final

from spec_schema.diagnostics import SpecError
from verifier.traces.faults import file_fault, nearest_help
from verifier.traces.files.csv_time import Clocked, find_clock
from verifier.traces.files.log import Sheet
from verifier.traces.trace import Loss

_DELIMITERS = ",;\t"
_CONTROL = re.compile(r"[\x00-\x08\x0e-\x1f]")


def is_csv(head: bytes) -> bool:
    """Whether a file that begins with `head` is text whose first line has several columns."""
    text = head.decode("utf-8-sig", errors="replace")
    # A head that was cut in the middle of a letter ends in one replacement character.
    if _CONTROL.search(text) or "\ufffd" in text[:-1]:
        return False
    lines = [line for line in text.splitlines() if line.strip()]
    return any(_delimiter(line) in line for line in lines[:1] + _below_comments(lines)[:1])


def read_csv(path: Path) -> Sheet:
    """The columns as text and the rows' times; raises OSError, and SpecError without a time."""
    raw = path.read_bytes()
    text = raw.decode("utf-8-sig", errors="replace")
    header, body, delimiter = _split(text)
    rows = _read_rows(path, header, body, delimiter)
    clocked = find_clock(rows.columns)
    if clocked is None:
        raise _no_clock(path, tuple(rows.columns))
    losses = [*rows.losses]
    if missing := int((~clocked.valid).sum()):
        losses.append(Loss("rows without a time", missing, f"column '{clocked.column}'"))
    notes = [clocked.note]
    if "\ufffd" in text:
        notes.append("some bytes are not UTF-8; they are read as \ufffd")
    if raw and not raw.endswith((b"\n", b"\r")):
        notes.append("the last line has no end; it may have been cut")
    return Sheet(
        source=str(path),
        columns={name: _kept(cells, clocked) for name, cells in rows.columns.items()},
        times=clocked.times[clocked.valid],
        time_column=clocked.column,
        losses=tuple(losses),
        notes=(*notes, *rows.notes),
    )


def _no_clock(path: Path, names: Sequence[str]) -> SpecError:
    named = "name one column t, time, timestamp or stamp (or stamp_ms, stamp_ns, ...)"
    numbers = [name for name in names if re.match(r"[-+]?(?:\.?\d|nan\Z|inf\Z)", name)]
    if 2 * len(numbers) > len(names):
        return file_fault(path, "V309", "the first line holds numbers, not names", named)
    listed = nearest_help("", names, "columns")
    return file_fault(path, "V309", "no column holds the time", f"{named}\n{listed}")


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Rows:
    columns: dict[str, tuple[str, ...]]
    losses: tuple[Loss, ...]
    notes: tuple[str, ...]


def _split(text: str) -> tuple[list[str], str, str]:
    """The header's names, the text below it, the delimiter."""
    lines = text.splitlines(keepends=True)
    start = _header_line(lines)
    head = lines[start].lstrip("#").strip() if lines else ""
    delimiter = _delimiter(head)
    names = next(csv.reader([head], delimiter=delimiter, skipinitialspace=True), [])
    body = "".join(line for line in lines[start + 1 :] if not line.startswith("#"))
    return [name.strip() for name in names], body, delimiter


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


def _below_comments(lines: Sequence[str]) -> list[str]:
    return [line for line in lines if not line.startswith("#")]


def _delimiter(line: str) -> str:
    return max(_DELIMITERS, key=line.count)


def _read_rows(path: Path, header: list[str], body: str, delimiter: str) -> _Rows:
    reader = csv.reader(io.StringIO(body, newline=""), delimiter=delimiter, skipinitialspace=True)
    rows: list[list[str]] = []
    torn = 0
    ends = [0]
    try:
        for row in reader:
            ends.append(reader.line_num)
            if len(row) == len(header):
                rows.append(row)
            elif row:
                torn += ends[-1] - ends[-2]
    except csv.Error as error:
        raise file_fault(path, "V302", f"the rows can't be read as CSV: {error}") from error
    losses = (
        [Loss("rows with missing or extra cells", torn, f"{len(header)} expected")] if torn else []
    )
    cells = list(zip(*rows, strict=True)) or [()] * len(header)
    columns: dict[str, tuple[str, ...]] = {}
    notes = []
    for name, column in zip(header, cells, strict=True):
        if name in columns:
            notes.append(f"several columns are named '{name}'; the first is read")
        else:
            columns[name] = column
    return _Rows(columns, tuple(losses), tuple(notes))


def _kept(cells: tuple[str, ...], clocked: Clocked) -> tuple[str, ...]:
    return tuple(cell for cell, valid in zip(cells, clocked.valid, strict=True) if valid)

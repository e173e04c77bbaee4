"""CSV files: a header line, one row per instant, and a time column that is found and stated."""

import io
import re
from collections.abc import Sequence
from itertools import islice
from pathlib import Path
from typing import final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from spec_schema.diagnostics import SpecError
from verifier.traces.faults import file_fault, nearest_help
from verifier.traces.files.csv_layout import (
    Layout,
    LayoutError,
    cells_of,
    decoded,
    encoding_of,
    find_layout,
)
from verifier.traces.files.csv_time import Clocked, clock_times, find_clock
from verifier.traces.files.log import Progress, Sheet, Wanted
from verifier.traces.messages.columns import Column
from verifier.traces.trace import Loss

HEAD_BYTES = 1 << 16
_BLOCK_BYTES = 1 << 22
MOST_TEXTS = 1 << 12
"""A column of numbers with more distinct texts than this has no names of values among them."""


def read_csv(path: Path, wanted: Wanted, tell: Progress) -> Sheet:
    """The columns and the rows' times; raises OSError, and SpecError V302 or V309."""
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(HEAD_BYTES)
        try:
            layout = find_layout(decoded(head))
        except LayoutError as error:
            raise file_fault(path, "V302", error.message, error.help) from error
        table = _Table(path, layout, wanted)
        file.seek(0)
        with io.TextIOWrapper(file, encoding=encoding_of(head), errors="replace") as text:
            for _ in islice(text, layout.above):
                pass
            while lines := text.readlines(_BLOCK_BYTES):
                table.take(lines)
                tell(min(file.tell(), size), size)
    return table.finished()


@final
class _Column:
    """The cells of one column: numbers, and texts where these may be names of values."""

    def __init__(self) -> None:
        self._numbers: list[Array] = []
        self._texts: list[str] | None = []
        self._shared: dict[str, str] = {}
        self._any_number = False

    def take(self, cells: Sequence[str]) -> None:
        numbers = _numbers(cells)
        self._numbers.append(numbers)
        self._any_number = self._any_number or bool(np.isfinite(numbers).any())
        if self._texts is not None:
            share = self._shared.setdefault
            self._texts += [share(cell, cell) for cell in cells]
            if len(self._shared) > MOST_TEXTS and self._any_number:
                self._texts, self._shared = None, {}

    def finished(self) -> Column:
        numbers = np.concatenate([np.zeros(0), *self._numbers])
        return Column(numbers, None if self._texts is None else tuple(self._texts))


@final
class _Table:
    """What was read so far of a file, and what could not be."""

    def __init__(self, path: Path, layout: Layout, wanted: Wanted) -> None:
        self.path = path
        self.layout = layout
        self.clocked: Clocked | None = None
        self.times: list[Integers] = []
        self.columns = {
            name: _Column()
            for name in layout.names
            if wanted.columns is None or name in wanted.columns
        }
        self.losses: dict[str, int] = {}
        self.replaced = False
        self.unended = False
        self.last = ""

    def take(self, lines: Sequence[str]) -> None:
        """The next lines of the file."""
        rows = self._rows(lines)
        cells: dict[str, Sequence[str]] = {}
        for name, column in zip(self.layout.names, zip(*rows, strict=True), strict=False):
            cells.setdefault(name, column)
        if not rows:
            return
        if self.layout.comma:
            cells = {key: [c.replace(",", ".") for c in column] for key, column in cells.items()}
        if self.clocked is None:
            self.clocked = find_clock(cells)
        if self.clocked is None:
            raise _no_clock(self.path, tuple(cells))
        times, valid = clock_times(self.clocked, cells)
        self.times.append(times[valid])
        self._lose("rows without a time", int(np.count_nonzero(~valid)))
        for name, column_found in self.columns.items():
            column_found.take(_stripped(cells[name], valid))

    def finished(self) -> Sheet:
        if self.clocked is None:
            self.clocked = find_clock(dict.fromkeys(self.layout.names, ()))
        if self.clocked is None:
            raise _no_clock(self.path, self.layout.names)
        details = {
            "rows with missing or extra cells": f"{len(self.layout.names)} expected",
            "rows without a time": f"column '{self.clocked.column}'",
            "rows with zero bytes": "as a file system leaves them after a crash",
            "last row cut": "without an end, and its last cell is shorter than others",
        }
        empty = Column(np.zeros(0), None)
        columns = {
            name: self.columns[name].finished() if name in self.columns else empty
            for name in self.layout.names
        }
        return Sheet(
            source=str(self.path),
            columns=columns,
            times=np.concatenate([np.zeros(0, dtype=np.int64), *self.times]),
            time_column=self.clocked.column,
            losses=tuple(
                Loss(cause, self.losses[cause], detail)
                for cause, detail in details.items()
                if cause in self.losses
            ),
            notes=tuple(self._notes(self.clocked)),
        )

    def _rows(self, lines: Sequence[str]) -> list[list[str]]:
        """The cells of the rows that have one for each column."""
        rows: list[list[str]] = []
        for line in lines:
            if line.startswith("#") or not line.strip():
                continue
            if "\0" in line:
                self._lose("rows with zero bytes", 1)
                continue
            cells = cells_of(line, self.layout.delimiter)
            if len(cells) == len(self.layout.names):
                rows.append(cells)
            else:
                self._lose("rows with missing or extra cells", 1)
        self.replaced = self.replaced or any("\ufffd" in line for line in lines)
        self.unended = bool(lines) and not lines[-1].endswith("\n")
        if self.unended and _is_cut(rows, lines[-1]):
            rows.pop()
            self._lose("last row cut", 1)
        return rows

    def _lose(self, cause: str, count: int) -> None:
        if count:
            self.losses[cause] = self.losses.get(cause, 0) + count

    def _notes(self, clocked: Clocked) -> list[str]:
        notes = [clocked.note]
        if self.replaced:
            notes.append("some bytes are not UTF-8; they are read as \ufffd")
        if self.unended:
            notes.append("the last line has no end; it may have been cut")
        if self.layout.comma:
            notes.append("decimal commas are read as points")
        names = self.layout.names
        twice = dict.fromkeys(name for name in names if names.count(name) > 1)
        return notes + [f"several columns are named '{name}'; the first is read" for name in twice]


def _is_cut(rows: Sequence[Sequence[str]], line: str) -> bool:
    """Whether the unended last line is a row whose last cell is shorter than all above it."""
    if len(rows) < 3 or not line.endswith(rows[-1][-1]):
        return False
    return len(rows[-1][-1]) < min(len(row[-1]) for row in rows[-50:-1])


def _stripped(cells: Sequence[str], valid: Booleans) -> list[str]:
    return [cell.strip() for cell, kept in zip(cells, valid.tolist(), strict=True) if kept]


def _numbers(cells: Sequence[str]) -> Array:
    try:
        return np.array(cells, dtype=np.float64)
    except ValueError:
        return np.array([_number(cell) for cell in cells], dtype=np.float64)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return np.nan


def _no_clock(path: Path, names: Sequence[str]) -> SpecError:
    named = "name one column t, time, timestamp or stamp (or stamp_ms, stamp_ns, ...)"
    numbers = [name for name in names if re.match(r"[-+]?(?:\.?\d|nan\Z|inf\Z)", name)]
    if 2 * len(numbers) > len(names):
        return file_fault(path, "V309", "the first line holds numbers, not names", named)
    listed = nearest_help("", names, "columns")
    return file_fault(path, "V309", "no column holds the time", f"{named}\n{listed}")

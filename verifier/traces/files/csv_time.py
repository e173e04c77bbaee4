"""Which column of a CSV file holds the time, and in what unit: guessed, and always said."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from typing import final

import numpy as np

from runtime.arrays import Booleans, Integers
from verifier.traces.files.log import LATEST

_NANOSECONDS = {
    "ns": 1,
    "nsec": 1,
    "nanoseconds": 1,
    "us": 1_000,
    "µs": 1_000,
    "ms": 1_000_000,
    "s": 1_000_000_000,
    "sec": 1_000_000_000,
    "secs": 1_000_000_000,
    "seconds": 1_000_000_000,
}
_SHORT = {1: "nanoseconds", 1_000: "microseconds", 1_000_000: "milliseconds", 10**9: "seconds"}
_STEM = (
    r"(?:t|time|timestamp|stamp|time_?stamp|log_?time|elapsed(?:_time)?|(?:\w+\.)*header[._]stamp)"
)
_UNITS = "|".join(sorted(_NANOSECONDS, key=len, reverse=True))
# `t`, `Time [s]`, `%time`, `__time`, `timestamp_ns`, `field.header.stamp`.
_TIME = re.compile(rf"[%#_]*{_STEM}(?:[ _.]*[\[(]?(?P<unit>{_UNITS})[\])]?)?\Z", re.IGNORECASE)
_SECONDS = re.compile(r"(?P<stem>.*\b|.*_)(?:sec|secs|seconds)\Z", re.IGNORECASE)
_REST = ("nanosec", "nanosecs", "nsec", "nsecs", "nanoseconds")


@final
@dataclass(frozen=True, eq=False, slots=True)
class Clocked:
    """times: (rows,) nanoseconds where `valid`; `note` says which column and why this unit.

    scale: nanoseconds a unit. rest: the column of nanoseconds beside a column of whole seconds,
    or empty.
    """

    column: str
    times: Integers
    valid: Booleans
    note: str
    scale: int
    rest: str = ""


def find_clock(columns: Mapping[str, Sequence[str]]) -> Clocked | None:
    """The rows' times from the first column that is named like one."""
    for name, cells in columns.items():
        rest = _rest_column(name, columns)
        if rest is not None:
            return _split_clock(name, rest, columns)
        found = _TIME.match(name)
        if found or re.search(r"_(ns|us|ms)\Z", name):
            unit = found["unit"] if found else name.rsplit("_", 1)[1]
            clocked = _clock(name, cells, unit)
            if clocked.valid.any() or not cells:
                return clocked
    return None


def clock_times(
    clocked: Clocked, columns: Mapping[str, Sequence[str]]
) -> tuple[Integers, Booleans]:
    """The times of further rows by the same column, and which of them have one."""
    times, valid = _nanoseconds(columns[clocked.column], clocked.scale)
    if not clocked.rest:
        return times, valid
    rest, also = _nanoseconds(columns[clocked.rest], 1)
    return times + rest, valid & also


def _rest_column(name: str, columns: Mapping[str, Sequence[str]]) -> str | None:
    """The column of nanoseconds that belongs to a column of whole seconds."""
    found = _SECONDS.match(name)
    stem = found["stem"] if found else ""
    return next((stem + rest for rest in _REST if found and stem + rest in columns), None)


def _split_clock(name: str, rest: str, columns: Mapping[str, Sequence[str]]) -> Clocked:
    seconds, first = _nanoseconds(columns[name], 10**9)
    nanoseconds, second = _nanoseconds(columns[rest], 1)
    note = f"times are '{name}' (seconds) and '{rest}' (nanoseconds)"
    return Clocked(name, seconds + nanoseconds, first & second, note, 10**9, rest)


def _clock(name: str, cells: Sequence[str], unit: str | None) -> Clocked:
    if unit:
        scale = _NANOSECONDS[unit.lower()]
        why = "as its name says"
    else:
        scale = _scale_of(cells)
        why = "seconds since 1970 would be about 1e9" if scale != 10**9 else "no unit in its name"
    times, valid = _nanoseconds(cells, scale)
    note = f"times are column '{name}' in {_SHORT[scale]} ({why})"
    return Clocked(name, times, valid, note, scale)


def _scale_of(cells: Sequence[str]) -> int:
    """The unit in which the values would be times between 1973 and 5138, else seconds."""
    numbers = [abs(number) for cell in cells[:1000] if (number := _number(cell)) is not None]
    size = float(np.median([float(number) for number in numbers])) if numbers else 0.0
    for least, scale in ((1e17, 1), (1e14, 1_000), (1e11, 1_000_000)):
        if size > least:
            return scale
    return 10**9


def _nanoseconds(cells: Sequence[str], scale: int) -> tuple[Integers, Booleans]:
    times = np.zeros(len(cells), dtype=np.int64)
    valid = np.zeros(len(cells), dtype=np.bool_)
    for row, cell in enumerate(cells):
        number = _number(cell)
        if number is not None and abs(number) * scale < LATEST:
            times[row] = round(number * scale)
            valid[row] = True
    return times, valid


def _number(cell: str) -> Decimal | None:
    """Exact: a float holds seconds since 1970 to a quarter of a microsecond only."""
    try:
        number = Decimal(cell)
    except InvalidOperation:
        return None
    return number if number.is_finite() and number.adjusted() < 30 else None

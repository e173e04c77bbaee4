"""Tables with names and categories as the numbers that learners see, and back.

A number stays as it is. Of values in an order a learner sees the index. A value that is one of
several names becomes one column for each name, 1 where it is that one and 0 elsewhere, so that a
rule's interval says "is", "is not" or nothing about it. A gap (None, NaN, NA) becomes NaN.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias, final

import numpy as np

from lcs.arrays import Array
from lcs.faults import LearnerError
from lcs.inputs import Input

Cell: TypeAlias = float | str | None
GAPS: Final = ("NAType", "NaTType")
"""What pandas calls its own gaps."""


@final
@dataclass(frozen=True, slots=True)
class Encoding:
    """The inputs of a table, in its order, and the columns (m) that a learner sees."""

    inputs: tuple[Input, ...]

    def __post_init__(self) -> None:
        names = [each.name for each in self.inputs]
        for each in self.inputs:
            if names.count(each.name) > 1:
                raise LearnerError(f"two inputs are named '{each.name}'")
            if len({*each.values}) < len(each.values):
                raise LearnerError(f"'{each.name}' has a value twice: {', '.join(each.values)}")

    @property
    def columns(self) -> tuple[Input, ...]:
        """What a learner sees, and what rules are read by."""
        return tuple(column for each in self.inputs for column in _columns_of(each))

    def encoded(self, table: Any) -> Array:
        """The numbers (T, m) of a table: a pandas DataFrame, columns by name, or rows in order.

        Raises:
            LearnerError: a column is missing, or a value unknown; with its row and column.
        """
        parts = [
            part
            for each, cells in zip(self.inputs, _cells(table, self.inputs), strict=True)
            for part in _numbers_of(each, cells)
        ]
        if len({len(part) for part in parts}) > 1:
            raise LearnerError("the columns of the table are of different lengths")
        return np.stack(parts, axis=1)

    def decoded(self, x: Array) -> list[tuple[Cell, ...]]:
        """The rows of which `encoded` made numbers (T, m).

        Raises:
            LearnerError: a number stands for no value.
        """
        if x.ndim != 2 or x.shape[1] != len(self.columns):
            raise LearnerError(f"a row is {len(self.columns)} numbers; got shape {x.shape}")
        found: list[Sequence[Cell]] = []
        at = 0
        for each in self.inputs:
            width = len(_columns_of(each))
            found.append(_cells_of(each, x[:, at : at + width]))
            at += width
        return list(zip(*found, strict=True))


def _columns_of(each: Input) -> tuple[Input, ...]:
    if not each.values or each.is_ordered:
        return (each,)
    return tuple(
        Input(f"{each.name} is {value}", values=("no", "yes"), is_ordered=True)
        for value in each.values
    )


def _cells(table: Any, inputs: Sequence[Input]) -> list[Iterable[Any]]:
    """The columns, by name where they have some."""
    if isinstance(table, Mapping) or hasattr(table, "columns"):
        there = list(getattr(table, "columns", table))
        for each in inputs:
            if each.name not in there:
                known = ", ".join(map(str, there))
                raise LearnerError(f"the table has no column '{each.name}': it has {known}")
        return [list(table[each.name]) for each in inputs]
    rows = [list(row) for row in table]
    for i, row in enumerate(rows):
        if len(row) != len(inputs):
            raise LearnerError(f"row {i} has {len(row)} values, and there are {len(inputs)} inputs")
    if not rows:
        return [[] for _ in inputs]
    return list(zip(*rows, strict=True))


def _numbers_of(each: Input, cells: Iterable[Any]) -> list[Array]:
    """One column of numbers, or one for each name."""
    if not each.values:
        return [np.array([_number(each, i, cell) for i, cell in enumerate(cells)], np.float64)]
    place = {value: float(k) for k, value in enumerate(each.values)}
    index = np.array([_index(each, place, i, cell) for i, cell in enumerate(cells)], np.float64)
    if each.is_ordered:
        return [index]
    gaps = np.isnan(index)
    return [np.where(gaps, np.nan, index == k) for k in range(len(each.values))]


def _number(each: Input, row: int, cell: Any) -> float:
    if _is_gap(cell):
        return np.nan
    try:
        return float(cell)
    except (TypeError, ValueError) as error:
        raise LearnerError(f"row {row}, '{each.name}': {cell!r} is no number") from error


def _index(each: Input, place: Mapping[str, float], row: int, cell: Any) -> float:
    if _is_gap(cell):
        return np.nan
    if str(cell) not in place:
        raise LearnerError(
            f"row {row}, '{each.name}': '{cell}' is unknown; known are {', '.join(each.values)}"
        )
    return place[str(cell)]


def _is_gap(cell: Any) -> bool:
    if cell is None or type(cell).__name__ in GAPS:
        return True
    return isinstance(cell, float | np.floating) and bool(np.isnan(cell))


def _cells_of(each: Input, x: Array) -> list[Cell]:
    """The values of an input, of its columns (T, k)."""
    gaps = [bool(row.any()) for row in np.isnan(x)]
    if not each.values:
        return [None if gap else value for gap, value in zip(gaps, x[:, 0].tolist(), strict=True)]
    index: Array = x[:, 0] if each.is_ordered else x @ np.arange(len(each.values))
    fits = (index >= 0) & (index < len(each.values)) & (index == np.floor(index))
    if not each.is_ordered:
        fits &= ((x == 0) | (x == 1)).all(axis=1) & (x.sum(axis=1) == 1)
    for i in np.flatnonzero(~fits & ~np.array(gaps)):
        raise LearnerError(f"row {i}, '{each.name}': {x[i].tolist()} stands for no value")
    return [None if gap else each.values[int(k)] for gap, k in zip(gaps, index, strict=True)]

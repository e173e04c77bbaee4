"""A column: one value of every message, as a number or as text."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers

Cell: TypeAlias = float | str | None


@final
@dataclass(frozen=True, eq=False, slots=True)
class Column:
    """numbers: (T,), NaN where there is none. texts: (T,) for a column of text, else None."""

    numbers: Array
    texts: tuple[str | None, ...] | None

    def rows(self, rows: Integers) -> "Column":
        """These rows, in this order; itself where these are all of them, in their order."""
        if rows.size == self.numbers.size and (rows[1:] > rows[:-1]).all():
            return self
        texts = self.texts
        if texts is not None:
            texts = tuple([texts[row] for row in rows])
        return Column(self.numbers[rows], texts)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Decoded:
    """What a decoder read of T messages.

    columns: one for each leaf asked for. readable: (T,) whether the message could be decoded at
    all; `reason` says what was wrong with the first that could not.
    """

    columns: tuple[Column, ...]
    readable: Booleans
    reason: str


def column(cells: Sequence[Cell]) -> Column:
    """A column of text where any cell is text, else of numbers."""
    if any(isinstance(cell, str) for cell in cells):
        texts = tuple(
            cell if cell is None or isinstance(cell, str) else f"{cell:g}" for cell in cells
        )
        return Column(np.full(len(cells), np.nan), texts)
    numbers = [np.nan if cell is None else float(cell) for cell in cells]
    return Column(np.array(numbers, dtype=np.float64), None)


def joined(parts: Sequence[Column]) -> Column:
    """The parts, one after the other; numbers are written as text where any part has text."""
    if len(parts) == 1:
        return parts[0]
    numbers = np.concatenate([np.zeros(0), *(part.numbers for part in parts)])
    if all(part.texts is None for part in parts):
        return Column(numbers, None)
    texts = (text for part in parts for text in (part.texts or _written(part.numbers)))
    return Column(numbers, tuple(texts))


def _written(numbers: Array) -> list[str | None]:
    return [f"{number:g}" if np.isfinite(number) else None for number in numbers.tolist()]

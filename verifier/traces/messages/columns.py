"""A column: one value of every message, as a number or as text."""

from array import array
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
        """These rows, in this order."""
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


@final
class GrowingColumn:
    """A column, part by part; numbers are written as text where any part has text.

    The numbers lie in one buffer that grows where it is: to keep the parts of a long log, and to
    join them in the end, takes twice the memory.
    """

    def __init__(self) -> None:
        self._numbers = array("d")
        self._texts: list[str | None] | None = None

    def add(self, part: Column) -> None:
        """The next part."""
        if part.texts is not None and self._texts is None:
            self._texts = _written(np.array(self._numbers))
        if self._texts is not None:
            self._texts += _written(part.numbers) if part.texts is None else part.texts
        self._numbers.frombytes(part.numbers.tobytes())

    def finished(self) -> Column:
        """All parts, one behind the other; nothing may be added afterwards."""
        texts = None if self._texts is None else tuple(self._texts)
        return Column(np.frombuffer(self._numbers, dtype=np.float64), texts)


def joined(parts: Sequence[Column]) -> Column:
    """The parts, one behind the other; numbers are written as text where any part has text."""
    whole = GrowingColumn()
    for part in parts:
        whole.add(part)
    return whole.finished()


def _written(numbers: Array) -> list[str | None]:
    return [f"{number:g}" if np.isfinite(number) else None for number in numbers.tolist()]

"""What a classifier gives its learner: numbers of like size, in a known range, without gaps.

T: rows; n: columns. Each column is multiplied by a power of two that brings its range between 1/2
and 1, so that distances between rules weigh all columns alike. That rounds nothing: bounds of rules
are exact in the user's numbers.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any, Final, Literal, Self, TypeAlias, final

import numpy as np

from lcs.arrays import Array, Integers
from lcs.faults import LearnerError
from lcs.given import count_of
from lcs.inputs import Input

Missing: TypeAlias = Literal["refuse", "any"]
OutOfRange: TypeAlias = Literal["clip", "refuse", "as it is"]

MISSING: Final = ("refuse", "any")
OUT_OF_RANGE: Final = ("clip", "refuse", "as it is")
UNCOVERED: Final = ("nearest", "refuse")
"""What is done where no rule holds, unless an answer is given instead."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Intake:
    """Columns, the power of two of each (n,), and what is done with gaps and the unexpected.

    low, high (n,): the declared range; infinite where none is.
    """

    columns: tuple[Input, ...]
    power: Integers
    low: Array
    high: Array
    missing: Missing
    out_of_range: OutOfRange

    @classmethod
    def of(
        cls, columns: Sequence[Input], x: Array, missing: Missing, out_of_range: OutOfRange
    ) -> Self:
        """For columns with declared ranges, or else those of the first rows (T, n).

        Raises:
            LearnerError: a choice is unknown, or a range empty.
        """
        ends = np.array([declared(each) for each in columns], np.float64).reshape(-1, 2)
        first = np.where(np.isnan(x), np.inf, x).min(axis=0, initial=np.inf)
        last = np.where(np.isnan(x), -np.inf, x).max(axis=0, initial=-np.inf)
        with np.errstate(invalid="ignore", over="ignore"):
            width = ends[:, 1] - ends[:, 0]
            width = np.where(np.isfinite(width), width, last - first)
        _, power = np.frexp(np.where(np.isfinite(width) & (width > 0.0), width, 0.75))
        return cls.with_power(columns, power.astype(np.int64), missing, out_of_range)

    @classmethod
    def with_power(
        cls, columns: Sequence[Input], power: Integers, missing: Missing, out_of_range: OutOfRange
    ) -> Self:
        """For columns whose powers (n,) are known.

        Raises:
            LearnerError: a choice is unknown, or a range empty.
        """
        _refuse_unknown("missing", missing, MISSING)
        _refuse_unknown("out_of_range", out_of_range, OUT_OF_RANGE)
        low, high = np.array([declared(each) for each in columns], np.float64).reshape(-1, 2).T
        return cls(tuple(columns), power, low, high, missing, out_of_range)

    def scaled(self, x: Array) -> Array:
        """As the learner sees them."""
        found: Array = np.ldexp(x, -self.power)
        return found

    def unscaled(self, x: Array) -> Array:
        """As the user has them: the exact inverse."""
        found: Array = np.ldexp(x, self.power)
        return found

    def taught(self, x: Array) -> Array:
        """Rows (T, n) to learn from, checked; gaps stay.

        Raises:
            LearnerError: a row has a gap, is infinite or out of the declared range, and that is
                refused.
        """
        self._refuse_what_is_no_number(x)
        return self.scaled(self._within(x, self.low, self.high))

    def asked(self, x: Array, low: Array, high: Array) -> Array:
        """Rows (T, n) to be decided on, where the learner knows the range from low to high (n,).

        Raises:
            LearnerError: a row has a gap, is infinite or out of range, and that is refused.
        """
        self._refuse_what_is_no_number(x)
        known = np.isfinite(self.low)
        if self.out_of_range == "refuse":
            low = np.where(known, self.low, self.unscaled(low))
            high = np.where(np.isfinite(self.high), self.high, self.unscaled(high))
            return self.scaled(self._within(x, low, high))
        return self._within(self.scaled(x), low, high)

    def _refuse_what_is_no_number(self, x: Array) -> None:
        refused = np.isinf(x) if self.missing == "any" else ~np.isfinite(x)
        for row, column in np.argwhere(refused):
            name = self.columns[column].name
            if np.isnan(x[row, column]):
                raise LearnerError(
                    f"row {row}, '{name}' is NaN: leave the row out, fill it in, or set "
                    "missing='any' for rules to pass over it"
                )
            raise LearnerError(f"row {row}, '{name}' is infinite (inf): write a finite number")

    def _within(self, x: Array, low: Array, high: Array) -> Array:
        if self.out_of_range == "clip":
            clipped: Array = np.clip(x, low, high)
            return clipped
        if self.out_of_range == "refuse":
            for row, column in np.argwhere((x < low) | (x > high)):
                raise LearnerError(
                    f"row {row}, '{self.columns[column].name}' is {x[row, column]:g}, out of the "
                    f"range from {low[column]:g} to {high[column]:g}; out_of_range='clip' takes "
                    "the end of the range instead"
                )
        return x


def declared(column: Input) -> tuple[float, float]:
    """The declared range of a column; infinite where none is.

    Raises:
        LearnerError: it is empty.
    """
    if column.values:
        return 0.0, len(column.values) - 1.0
    low = -np.inf if column.low is None else float(column.low)
    high = np.inf if column.high is None else float(column.high)
    if not low <= high:
        raise LearnerError(f"the range of '{column.name}', from {low:g} to {high:g}, is empty")
    return low, high


def without_gaps(x: Array, low: Array, high: Array, chance: np.random.Generator) -> Array:
    """Rows (T, n) with each gap filled by a known value of its column, drawn at random.

    Where the column has none in these rows, one is drawn from the range from low to high (n,).

    Raises:
        LearnerError: nothing is known of a column.
    """
    filled = x.copy()
    for column in np.flatnonzero(np.isnan(x).any(axis=0)):
        gaps = np.isnan(x[:, column])
        donors = x[~gaps, column]
        if donors.size:
            filled[gaps, column] = chance.choice(donors, gaps.sum())
        elif np.isfinite(high[column] - low[column]):
            filled[gaps, column] = chance.uniform(low[column], high[column], gaps.sum())
        else:
            raise LearnerError(f"column {column} is NaN in all rows: leave it out")
    return filled


def _refuse_unknown(name: str, given: str, known: Sequence[str]) -> None:
    if given not in known:
        raise LearnerError(f"{name} is {given!r}: known are {', '.join(map(repr, known))}")


def refuse_parameters(examples: Any, inputs: Sequence[Any] | None, uncovered: Any) -> None:
    """Refuse what would become an answer, or an error far from where it was written.

    Raises:
        LearnerError: one is not what it has to be, or a text nearly one of `UNCOVERED`.
    """
    count_of(examples, "examples")
    for each in () if inputs is None else inputs:
        if not isinstance(each, Input):
            raise LearnerError(f"inputs are a list of specc.Input, and {each!r} is none")
    if not isinstance(uncovered, str) or uncovered in UNCOVERED:
        return
    for near in get_close_matches(uncovered.strip().lower(), UNCOVERED, n=1, cutoff=0.8):
        raise LearnerError(
            f"uncovered is {uncovered!r}; did you mean {near!r}? Choices are 'nearest' and "
            "'refuse', and any other value is itself the answer"
        )

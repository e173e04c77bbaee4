"""What a table of rules decides: by weighted vote, as the thesis has it (4.3.2)."""

from dataclasses import dataclass
from typing import final

import numpy as np
import numpy.typing as npt

from lcs.arrays import Array, Booleans, Integers
from lcs.given import inputs_of
from lcs.rules.kernels import voting
from lcs.rules.table import RuleTable


@final
@dataclass(frozen=True, eq=False, slots=True)
class Decisions:
    """What rules say of T inputs.

    best (T,): the action of the highest expected reward, the first of equals; -1 where some action
    is unknown. expected (T, A): rewards; NaN where nobody votes. voters (T, A): how many voted.
    """

    best: Integers
    expected: Array
    voters: Integers


def decide(table: RuleTable, inputs: npt.ArrayLike) -> Decisions:
    """The decisions on inputs (T, n).

    Raises:
        LearnerError: not n finite numbers each.
    """
    x = checked(table, inputs)
    best = np.zeros(len(x), np.int64)
    expected = np.zeros((len(x), table.actions))
    voters = np.zeros((len(x), table.actions), np.int64)
    voting.decide(
        boxes_of(table),
        table.action,
        table.prediction,
        table.weight,
        columns_of(x),
        best,
        expected,
        voters,
    )
    return Decisions(best, expected, voters)


def matches(table: RuleTable, inputs: npt.ArrayLike) -> Booleans:
    """Which rules hold on which inputs, (R, T) for inputs (T, n).

    Raises:
        LearnerError: not n finite numbers each.
    """
    return boxes_hold(table.lower, table.upper, table.high, checked(table, inputs))


def boxes_hold(lower: Array, upper: Array, high: Array, x: Array) -> Booleans:
    """Which boxes (R, n) hold which inputs (T, n), as (R, T); high (n,): where ranges end."""
    found = np.zeros((len(lower), len(x)), np.bool_)
    contiguous = np.ascontiguousarray
    voting.match(contiguous(lower), contiguous(upper), high, columns_of(x), found)
    return found


def boxes_of(table: RuleTable) -> tuple[Array, Array, Array]:
    """The boxes as kernels want them: lower and upper (R, n), and where ranges end (n,)."""
    return np.ascontiguousarray(table.lower), np.ascontiguousarray(table.upper), table.high


def columns_of(x: Array) -> Array:
    """Inputs (T, n), one input after the other: (n, T)."""
    return np.ascontiguousarray(x.T)


def checked(table: RuleTable, inputs: npt.ArrayLike) -> Array:
    """Inputs (T, n) as the kernels want them.

    Raises:
        LearnerError: not n finite numbers each.
    """
    return inputs_of(inputs, table.lower.shape[1])

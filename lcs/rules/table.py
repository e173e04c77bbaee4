"""A table of rules: what a learner knows, apart from how it learns."""

from dataclasses import dataclass
from typing import final

import numpy as np

from lcs.arrays import Array, Booleans, Integers


@final
@dataclass(frozen=True, eq=False, slots=True)
class RuleTable:
    """R rules for n inputs and so many `actions`.

    action (R,). lower, upper (R, n): a rule holds where lower <= x < upper in each input, and at
    x = upper too where that is `high`. prediction (R,): the reward it expects. weight (R,): what
    its vote counts, above 0. right, wrong (R,): how often what it expected came, and did not.
    low, high (n,): the known range of the inputs; a bound there is no condition.
    """

    actions: int
    action: Integers
    lower: Array
    upper: Array
    prediction: Array
    weight: Array
    right: Integers
    wrong: Integers
    low: Array
    high: Array

    def at_ends(self, x: Array) -> tuple[Array, Booleans]:
        """Inputs (T, n) with what lies beyond the known range taken at its end; and which did (T,).

        A bound at the end of the range is no condition, so a rule that reaches it holds there too.
        """
        if not len(self):
            return x, np.zeros(len(x), np.bool_)
        inside: Array = np.clip(x, self.low, self.high)
        return inside, np.asarray((inside != x).any(axis=1))

    def __len__(self) -> int:
        """How many rules."""
        return len(self.action)

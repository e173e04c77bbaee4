"""An arbiter that does what a policy says, and now and then tries something else for a while."""

from typing import final

import numpy as np

from lcs.policies.policy import Policy
from runtime.arrays import Array

LONGEST_TRY = 64
"""Decisions for which one choice is tried, at most.

Their logarithm is uniform: half of all tries are short, and some last until what a choice leads to
is reached (a dock, and a battery that is full).
"""


@final
class Exploring:
    """Decides by a policy, or by chance, and keeps what it read and chose.

    Args:
        policy: of what it reads.
        reads: how many these are; what it is given besides (its controls) no rule is about.
        choices: how many there are.
        explore: the share of decisions at which, were it not for tries that go on, a try begins.
        chance: of its tries.
        first_try: the number of a decision at which one begins, and none before; None: any time.

    Attributes:
        reads: (m,) at each decision so far.
        choices: at each of them.
    """

    def __init__(
        self,
        policy: Policy,
        reads: int,
        choices: int,
        explore: float,
        chance: np.random.Generator,
        first_try: int | None = None,
    ) -> None:
        self._policy, self._explore, self._chance = policy, explore, chance
        self._reads, self._count = reads, choices
        self._first_try, self._left, self._tried = first_try, 0, 0
        self.reads: list[Array] = []
        self.choices: list[int] = []

    def reset(self, seed: int) -> None:
        """Do nothing: it lives for one run, and its chance was given to it."""

    def decide(self, reads: Array, time: float) -> Array:  # noqa: ARG002  # the policy has no clock
        """1 for the choice."""
        x = np.array(reads[: self._reads])
        if self._left == 0 and self._begins():
            self._left = int(LONGEST_TRY ** self._chance.random())
            self._tried = int(self._chance.integers(self._count))
        if self._left > 0:
            self._left -= 1
            choice = self._tried
        else:
            choice = int(self._policy.decide(x[np.newaxis])[0])
        self.reads.append(x)
        self.choices.append(choice)
        numbers = np.zeros(self._count)
        numbers[choice] = 1.0
        return numbers

    def _begins(self) -> bool:
        """Whether a try begins at this decision."""
        now, first = len(self.choices), self._first_try
        if first is not None and now <= first:
            return now == first
        return bool(self._chance.random() < self._explore)

    def learn(self, reward: float) -> None:
        """Do nothing: rewards are worked out after the run."""

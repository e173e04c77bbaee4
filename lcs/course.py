"""What a learner and whoever runs it say to each other; every learner here fits `Learner`."""

from dataclasses import dataclass
from enum import IntEnum
from typing import Protocol, final

import numpy.typing as npt

from lcs.arrays import Array, Booleans, Integers
from lcs.kernels import kinds
from lcs.rules.table import RuleTable


class Kind(IntEnum):
    """What a cycle was."""

    TEST = kinds.TEST
    TRIED = kinds.TRIED
    FORCED = kinds.FORCED  # tried, since some action was unknown


@final
@dataclass(frozen=True, eq=False, slots=True)
class Course:
    """What went on in T cycles, all (T,).

    kind: `Kind`. action: that was taken. error: of a test |expected - given reward|, else NaN.
    rules, births, deaths: so far, after it.
    """

    kind: Integers
    action: Integers
    error: Array
    rules: Integers
    births: Integers
    deaths: Integers

    @property
    def is_test(self) -> Booleans:
        """Which cycles tested."""
        found: Booleans = self.kind == Kind.TEST
        return found


class Learner(Protocol):
    """A learner with a random state of its own."""

    def act(self, x: npt.ArrayLike) -> int:
        """The action on an input (n,): tried, or the best; `learn` follows one that was tried."""
        ...

    def learn(self, reward: float) -> None:
        """The reward of the action that was tried."""
        ...

    def run(self, inputs: npt.ArrayLike, rewards: npt.ArrayLike) -> Course:
        """A cycle for each input (T, n), where action a would be given rewards (T, A)."""
        ...

    def decide(self, inputs: npt.ArrayLike) -> tuple[Integers, Array]:
        """The best actions (T,), -1 where some action is unknown, and expected rewards (T, A)."""
        ...

    def rules(self) -> RuleTable:
        """What it knows now, as rules."""
        ...

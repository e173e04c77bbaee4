"""What a problem of one step is to those who run a learner on it."""

from typing import Protocol

import numpy as np

from lcs.arrays import Array, Integers
from lcs.inputs import Input


class Problem(Protocol):
    """Inputs (n,) of which each has one class among `classes`; naming it is rewarded."""

    @property
    def name(self) -> str:
        """What it is called in texts and files."""
        ...

    @property
    def inputs(self) -> int:
        """How many numbers an input has, n."""
        ...

    @property
    def classes(self) -> int:
        """How many classes there are, A: a learner's actions."""
        ...

    @property
    def described(self) -> tuple[Input, ...]:
        """What each of the n inputs is called, and what it may be."""
        ...

    @property
    def labels(self) -> tuple[str, ...]:
        """What each class is called."""
        ...

    @property
    def flipped(self) -> float:
        """The chance that a reward is the other one."""
        ...

    def drawn(self, count: int, chance: np.random.Generator) -> tuple[Array, Array, Integers]:
        """So many inputs to learn from (T, n), rewards of all classes (T, A), right ones (T,)."""
        ...

    def fresh(self, count: int, chance: np.random.Generator) -> tuple[Array, Integers]:
        """Inputs to test on (T, n) and their right classes (T,): so many, or all there are."""
        ...

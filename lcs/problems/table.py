"""A table as a problem: rows of inputs with a class, some to learn from and some to test on."""

import dataclasses
from dataclasses import dataclass
from typing import final

import numpy as np

from lcs.arrays import Array, Integers
from lcs.faults import LearnerError
from lcs.inputs import Input
from lcs.problems.rewards import rewards_of


@final
@dataclass(frozen=True, eq=False, slots=True)
class Table:
    """R rows of n inputs x (R, n), in the order of the file, and their classes right (R,).

    learnt, tested: the rows to learn from, which are drawn at random, and those to test on.
    flipped: the chance that a reward is the other one.
    """

    name: str
    described: tuple[Input, ...]
    labels: tuple[str, ...]
    x: Array
    right: Integers
    learnt: Integers
    tested: Integers
    flipped: float = 0.0

    @property
    def inputs(self) -> int:
        """How many inputs a row has."""
        return len(self.described)

    @property
    def classes(self) -> int:
        """How many classes there are."""
        return len(self.labels)

    def drawn(self, count: int, chance: np.random.Generator) -> tuple[Array, Array, Integers]:
        """So many of the rows to learn from (T, n), rewards (T, A) and right classes (T,)."""
        rows = self.learnt[chance.integers(len(self.learnt), size=count)]
        right = self.right[rows]
        return self.x[rows], rewards_of(right, self.classes, self.flipped, chance), right

    def fresh(self, count: int, chance: np.random.Generator) -> tuple[Array, Integers]:
        """Rows to test on (T, n) and their classes (T,): so many of them, or all there are."""
        rows = self.tested
        if count < len(rows):
            rows = np.sort(chance.permutation(rows)[:count])
        return self.x[rows], self.right[rows]


def in_folds(table: Table, folds: int, tested: int) -> Table:
    """The table cut into so many parts in the order of its rows; one is tested on, from 1 on.

    Rows that follow one another in time look alike, so a part that was never seen is a harder
    and more honest test than rows at random.

    Raises:
        LearnerError: there are not so many parts, or not so many rows.
    """
    rows = len(table.x)
    if not 2 <= folds <= rows:
        raise LearnerError(f"folds = {folds}: write 2 parts to {rows} (a row in each)")
    if not 1 <= tested <= folds:
        raise LearnerError(
            f"tested = {tested}: there are {folds} parts (folds), so tested is 1 to {folds}"
        )
    parts = np.array_split(np.arange(len(table.x)), folds)
    learnt = np.concatenate([part for k, part in enumerate(parts, 1) if k != tested])
    return dataclasses.replace(table, learnt=learnt, tested=parts[tested - 1])


def at_random(table: Table, share: float, seed: int = 0) -> Table:
    """The table with this share of its rows, drawn at random, kept to test on.

    Raises:
        LearnerError: no row would be left to learn from, or to test on.
    """
    count = round(share * len(table.x)) if np.isfinite(share) else 0
    if not 0 < count < len(table.x):
        raise LearnerError(
            f"a share of {share:g} of {len(table.x)} rows leaves none to test on, or none to "
            "learn from: write one between 0 and 1, such as 0.25"
        )
    rows = np.random.default_rng(seed).permutation(len(table.x))
    return dataclasses.replace(table, learnt=np.sort(rows[count:]), tested=np.sort(rows[:count]))

"""Boxes as wide as the examples allow, grown from rules: what a small set is chosen from."""

import dataclasses
from dataclasses import dataclass, field
from typing import Final, final

import numpy as np

from lcs.arrays import Array, Booleans, Integers
from lcs.rules.deciding import boxes_hold
from lcs.rules.kernels import growing, voting
from lcs.rules.table import RuleTable

PENALTIES: Final = np.array([1.0, 3.0, 10.0, 100.0, 1e12])
"""What an example of another level counts, sweep by sweep; by the last no box takes it in."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Examples:
    """Of one action: inputs x (T, n), and the same as columns (n, T).

    level (T,); is_told (T,): by a reward, else by the rules.
    count (T,): how many examples it stands for. order (n, T): indices, ascending in each input.
    low, high (n,): the known range.
    """

    x: Array
    columns: Array
    level: Integers
    is_told: Booleans
    count: Integers
    order: Integers
    low: Array
    high: Array


@final
@dataclass(eq=False, slots=True)
class Candidates:
    """Boxes lower, upper (each n,) of a level, in the order in which they were grown.

    held (T,): the examples that are in any of them.
    """

    held: Booleans
    lower: list[Array] = field(default_factory=list)
    upper: list[Array] = field(default_factory=list)
    level: list[int] = field(default_factory=list)

    def boxes(self, those: Integers, n: int) -> tuple[Array, Array]:
        """The lower and upper bounds of some, (C, n) each, of n inputs."""
        lower = np.reshape([self.lower[c] for c in those], (-1, n))
        upper = np.reshape([self.upper[c] for c in those], (-1, n))
        return lower, upper

    def add(self, lower: Array, upper: Array, level: int) -> None:
        """One more."""
        self.lower.append(lower)
        self.upper.append(upper)
        self.level.append(level)


def grown(rules: RuleTable, level: Integers, seen: Examples, to_cover: Booleans) -> Candidates:
    """Candidates that hold all examples `to_cover` (T,), from the rules of one action.

    level (R,): of the rules' predictions. No box holds an example that was told another level.
    First those are covered that were told: from rules of their level, or else from any. Then the
    others are, by boxes of any level.
    """
    found = Candidates(np.zeros(len(seen.x), np.bool_))
    order = _by_evidence(rules, level, seen)
    for is_told in (True, False):
        waiting = np.flatnonzero(to_cover & (seen.is_told == is_told) & ~found.held)
        for of_any_level in (False, True):
            for r in order:
                own = [int(level[r])]
                for each in np.unique(seen.level[waiting]) if of_any_level else own:
                    box = rules.lower[r], rules.upper[r], int(each)
                    waiting = _from_rule(box, seen, waiting, found)
    return found


def denoised(
    rules: RuleTable, level: Integers, seen: Examples, to_cover: Booleans, noise: float
) -> Examples:
    """The examples with the levels of boxes that hold more of one than noise of that share can.

    Of those that are in no such box nothing is told.
    """
    # In a box of one level there are so many right ones for each wrong one; across a decision
    # surface there is about one. What a wrong one counts grows from the latter to near the former.
    penalties = ((1.0 - noise) / noise) ** np.array([0.0, 0.25, 0.5, 0.75])
    # Of so many examples, somewhere so many in a row are wrong by chance in one case of twenty.
    enough = np.log(len(seen.x) / 0.05) / np.log(1.0 / noise)
    of, waiting = np.full(len(seen.x), -1), to_cover & seen.is_told
    for r in _by_evidence(rules, level, seen):
        rows = np.flatnonzero(waiting & (seen.level == level[r]))
        lower, upper = rules.lower[r], rules.upper[r]
        inside = rows[boxes_hold(lower[None], upper[None], seen.high, seen.x[rows])[0]]
        if inside.size < enough:
            continue
        box = lower, upper, int(level[r])
        low, up = grown_box(box, inside, seen, penalties)
        held = boxes_hold(low[None], up[None], seen.high, seen.x)[0]
        right, wrong = counts(low[None], up[None], level[r : r + 1], seen)
        if right[0] > penalties[-1] * wrong[0] + enough:
            of[held & (of < 0)] = level[r]
            waiting &= ~held
    return dataclasses.replace(
        seen, level=np.where(of >= 0, of, seen.level), is_told=seen.is_told & (of >= 0)
    )


def _by_evidence(rules: RuleTable, level: Integers, seen: Examples) -> Integers:
    """The rules, those first that hold most examples of their level and fewest others."""
    right, wrong = counts(rules.lower, rules.upper, level, seen)
    order: Integers = np.argsort(wrong - right, kind="stable")
    return order


def counts(
    lower: Array, upper: Array, level: Integers, seen: Examples
) -> tuple[Integers, Integers]:
    """How many examples of its level, and of others, each box (R, n) holds; of those told."""
    right, wrong = np.zeros(len(level), np.int64), np.zeros(len(level), np.int64)
    boxes = np.ascontiguousarray(lower), np.ascontiguousarray(upper), seen.high
    told = np.where(seen.is_told, seen.count, 0)
    voting.tally(boxes, level, seen.columns, seen.level, told, right, wrong)
    return right, wrong


def _from_rule(
    box: tuple[Array, Array, int], seen: Examples, waiting: Integers, found: Candidates
) -> Integers:
    """Grow boxes around waiting examples of a level in a box; those that still wait.

    box: lower, upper (n,) and the level.
    """
    lower, upper, level = box
    rows = waiting[seen.level[waiting] == level]
    inside = rows[boxes_hold(lower[None], upper[None], seen.high, seen.x[rows])[0]]
    while inside.size:
        low, up = grown_box(box, inside, seen)
        found.add(low, up, level)
        held = boxes_hold(low[None], up[None], seen.high, seen.x)[0]
        found.held |= held
        inside, waiting = inside[~held[inside]], waiting[~held[waiting]]
    return waiting


def _middle(seen: Examples, those: Integers) -> int:
    """The example nearest to the middle of those."""
    width = np.where(seen.high > seen.low, seen.high - seen.low, 1.0)
    x = seen.x[those] / width
    return int(those[((x - x.mean(axis=0)) ** 2).sum(axis=1).argmin()])


def grown_box(
    box: tuple[Array, Array, int],
    around: Integers,
    seen: Examples,
    penalties: Array = PENALTIES,
) -> tuple[Array, Array]:
    """A box, made as wide as it may be around the example in the middle of some in it."""
    lower, upper, level = box
    low, up = lower.copy(), upper.copy()
    count = seen.count * seen.is_told
    worth = np.where(seen.level == level, count, 0.0), np.where(seen.level != level, count, 0.0)
    ends = (low, up, seen.low, seen.high)
    growing.grow(seen.columns, seen.order, worth, _middle(seen, around), ends, penalties)
    return low, up

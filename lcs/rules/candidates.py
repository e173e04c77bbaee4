"""Boxes as wide as the examples allow, grown from rules: what a small set is chosen from."""

from dataclasses import dataclass, field
from typing import Final, final

import numpy as np

from lcs.arrays import Array, Booleans, Integers
from lcs.rules.deciding import boxes_hold
from lcs.rules.kernels import growing, voting
from lcs.rules.table import RuleTable

NEVER: Final = 1e12
"""The penalty of an example that no box may take in."""


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

    is_rule: taken over from the table as it was. of (T,): the level whose boxes have to hold an
    example; -1 of those that nobody has to.
    """

    of: Integers
    lower: list[Array] = field(default_factory=list)
    upper: list[Array] = field(default_factory=list)
    level: list[int] = field(default_factory=list)
    is_rule: list[bool] = field(default_factory=list)

    def boxes(self, those: Integers) -> tuple[Array, Array]:
        """Their lower and upper bounds, (C, n) each."""
        n = len(self.lower[0]) if self.lower else 0
        lower = np.reshape([self.lower[c] for c in those], (-1, n))
        upper = np.reshape([self.upper[c] for c in those], (-1, n))
        return lower, upper

    def add(self, lower: Array, upper: Array, level: int, *, is_rule: bool = False) -> None:
        """One more."""
        self.lower.append(lower)
        self.upper.append(upper)
        self.level.append(level)
        self.is_rule.append(is_rule)


def grown(
    rules: RuleTable, level: Integers, seen: Examples, to_cover: Booleans, noise: float
) -> Candidates:
    """Candidates that hold all examples `to_cover` (T,), from the rules of one action.

    level (R,): of the rules' predictions. noise: the share of wrong rewards; with 0 no box holds an
    example of another level.
    """
    found = Candidates(np.full(len(seen.x), -1))
    waiting = np.flatnonzero(to_cover)
    for r in _by_evidence(rules, level, seen):
        waiting = _from_rule(
            rules.lower[r], rules.upper[r], int(level[r]), seen, waiting, found, noise
        )
    for r in _by_evidence(rules, level, seen):
        if noise == 0.0:
            for other in np.unique(seen.level[waiting]):
                waiting = _from_rule(
                    rules.lower[r], rules.upper[r], int(other), seen, waiting, found, noise
                )
        else:
            waiting = _taken_over(
                rules.lower[r], rules.upper[r], int(level[r]), seen, waiting, found
            )
    return found


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
    lower: Array,
    upper: Array,
    level: int,
    seen: Examples,
    waiting: Integers,
    found: Candidates,
    noise: float,
) -> Integers:
    """Grow boxes around examples of the level in a rule's box; those that still wait."""
    box = (lower[None], upper[None], seen.high)
    inside = waiting[boxes_hold(*box, seen.x[waiting])[0] & (seen.level[waiting] == level)]
    while inside.size:
        low, up = grown_box(lower, upper, level, inside, seen, noise)
        held = boxes_hold(low[None], up[None], seen.high, seen.x)[0]
        if noise > 0.0 and not _is_worth(held, level, seen, noise):
            inside = inside[inside != _middle(seen, inside)]
            continue
        found.add(low, up, level)
        held &= (found.of < 0) & ((seen.level == level) | (noise > 0.0))
        found.of[held] = level
        inside, waiting = inside[~held[inside]], waiting[~held[waiting]]
    return waiting


def _taken_over(
    lower: Array, upper: Array, level: int, seen: Examples, waiting: Integers, found: Candidates
) -> Integers:
    """Keep a rule as it is, if it holds examples that wait; those that still do."""
    held = boxes_hold(lower[None], upper[None], seen.high, seen.x[waiting])[0]
    if held.any():
        found.add(lower, upper, level, is_rule=True)
        found.of[waiting[held]] = level
    left: Integers = waiting[~held]
    return left


def _middle(seen: Examples, those: Integers) -> int:
    """The example nearest to the middle of those."""
    width = np.where(seen.high > seen.low, seen.high - seen.low, 1.0)
    x = seen.x[those] / width
    return int(those[((x - x.mean(axis=0)) ** 2).sum(axis=1).argmin()])


def grown_box(
    lower: Array, upper: Array, level: int, around: Integers, seen: Examples, noise: float
) -> tuple[Array, Array]:
    """The box, made as wide as it may be around the example in the middle of some in it."""
    seed = _middle(seen, around)
    low, up = lower.copy(), upper.copy()
    own = np.where(seen.level == level, seen.count, 0).astype(np.float64)
    other = np.where((seen.level != level) & seen.is_told, seen.count, 0).astype(np.float64)
    growing.grow(
        seen.columns,
        seen.order,
        (own, other),
        seed,
        (low, up, seen.low, seen.high),
        penalties(noise),
    )
    return low, up


def penalties(noise: float) -> Array:
    """What a wrong example counts, sweep by sweep.

    Where a share of the rewards is wrong, a box of one level has (1 - noise) / noise right examples
    for each wrong one, and a box across a decision surface about one: between both lies the last.
    """
    if noise == 0.0:
        return np.array([1.0, 3.0, 10.0, 100.0, NEVER])
    return np.array([1.0, np.sqrt((1.0 - noise) / noise)])


def _is_worth(held: Booleans, level: int, seen: Examples, noise: float) -> bool:
    """Whether what a box holds is of its level more than noise makes it."""
    own = seen.count[held & (seen.level == level)].sum()
    other = seen.count[held & (seen.level != level) & seen.is_told].sum()
    return bool(own > penalties(noise)[-1] * other + 2.0)

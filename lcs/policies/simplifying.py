"""A list made simpler: rules, conditions and digits go that save next to nothing."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from lcs.arrays import Array, Integers
from lcs.policies.decision_list import first_to_hold

OF_A_RULE: Final = 0.2
"""A condition saves at least this share of what a rule has to save."""
OF_A_DIGIT: Final = 0.02
"""And one more digit of a bound this share."""
MOST_DIGITS: Final = 3
"""Decimals that are tried."""
PASSES: Final = 3


@final
@dataclass(frozen=True, eq=False, slots=True)
class Draft:
    """R rules of a list: actions (R,), bounds (R, n), infinite where nothing is asked."""

    action: Integers
    lower: Array
    upper: Array
    otherwise: int

    def first(self, x: Array) -> Integers:
        """Which rule is the first to hold at x (T, n); R where none does."""
        return first_to_hold(self.lower, self.upper, x)

    def loses(self, x: Array, cost: Array) -> float:
        """What the list loses on examples (T, n) of cost (T, A)."""
        taken = np.append(self.action, self.otherwise)[self.first(x)]
        return float(cost[np.arange(len(x)), taken].sum())

    def without(self, rule: int) -> "Draft":
        """The list without one of its rules."""
        kept = np.arange(len(self.action)) != rule
        return Draft(self.action[kept], self.lower[kept], self.upper[kept], self.otherwise)

    def with_bound(self, rule: int, i: int, side: str, value: float) -> "Draft":
        """The list with another `lower` or `upper` bound of a rule in input i."""
        bounds = getattr(self, side).copy()
        bounds[rule, i] = value
        return replace(self, **{side: bounds})


def simplified(draft: Draft, x: Array, cost: Array, least: float) -> Draft:
    """The list without what saves too little.

    least: what a rule has to save, in the unit of cost, summed up over the examples.
    """
    for _ in range(PASSES):
        before = draft
        draft = _without_rules(draft, x, cost, least)
        draft = _without_conditions(draft, x, cost, OF_A_RULE * least)
        if _size(draft) == _size(before):
            break
    return _with_few_digits(draft, x, cost, OF_A_DIGIT * least)


def _size(draft: Draft) -> tuple[int, int]:
    conditions = np.isfinite(draft.lower).sum() + np.isfinite(draft.upper).sum()
    return len(draft.action), int(conditions)


def _without_rules(draft: Draft, x: Array, cost: Array, least: float) -> Draft:
    for rule in reversed(range(len(draft.action))):
        fewer = draft.without(rule)
        if fewer.loses(x, cost) - draft.loses(x, cost) <= least:
            draft = fewer
    return draft


def _without_conditions(draft: Draft, x: Array, cost: Array, least: float) -> Draft:
    now = draft.loses(x, cost)
    for rule, i, side, _ in list(_conditions(draft)):
        wider = draft.with_bound(rule, i, side, -np.inf if side == "lower" else np.inf)
        after = wider.loses(x, cost)
        if after - now <= least:
            draft, now = wider, after
    return draft


def _with_few_digits(draft: Draft, x: Array, cost: Array, least: float) -> Draft:
    now = draft.loses(x, cost)
    for rule, i, side, value in list(_conditions(draft)):
        for digits in range(MOST_DIGITS):
            shorter = draft.with_bound(rule, i, side, round(value, digits))
            after = shorter.loses(x, cost)
            if after - now <= least:
                draft, now = shorter, after
                break
    return draft


def _conditions(draft: Draft) -> Iterator[tuple[int, int, str, float]]:
    """Rule, input, side and value of each bound, those of the last rule first."""
    for rule in reversed(range(len(draft.action))):
        for side, bounds in (("lower", draft.lower), ("upper", draft.upper)):
            for i in np.flatnonzero(np.isfinite(bounds[rule])):
                yield rule, int(i), side, float(bounds[rule, i])

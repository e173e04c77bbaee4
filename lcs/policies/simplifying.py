"""A list made simpler: rules, conditions and digits go that save next to nothing."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from lcs.arrays import Array, Booleans
from lcs.policies.decision_list import DecisionList, holds

OF_A_RULE: Final = 0.2
"""A condition saves at least this share of what a rule has to save."""
OF_A_DIGIT: Final = 0.02
"""And one more digit of a bound this share."""
MOST_DIGITS: Final = 3
"""Decimals that are tried."""
PASSES: Final = 3


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Weighed:
    """A list of R rules on T examples, kept so that what a change of one rule costs is soon known.

    x (T, n). cost (A, T): what each action loses. unmet (R, T): where no rule before each holds.
    lost (R + 1, T): what is lost where the rules from each one on decide alone.
    """

    rules: DecisionList
    x: Array
    cost: Array
    unmet: Booleans
    lost: Array

    def change(self, changed: DecisionList, rule: int) -> float:
        """What is lost more by a list that differs in the bounds of this rule alone."""
        own = slice(rule, rule + 1)
        held = holds(changed.lower[own], changed.upper[own], self.x)[0]
        return self._more(
            rule, np.where(held, self.cost[self.rules.action[rule]], self._next(rule))
        )

    def without(self, rule: int) -> float:
        """What is lost more without this rule."""
        return self._more(rule, self._next(rule))

    def _next(self, rule: int) -> Array:
        """What is lost where the rules after this one decide alone, (T,)."""
        following: Array = self.lost[rule + 1]
        return following

    def _more(self, rule: int, lost: Array) -> float:
        return float((lost - self.lost[rule])[self.unmet[rule]].sum())


def simplified(rules: DecisionList, x: Array, cost: Array, least: float) -> DecisionList:
    """The list without what saves too little.

    Args:
        rules: R of them.
        x: examples (T, n).
        cost: what each action loses there, (T, A).
        least: what a rule has to save, in the unit of cost, summed up over the examples.
    """
    weighed = _weighed(rules, x, np.ascontiguousarray(cost.T))
    for _ in range(PASSES):
        before = weighed.rules
        weighed = _without_rules(weighed, least)
        weighed = _without_conditions(weighed, OF_A_RULE * least)
        if _size(weighed.rules) == _size(before):
            break
    return _with_few_digits(weighed, OF_A_DIGIT * least).rules


def _weighed(rules: DecisionList, x: Array, cost: Array) -> _Weighed:
    held = holds(rules.lower, rules.upper, x)
    unmet = np.ones_like(held)
    np.logical_and.accumulate(~held[:-1], axis=0, out=unmet[1:])
    lost = np.empty((len(rules) + 1, len(x)))
    lost[-1] = cost[rules.otherwise]
    for rule in reversed(range(len(rules))):
        lost[rule] = np.where(held[rule], cost[rules.action[rule]], lost[rule + 1])
    return _Weighed(rules, x, cost, unmet, lost)


def _size(rules: DecisionList) -> tuple[int, int]:
    conditions = np.isfinite(rules.lower).sum() + np.isfinite(rules.upper).sum()
    return len(rules), int(conditions)


def _without_rules(weighed: _Weighed, least: float) -> _Weighed:
    for rule in reversed(range(len(weighed.rules))):
        if weighed.without(rule) <= least:
            weighed = _weighed(weighed.rules.without(rule), weighed.x, weighed.cost)
    return weighed


def _without_conditions(weighed: _Weighed, least: float) -> _Weighed:
    for rule, i, side, _ in list(_conditions(weighed.rules)):
        wider = weighed.rules.with_bound(rule, i, side, -np.inf if side == "lower" else np.inf)
        if weighed.change(wider, rule) <= least:
            weighed = _weighed(wider, weighed.x, weighed.cost)
    return weighed


def _with_few_digits(weighed: _Weighed, least: float) -> _Weighed:
    for rule, i, side, value in list(_conditions(weighed.rules)):
        for digits in range(MOST_DIGITS):
            shorter = weighed.rules.with_bound(rule, i, side, round(value, digits))
            if weighed.change(shorter, rule) <= least:
                weighed = _weighed(shorter, weighed.x, weighed.cost)
                break
    return weighed


def _conditions(rules: DecisionList) -> Iterator[tuple[int, int, str, float]]:
    """Rule, input, side and value of each bound, those of the last rule first."""
    for rule in reversed(range(len(rules))):
        for side, bounds in (("lower", rules.lower), ("upper", rules.upper)):
            for i in np.flatnonzero(np.isfinite(bounds[rule])):
                yield rule, int(i), side, float(bounds[rule, i])

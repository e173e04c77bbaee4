"""A list made simpler: rules, conditions and digits go that save next to nothing."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from lcs.arrays import Array
from lcs.policies.decision_list import DecisionList

OF_A_RULE: Final = 0.2
"""A condition saves at least this share of what a rule has to save."""
OF_A_DIGIT: Final = 0.02
"""And one more digit of a bound this share."""
MOST_DIGITS: Final = 3
"""Decimals that are tried."""
PASSES: Final = 3


def simplified(rules: DecisionList, x: Array, cost: Array, least: float) -> DecisionList:
    """The list without what saves too little.

    least: what a rule has to save, in the unit of cost, summed up over the examples.
    """
    for _ in range(PASSES):
        before = rules
        rules = _without_rules(rules, x, cost, least)
        rules = _without_conditions(rules, x, cost, OF_A_RULE * least)
        if _size(rules) == _size(before):
            break
    return _with_few_digits(rules, x, cost, OF_A_DIGIT * least)


def loses(rules: DecisionList, x: Array, cost: Array) -> float:
    """What a list loses on examples (T, n) of cost (T, A)."""
    return float(cost[np.arange(len(x)), rules.decide(x)].sum())


def _size(rules: DecisionList) -> tuple[int, int]:
    conditions = np.isfinite(rules.lower).sum() + np.isfinite(rules.upper).sum()
    return len(rules), int(conditions)


def _without_rules(rules: DecisionList, x: Array, cost: Array, least: float) -> DecisionList:
    for rule in reversed(range(len(rules))):
        fewer = rules.without(rule)
        if loses(fewer, x, cost) - loses(rules, x, cost) <= least:
            rules = fewer
    return rules


def _without_conditions(rules: DecisionList, x: Array, cost: Array, least: float) -> DecisionList:
    now = loses(rules, x, cost)
    for rule, i, side, _ in list(_conditions(rules)):
        wider = rules.with_bound(rule, i, side, -np.inf if side == "lower" else np.inf)
        after = loses(wider, x, cost)
        if after - now <= least:
            rules, now = wider, after
    return rules


def _with_few_digits(rules: DecisionList, x: Array, cost: Array, least: float) -> DecisionList:
    now = loses(rules, x, cost)
    for rule, i, side, value in list(_conditions(rules)):
        for digits in range(MOST_DIGITS):
            shorter = rules.with_bound(rule, i, side, round(value, digits))
            after = loses(shorter, x, cost)
            if after - now <= least:
                rules, now = shorter, after
                break
    return rules


def _conditions(rules: DecisionList) -> Iterator[tuple[int, int, str, float]]:
    """Rule, input, side and value of each bound, those of the last rule first."""
    for rule in reversed(range(len(rules))):
        for side, bounds in (("lower", rules.lower), ("upper", rules.upper)):
            for i in np.flatnonzero(np.isfinite(bounds[rule])):
                yield rule, int(i), side, float(bounds[rule, i])

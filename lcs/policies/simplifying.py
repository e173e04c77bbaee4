"""A list made simpler: rules, conditions and digits go that save next to nothing."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from lcs.policies.decision_list import DecisionList
from lcs.policies.weighed import Weighed

OF_A_RULE: Final = 0.2
"""A condition saves at least this share of what a rule has to save."""
OF_A_DIGIT: Final = 0.02
"""And one more digit of a bound this share, as a rule."""
MOST_DIGITS: Final = 3
"""Decimals that are tried."""
PASSES: Final = 3


def simplified(before: Weighed, least: float, *, of_a_digit: float = OF_A_DIGIT) -> DecisionList:
    """The list without what saves too little.

    least: what a rule has to save, in the unit of cost, summed up over the examples. of_a_digit:
    what one more digit of a bound has to, as a share of that.
    """
    now = before
    for _ in range(PASSES):
        size = _size(now.rules)
        now = _without_conditions(_without_rules(now, least), OF_A_RULE * least)
        if _size(now.rules) == size:
            break
    return _with_few_digits(now, of_a_digit * least).rules


def _size(rules: DecisionList) -> tuple[int, int]:
    return len(rules), rules.conditions


def _without_rules(now: Weighed, least: float) -> Weighed:
    for rule in reversed(range(len(now.rules))):
        if now.costs_without(rule) <= least:
            now = now.instead(now.rules.without(rule))
    return now


def _without_conditions(now: Weighed, least: float) -> Weighed:
    for rule in reversed(range(len(now.rules))):
        now = widened(now, rule, least)
    return now


def widened(now: Weighed, rule: int, least: float) -> Weighed:
    """The list without the conditions of one rule that save no more than `least`, each alone."""
    for i, side, _ in list(_bounds(now.rules, rule)):
        wider = now.rules.with_bound(rule, i, side, -np.inf if side == "lower" else np.inf)
        if now.costs(wider, rule) <= least:
            now = now.instead(wider)
    return now


def _with_few_digits(now: Weighed, least: float) -> Weighed:
    for rule, i, side, value in list(_conditions(now.rules)):
        for digits in range(MOST_DIGITS):
            shorter = now.rules.with_bound(rule, i, side, round(value, digits))
            if now.costs(shorter, rule) <= least:
                now = now.instead(shorter)
                break
    return now


def _conditions(rules: DecisionList) -> Iterator[tuple[int, int, str, float]]:
    """Rule, input, side and value of each bound, those of the last rule first."""
    for rule in reversed(range(len(rules))):
        for i, side, value in _bounds(rules, rule):
            yield rule, i, side, value


def _bounds(rules: DecisionList, rule: int) -> Iterator[tuple[int, str, float]]:
    """Input, side and value of each bound of a rule."""
    for side, bounds in (("lower", rules.lower), ("upper", rules.upper)):
        for i in np.flatnonzero(np.isfinite(bounds[rule])):
            yield int(i), side, float(bounds[rule, i])

"""A list made simpler: rules, conditions and digits go that save next to nothing."""

from typing import Final

from lcs.policies.decision_list import DecisionList
from lcs.policies.weighed import Weighed

OF_A_RULE: Final = 0.2
"""A condition saves at least this share of what a rule has to save."""
OF_A_DIGIT: Final = 0.02
"""And one more digit of a bound this share."""
MOST_DIGITS: Final = 3
"""Decimals that are tried."""
PASSES: Final = 3


def simplified(before: Weighed, least: float) -> DecisionList:
    """The list without what saves too little.

    least: what a rule has to save, in the unit of cost, summed up over the examples.
    """
    now = before
    for _ in range(PASSES):
        size = _size(now.rules)
        now = _without_conditions(_without_rules(now, least), OF_A_RULE * least)
        if _size(now.rules) == size:
            break
    return _with_few_digits(now, OF_A_DIGIT * least).rules


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
    for i, side, _ in list(now.rules.bounds_of(rule)):
        wider = now.rules.without_bound(rule, i, side)
        if now.costs(wider, rule) <= least:
            now = now.instead(wider)
    return now


def _with_few_digits(now: Weighed, least: float) -> Weighed:
    for rule, i, side, value in list(now.rules.bounds()):
        for digits in range(MOST_DIGITS):
            shorter = now.rules.with_bound(rule, i, side, round(value, digits))
            if now.costs(shorter, rule) <= least:
                now = now.instead(shorter)
                break
    return now

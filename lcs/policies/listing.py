"""From many boxes and what each action costs to a short decision list.

The next rule is always the one after which, were the list to end there, least would be lost:
separate and conquer (Fuernkranz 1999), by cost and not by count, so that a place where all actions
are nearly equal asks for no rule.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from lcs.arrays import Array, Booleans, Integers
from lcs.policies.decision_list import DecisionList, holds

WORTH_A_RULE: Final = 0.01
"""A rule saves at least so much of what the best single action loses."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Offer:
    """C boxes that may become rules: lower, upper (C, n), infinite where nothing is asked."""

    action: Integers
    lower: Array
    upper: Array


def listed(offer: Offer, x: Array, cost: Array, *, tolerance: float, most: int) -> DecisionList:
    """The list of at most `most` rules that loses little.

    Args:
        offer: what it is made of.
        x: examples (T, n).
        cost: what each action loses there against the best one, (T, A), 0 or more.
        tolerance: an action that loses no more counts as right.
        most: rules.
    """
    held = holds(offer.lower, offer.upper, x)
    least = WORTH_A_RULE * cost.sum(axis=0).min()
    chosen: list[int] = []
    left = np.ones(len(x), np.bool_)
    while len(chosen) < most:
        now = cost[left].sum(axis=0).min(initial=np.inf)
        best, after = _best(offer.action, held[:, left], cost[left])
        if best < 0 or now - after <= least:
            break
        chosen.append(best)
        left &= ~held[best]
    kept = _needed(offer, chosen, held, cost, least)
    return _told(offer, kept, x, cost, tolerance)


def _best(action: Integers, held: Booleans, cost: Array) -> tuple[int, float]:
    """The box that leaves least to lose, were it the last rule; -1 where there is none."""
    if not held.size:
        return -1, np.inf
    inside = held.astype(np.float64) @ cost
    rest = (cost.sum(axis=0) - inside).min(axis=1)
    loses = inside[np.arange(len(action)), action] + rest
    best = int(loses.argmin())
    return best, float(loses[best])


def _needed(
    offer: Offer, chosen: list[int], held: Booleans, cost: Array, least: float
) -> list[int]:
    """Those of the chosen without which the list would lose more; the last first."""
    kept = list(chosen)
    for box in reversed(chosen):
        without = [other for other in kept if other != box]
        if _loses(offer, without, held, cost) - _loses(offer, kept, held, cost) <= least:
            kept = without
    return kept


def _loses(offer: Offer, rules: list[int], held: Booleans, cost: Array) -> float:
    taken, otherwise = _taken(offer, rules, held, cost)
    taken = np.where(taken < 0, otherwise, taken)
    return float(cost[np.arange(len(cost)), taken].sum())


def _taken(offer: Offer, rules: list[int], held: Booleans, cost: Array) -> tuple[Integers, int]:
    """The action at each example by the first rule, -1 by none; and the best one for those."""
    taken = np.full(len(cost), -1)
    for box in reversed(rules):
        taken[held[box]] = offer.action[box]
    rest = cost[taken < 0].sum(axis=0)
    return taken, int(rest.argmin())


def _told(offer: Offer, rules: list[int], x: Array, cost: Array, tolerance: float) -> DecisionList:
    """The list, with how often each rule was right where it was the first."""
    held = holds(offer.lower, offer.upper, x)
    _, otherwise = _taken(offer, rules, held, cost)
    lower, upper = offer.lower[rules], offer.upper[rules]
    first = np.append(held[rules], np.ones((1, len(x)), np.bool_), axis=0).argmax(axis=0)
    good = cost <= tolerance
    right = np.zeros(len(rules), np.int64)
    wrong = np.zeros(len(rules), np.int64)
    for r, box in enumerate(rules):
        those = good[first == r, offer.action[box]]
        right[r], wrong[r] = those.sum(), (~those).sum()
    return DecisionList(offer.action[rules], lower, upper, right, wrong, otherwise)

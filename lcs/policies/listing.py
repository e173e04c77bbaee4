"""From many boxes and what each action costs to a short decision list.

The next rule is always the one after which, were the list to end there, least would be lost:
separate and conquer (Fuernkranz 1999), by cost and not by count, so that a place where all actions
are nearly equal asks for no rule. Then rules and conditions go that save next to nothing.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from lcs.arrays import Array, Booleans, Integers
from lcs.policies.decision_list import DecisionList, holds
from lcs.policies.simplifying import Draft, simplified

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
    least = WORTH_A_RULE * float(cost.sum(axis=0).min())
    chosen: list[int] = []
    left = np.ones(len(x), np.bool_)
    while len(chosen) < most:
        now = cost[left].sum(axis=0).min(initial=np.inf)
        best, after = _best(offer.action, held[:, left], cost[left])
        if best < 0 or now - after <= least:
            break
        chosen.append(best)
        left &= ~held[best]
    draft = Draft(offer.action[chosen], offer.lower[chosen], offer.upper[chosen])
    return _told(simplified(draft, x, cost, least), x, cost, tolerance)


def _best(action: Integers, held: Booleans, cost: Array) -> tuple[int, float]:
    """The box that leaves least to lose, were it the last rule; -1 where there is none."""
    if not held.size:
        return -1, np.inf
    inside = held.astype(np.float64) @ cost
    rest = (cost.sum(axis=0) - inside).min(axis=1)
    loses = inside[np.arange(len(action)), action] + rest
    best = int(loses.argmin())
    return best, float(loses[best])


def _told(draft: Draft, x: Array, cost: Array, tolerance: float) -> DecisionList:
    """The list, with how often each rule was right where it was the first."""
    first = draft.first(x)
    otherwise = draft.otherwise(first, cost)
    good = cost <= tolerance
    right = np.zeros(len(draft.action), np.int64)
    wrong = np.zeros(len(draft.action), np.int64)
    for r, action in enumerate(draft.action):
        those = good[first == r, action]
        right[r], wrong[r] = those.sum(), (~those).sum()
    return DecisionList(draft.action, draft.lower, draft.upper, right, wrong, otherwise)

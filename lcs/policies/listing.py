"""From many boxes and what each action costs to a short decision list.

The next rule is always the one that saves most where no rule holds yet: separate and conquer
(Fuernkranz 1999), by cost and not by count, so that a place where all actions are nearly equal asks
for no rule. Then rules and conditions go that save next to nothing.
"""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from lcs.arrays import Array, Booleans, Integers
from lcs.policies.decision_list import DecisionList, holds, uncounted
from lcs.policies.simplifying import simplified

WORTH_A_RULE: Final = 0.0008
"""A rule saves at least this share of what is lost without any."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Offer:
    """C boxes that may become rules: lower, upper (C, n), infinite where nothing is asked."""

    action: Integers
    lower: Array
    upper: Array


def listed(offer: Offer, x: Array, cost: Array, otherwise: int, *, most: int) -> DecisionList:
    """The list of at most `most` rules that loses little; how often they are right is not counted.

    Args:
        offer: what it is made of.
        x: examples (T, n).
        cost: what each action loses there against the best one, (T, A), 0 or more.
        otherwise: the action where no rule holds.
        most: rules.
    """
    held = holds(offer.lower, offer.upper, x)
    saves = cost[:, [otherwise]] - cost  # (T, A), each action in the place of `otherwise`
    least = WORTH_A_RULE * float(cost[:, otherwise].sum())
    chosen: list[int] = []
    saved = _saved(offer.action, held, saves)
    while len(saved) and len(chosen) < most:
        best = int(saved.argmax())
        if saved[best] <= least:
            break
        chosen.append(best)
        now = held[best].copy()
        saved -= _saved(offer.action, held[:, now], saves[now])
        held[:, now] = False
    rules = uncounted(offer.action[chosen], offer.lower[chosen], offer.upper[chosen], otherwise)
    return simplified(rules, x, cost, least)


def _saved(action: Integers, held: Booleans, saves: Array) -> Array:
    """What each of C boxes saves by its action where it holds (C, T), as (C,)."""
    inside: Array = held.astype(np.float64) @ saves
    return inside[np.arange(len(action)), action]


def counted(rules: DecisionList, x: Array, good: Booleans) -> DecisionList:
    """The list, with how often each rule is right at places (T, n) where it is the first to hold.

    good: which actions are as good as the best there, (T, A).
    """
    first = rules.first(x)
    right, wrong = np.zeros_like(rules.action), np.zeros_like(rules.action)
    for r, action in enumerate(rules.action):
        those = good[first == r, action]
        right[r], wrong[r] = those.sum(), (~those).sum()
    return replace(rules, right=right, wrong=wrong)

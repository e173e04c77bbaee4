"""From many boxes and what each action costs to a short decision list.

The next rule is always the one that saves most, wherever in the list it saves that: separate and
conquer (Fuernkranz 1999), by cost and not by count, so that a place where all actions are nearly
equal asks for no rule. A rule for many places is found first; one for few of these, before which
that would hold, then goes ahead of it. Then rules and conditions go that save next to nothing.
"""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from lcs.arrays import Array, Booleans, Integers
from lcs.policies.decision_list import DecisionList, always, holds
from lcs.policies.simplifying import simplified
from lcs.policies.weighed import weighed

WORTH_A_RULE: Final = 0.0015
"""A rule saves at least this share of what is lost without any."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Offer:
    """C boxes that may become rules: lower, upper (C, n), infinite where nothing is asked."""

    action: Integers
    lower: Array
    upper: Array

    def into(self, rules: DecisionList, place: int, box: int) -> DecisionList:
        """The list with one of the boxes as a rule more, before the one at this place."""
        return rules.with_rule(place, int(self.action[box]), self.lower[box], self.upper[box])


def listed(offer: Offer, x: Array, cost: Array, otherwise: int, *, most: int) -> DecisionList:
    """The list of at most `most` rules that loses little; how often they are right is not counted.

    Args:
        offer: what it is made of.
        x: examples (T, n).
        cost: what each action loses there against the best one, (T, A), 0 or more.
        otherwise: the action where no rule holds.
        most: rules.
    """
    held = holds(offer.lower, offer.upper, x).astype(np.float64)
    now = weighed(always(otherwise, x.shape[1]), x, np.ascontiguousarray(cost.T))
    least = WORTH_A_RULE * float(now.lost.sum())
    while len(offer.action) and len(now.rules) < most:
        saved = now.saved(offer.action, held)
        place, box = divmod(int(saved.argmax()), len(offer.action))
        if saved[place, box] <= least:
            break
        now = now.instead(offer.into(now.rules, place, box))
    return simplified(now, least)


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

"""Lists like one that is better: rules go into it where its own decisions lose most.

What a policy loses against the best one is what its decisions lose at the places where it comes
itself, summed up (Kakade and Langford 2002). A list is made for all places that were lived at, most
of which it never sees again. So the best one is gone over at its own.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np

from lcs.arrays import Array
from lcs.policies.decision_list import DecisionList, holds
from lcs.policies.listing import Offer
from lcs.policies.simplifying import widened
from lcs.policies.weighed import Weighed, weighed

OF_WHAT_IT_SAVES: Final = 0.05
"""A condition of a rule saves at least this share of what the rule does."""


def mended(
    rules: DecisionList, offer: Offer, x: Array, cost: Array, *, most: int, count: int
) -> Iterator[DecisionList]:
    """Lists with one rule more, each with another one; then with two of them, with three, ...

    A rule goes to the place in the list where it saves most; those come first that save most. Where
    there are too many rules, the one goes without which least is lost.

    Args:
        rules: the list.
        offer: what rules are taken from.
        x: the places (T, n) where the list itself comes.
        cost: what each action loses there against the best one, (T, A), 0 or more.
        most: rules.
        count: so many of each kind, at most: fewer where nothing more is saved.
    """
    if not len(offer.action) or not len(x):
        return
    held = holds(offer.lower, offer.upper, x).astype(np.float64)
    now = weighed(rules, x, np.ascontiguousarray(cost.T))
    saved = now.saved(offer.action, held)
    best = saved.max(axis=0)
    for box in np.argsort(-best, kind="stable")[:count]:
        if best[box] > 0.0:
            place = int(saved[:, box].argmax())
            yield _short(_with(now, offer, place, int(box)), most).rules
    for k in range(count):
        place, box = divmod(int(saved.argmax()), len(offer.action))
        if saved[place, box] <= 0.0:
            return
        now = _short(_with(now, offer, place, box), most)
        saved = now.saved(offer.action, held)
        if k:
            yield now.rules


def _with(now: Weighed, offer: Offer, place: int, box: int) -> Weighed:
    """The list with one rule more, without those of its conditions that save next to nothing."""
    more = now.instead(offer.into(now.rules, place, box))
    saved = float(now.lost[0].sum() - more.lost[0].sum())
    return widened(more, place, OF_WHAT_IT_SAVES * saved)


def _short(now: Weighed, most: int) -> Weighed:
    """The list without the rule without which least is lost, where it has too many."""
    if len(now.rules) <= most:
        return now
    costs = [now.costs_without(rule) for rule in range(len(now.rules))]
    return now.instead(now.rules.without(int(np.argmin(costs))))

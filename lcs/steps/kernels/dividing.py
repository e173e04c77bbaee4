"""How a body divides: where its memories differ most in what they led to.

A body is a stretch of `order`, which lists memories; its halves are stretches of it.
"""

import numpy as np

from lcs.arrays import Array, Integers
from lcs.compiled import part
from lcs.steps.kernels.layout import Land

SAME = 1e-9
"""Places as near to each other as this are not parted: rounding makes them."""


@part
def cut(
    land: Land, target: Array, those: Integers, fed: int, actions: int, gain: Array
) -> tuple[int, float]:
    """Along which input, and where, memories divide; (-1, 0) if halves would go hungry.

    The cut takes most away from the squared distances of targets to their mean, action by action,
    and leaves each half `fed` memories of each action. gain (1,): how much it takes away.
    """
    count, total = np.zeros(actions), np.zeros(actions)
    for k in those:
        count[land.action[k]] += 1.0
        total[land.action[k]] += target[k]
    best_input, best_place, gain[0] = -1, 0.0, 0.0
    for i in range(land.x.shape[1]):
        along = land.x[those, i]
        ranks = np.argsort(along)
        below, below_total = np.zeros(actions), np.zeros(actions)
        for r in range(ranks.size - 1):
            k = those[ranks[r]]
            below[land.action[k]] += 1.0
            below_total[land.action[k]] += target[k]
            low, high = along[ranks[r]], along[ranks[r + 1]]
            if high - low < SAME:
                continue
            found = _taken_away(count, total, below, below_total, fed)
            if found > gain[0]:
                best_input, best_place, gain[0] = i, 0.5 * (low + high), found
    return best_input, best_place


@part
def _taken_away(count: Array, total: Array, below: Array, below_total: Array, fed: int) -> float:
    """What a cut takes away from the squares; -1 if a half would go hungry."""
    gain = 0.0
    for a in range(count.size):
        above = count[a] - below[a]
        if below[a] < fed or above < fed:
            return -1.0
        above_total = total[a] - below_total[a]
        gain += below_total[a] ** 2 / below[a] + above_total**2 / above
        gain -= total[a] ** 2 / count[a]
    return gain


@part
def divide(
    land: Land, target: Array, order: Integers, fed: int, actions: int, lower: Array, upper: Array
) -> int:
    """Divide one body, that holds everything, until all are as small as they can live.

    lower, upper (C, n): of the bodies that stay; how many. `order` is sorted by body.
    """
    first, last = np.zeros(len(lower), np.int64), np.zeros(len(lower), np.int64)
    lower[0], upper[0], last[0] = -np.inf, np.inf, order.size
    bodies, at, gain = 1, 0, np.zeros(1)
    while at < bodies:
        those = order[first[at] : last[at]].copy()
        i, place = cut(land, target, those, fed, actions, gain)
        if i < 0 or bodies == len(lower):
            at += 1
            continue
        middle = _sorted_by_half(land.x, those, i, place, order[first[at] : last[at]])
        lower[bodies], upper[bodies] = lower[at], upper[at]
        lower[bodies, i], upper[at, i] = place, place
        first[bodies], last[bodies] = first[at] + middle, last[at]
        last[at] = first[at] + middle
        bodies += 1
    return bodies


@part
def _sorted_by_half(x: Array, those: Integers, i: int, place: float, into: Integers) -> int:
    """Those below the cut, then the others; how many are below."""
    below = 0
    for k in those:
        if x[k, i] < place:
            into[below] = k
            below += 1
    above = below
    for k in those:
        if x[k, i] >= place:
            into[above] = k
            above += 1
    return below

"""How a body divides: where its memories differ most in what they led to.

A body is a stretch of `order`, which lists memories; its halves are stretches of it.
"""

import numpy as np

from lcs.arrays import Array, Integers
from lcs.compiled import part
from lcs.steps.kernels.layout import Land

TRIES = 4
"""Places that are tried for a cut, along each input."""


@part
def cut(
    land: Land, target: Array, those: Integers, fed: int, actions: int, chance: np.random.Generator
) -> tuple[int, float]:
    """Along which input, and where, memories divide; (-1, 0) if halves would go hungry.

    The places tried are those of memories, so where many are at a border, the border is cut off.
    The best takes most away from the squared distances of targets to their mean, action by action,
    and leaves each half `fed` memories of each action. Families cut at different places by chance,
    so that their mean is finer than each of them (Geurts et al. 2006, extremely randomized trees).
    """
    count, total = np.zeros(actions), np.zeros(actions)
    below, below_total = np.zeros(actions), np.zeros(actions)
    _sum_up(land, target, those, 0, np.inf, count, total)
    best_input, best_place, most = -1, 0.0, 0.0
    for i in range(land.x.shape[1]):
        for _ in range(TRIES):
            place = land.x[those[int(chance.random() * those.size)], i]
            _sum_up(land, target, those, i, place, below, below_total)
            found = _taken_away(count, total, below, below_total, fed)
            if found > most:
                best_input, best_place, most = i, place, found
    return best_input, best_place


@part
def _sum_up(
    land: Land, target: Array, those: Integers, i: int, place: float, count: Array, total: Array
) -> None:
    """Count the memories below a place, and add up their targets, action by action."""
    count[:] = 0.0
    total[:] = 0.0
    for k in those:
        if land.x[k, i] < place:
            count[land.action[k]] += 1.0
            total[land.action[k]] += target[k]


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
    land: Land,
    target: Array,
    fed: int,
    lower: Array,
    upper: Array,
    actions: int,
    chance: np.random.Generator,
) -> int:
    """Divide one body, that holds everything, until all are as small as they can live.

    lower, upper (C, n): of the bodies that stay; how many.
    """
    order = np.arange(target.size)
    first, last = np.zeros(len(lower), np.int64), np.zeros(len(lower), np.int64)
    lower[0], upper[0], last[0] = -np.inf, np.inf, order.size
    bodies, at = 1, 0
    while at < bodies:
        those = order[first[at] : last[at]].copy()
        i, place = cut(land, target, those, fed, actions, chance)
        if i < 0:
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

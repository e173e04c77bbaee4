"""A body reaches for food just outside of it, so that nobody need sprout there."""

import numpy as np

from lcs.alcsr.kernels.layout import Land, Rules
from lcs.alcsr.kernels.matching import volume_of
from lcs.alcsr.kernels.remembering import is_inside, known
from lcs.arrays import Array
from lcs.compiled import part

TRIES = 4
"""How many of its kin try, those that ate most first."""


@part
def reach(rules: Rules, land: Land, a: int, x: Array, reward: float) -> int:
    """The rule that stretched in one dimension to hold x (n,), or -1."""
    most = np.iinfo(np.int64).max
    latest = -1
    for _ in range(TRIES):
        best, along = -1, -1
        for k in range(rules.living[a]):
            meals = rules.right[a, k]
            if rules.prediction[a, k] != reward or meals > most or (meals == most and k <= latest):
                continue
            if best >= 0 and meals <= rules.right[a, best]:
                continue
            i = only_outside(rules, land, a, k, x)
            if i >= 0:
                best, along = k, i
        if best < 0:
            return -1
        if stretch(rules, land, a, best, along, x[along]):
            rules.volume[a, best] = volume_of(rules.lower[a, best], rules.upper[a, best], land)
            return best
        most, latest = rules.right[a, best], best
    return -1


@part
def only_outside(rules: Rules, land: Land, a: int, k: int, x: Array) -> int:
    """The one dimension in which x lies outside of rule k, or -1."""
    found = -1
    for i in range(x.size):
        if not is_inside(x[i], rules.lower[a, k, i], rules.upper[a, k, i], land.high[i]):
            if found >= 0:
                return -1
            found = i
    return found


@part
def stretch(rules: Rules, land: Land, a: int, k: int, i: int, value: float) -> bool:
    """Move a bound of rule k out to hold the value, and on to the next wrong food, if none hinders.

    The bound stands midway between the last right food and the first wrong one.
    """
    is_below = value < rules.lower[a, k, i]
    end = land.low[i] if is_below else land.high[i]
    start = rules.lower[a, k, i] if is_below else rules.upper[a, k, i]
    wrong, right = np.inf, abs(value - start)
    for j in range(known(land, a)):
        away = start - land.foods[a, i, j] if is_below else land.foods[a, i, j] - start
        is_right = land.rewards[a, j] == rules.prediction[a, k]
        if away < 0.0 or is_right or away >= wrong or not in_slab(rules, land, a, k, i, j):
            continue
        if away <= right:
            return False
        wrong = away
    for j in range(known(land, a)):
        away = start - land.foods[a, i, j] if is_below else land.foods[a, i, j] - start
        is_right = land.rewards[a, j] == rules.prediction[a, k]
        if is_right and right < away < wrong and in_slab(rules, land, a, k, i, j):
            right = away
    if wrong == np.inf:
        bound = end
    elif is_below:
        bound = start - 0.5 * (right + wrong)
    else:
        bound = start + 0.5 * (right + wrong)
    if is_below:
        rules.lower[a, k, i] = min(bound, value)
    else:
        rules.upper[a, k, i] = max(bound, np.nextafter(value, np.inf)) if bound < end else end
    return True


@part
def in_slab(rules: Rules, land: Land, a: int, k: int, along: int, j: int) -> bool:
    """Whether food j lies in rule k in all dimensions but one."""
    for i in range(land.low.size):
        if i != along and not is_inside(
            land.foods[a, i, j], rules.lower[a, k, i], rules.upper[a, k, i], land.high[i]
        ):
            return False
    return True

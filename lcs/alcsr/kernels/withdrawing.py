"""A body that tastes wrong food withdraws from it, at the face where it loses least."""

import numpy as np

from lcs.alcsr.kernels.feeding import remove
from lcs.alcsr.kernels.layout import POISONED, Land, Rules, Scratch
from lcs.alcsr.kernels.matching import volume_of
from lcs.alcsr.kernels.remembering import count_outside, known, penalty_of, share_of
from lcs.arrays import Array
from lcs.compiled import part

CORE = 0.1
"""What of a body's width, at each face inside the known range, is not its core."""

PATIENCE, SURPRISE = 3.0, 0.15
"""A body dies that was poisoned so often more than noise explains: a count, a share of meals."""


@part
def withdraw(rules: Rules, land: Land, scratch: Scratch, a: int, x: Array, reward: float) -> bool:
    """Those fed with wrong food withdraw, or bear it for noise, or die; they eat nothing of it.

    Returns whether some stayed where they are: then that food is no reason for a birth.
    """
    fed = scratch.fed[a]
    kept = 0
    any_dead, any_stayed = False, False
    for j in range(scratch.fed_count[a]):
        k = fed[j]
        count_meal(rules, land, a, k, x, reward)
        if rules.prediction[a, k] == reward:
            fed[kept] = k
            kept += 1
            continue
        if not draw_back(rules, land, scratch, a, k, x):
            rules.wrong[a, k] += 1
            any_stayed = True
        expected = land.noise[a] * rules.meals[a, k]
        bearable = PATIENCE + expected + 2.0 * np.sqrt(expected) + SURPRISE * rules.meals[a, k]
        if rules.poisoned[a, k] >= bearable:
            scratch.dead[k] = True
            scratch.tally[POISONED] += 1
            any_dead = True
    scratch.fed_count[a] = kept
    if any_dead:
        remove(rules, scratch, a)
    return any_stayed


@part
def count_meal(rules: Rules, land: Land, a: int, k: int, x: Array, reward: float) -> None:
    """What rule k was offered since it grew; in its core wrong food is noise, and no boundary."""
    is_wrong = rules.prediction[a, k] != reward
    rules.meals[a, k] += 1
    rules.poisoned[a, k] += is_wrong
    if is_core(rules.lower[a, k], rules.upper[a, k], land, x):
        rules.core_meals[a, k] += 1
        rules.core_wrong[a, k] += is_wrong


@part
def is_core(lower: Array, upper: Array, land: Land, x: Array) -> bool:
    """Whether x (n,) lies well inside of a body."""
    for i in range(x.size):
        margin = CORE * (upper[i] - lower[i])
        if lower[i] > land.low[i] and x[i] < lower[i] + margin:
            return False
        if upper[i] < land.high[i] and x[i] > upper[i] - margin:
            return False
    return True


@part
def draw_back(rules: Rules, land: Land, scratch: Scratch, a: int, k: int, x: Array) -> bool:
    """Move one bound of rule k past x, if the wrong food outweighs the right one that it loses."""
    lower, upper, own = rules.lower[a, k], rules.upper[a, k], rules.prediction[a, k]
    penalty = penalty_of(share_of(land, a, own), land.noise[a])
    count_outside(land, a, known(land, a), lower, upper, scratch.outside)
    face = cheapest_face(land, scratch, a, own, lower, upper, x, penalty)
    if face < 0:
        return False
    i = face // 2
    nearest = lower[i] if face % 2 else upper[i]
    for j in range(known(land, a)):
        if scratch.outside[j] > 0 or land.rewards[a, j] != own:
            continue
        food = land.foods[a, i, j]
        if face % 2:
            if nearest < food < x[i]:
                nearest = food
        elif x[i] < food < nearest:
            nearest = food
    if face % 2:
        upper[i] = max(0.5 * (nearest + x[i]), np.nextafter(nearest, np.inf))
    else:
        lower[i] = max(0.5 * (nearest + x[i]), np.nextafter(x[i], np.inf))
    rules.volume[a, k] = volume_of(lower, upper, land)
    return True


@part
def cheapest_face(
    land: Land,
    scratch: Scratch,
    a: int,
    own: float,
    lower: Array,
    upper: Array,
    x: Array,
    penalty: float,
) -> int:
    """2 i for the lower face of dimension i, 2 i + 1 for the upper one; -1 where none is worth it.

    Of equal ones the nearest to x. Where x lies on the very bound that stays, the face is no way.
    """
    losses = scratch.losses
    losses[:] = 0.0
    for j in range(known(land, a)):
        if scratch.outside[j] > 0:
            continue
        worth = 1.0 if land.rewards[a, j] == own else -penalty
        for i in range(x.size):
            food = land.foods[a, i, j]
            if food <= x[i]:
                losses[2 * i] += worth
            if food >= x[i]:
                losses[2 * i + 1] += worth
    best, nearest = -1, np.inf
    for face in range(losses.size):
        i = face // 2
        width = upper[i] - lower[i]
        away = upper[i] - x[i] if face % 2 else x[i] - lower[i]
        left = x[i] - lower[i] if face % 2 else upper[i] - x[i]
        if losses[face] > 0.0 or left <= 0.0 or width <= 0.0:
            continue
        least = losses[best] if best >= 0 else np.inf
        if losses[face] < least or (losses[face] == least and away / width < nearest):
            best, nearest = face, away / width
    return best

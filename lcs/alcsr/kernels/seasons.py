"""The end of a season: what is noise, who starves, and where food is left."""

import numpy as np

from lcs.alcsr.kernels.feeding import remove
from lcs.alcsr.kernels.layout import STARVED, Land, Numbers, Rules, Scratch
from lcs.alcsr.kernels.living import bear_sprout
from lcs.alcsr.kernels.reaching import reach
from lcs.alcsr.kernels.remembering import (
    count_outside,
    is_inside,
    known,
    least_evidence,
    meals_in,
)
from lcs.alcsr.kernels.sorting import ranked
from lcs.arrays import Array
from lcs.compiled import part

TELLING = 50
"""Meals in cores that tell the noise."""

LENGTHENING = 0.05
"""A season lasts so much of all food so far, and `season` foods at least."""


@part
def end_season(
    rules: Rules, land: Land, numbers: Numbers, scratch: Scratch, a: int, rng: np.random.Generator
) -> None:
    """What happens once in a while on landscape a, if the time has come."""
    if land.met[a] < land.season[a]:
        return
    land.season[a] = land.met[a] + int(LENGTHENING * land.met[a]) + numbers.season
    if numbers.doubts == 1:
        land.noise[a] = noise_of(rules, a)
    if numbers.famine == 1:
        starve(rules, land, scratch, a)
        settle_uneaten(rules, land, numbers, scratch, a, rng)


@part
def noise_of(rules: Rules, a: int) -> float:
    """The share of wrong food in the cores of those with the least of it, that ate half of all."""
    living = rules.living[a]
    shares = (rules.core_wrong[a, :living] + 0.5) / (rules.core_meals[a, :living] + 1.0)
    total = rules.core_meals[a, :living].sum()
    if total <= TELLING:
        return 0.0
    meals, wrong = 0, 0
    for k in ranked(shares):
        meals += rules.core_meals[a, k]
        wrong += rules.core_wrong[a, k]
        if 2 * meals >= total:
            break
    return float(wrong / meals)


@part
def starve(rules: Rules, land: Land, scratch: Scratch, a: int) -> None:
    """Take away whose food others eat too: those who eat least first."""
    living, total = rules.living[a], known(land, a)
    eaters, outside = scratch.eaters, scratch.outside
    eaters[:total] = 0
    for k in range(living):
        count_outside(land, a, total, rules.lower[a, k], rules.upper[a, k], outside)
        right, wrong = meals_in(land, a, rules.prediction[a, k], outside)
        rules.right[a, k] = right
        rules.wrong[a, k] = wrong
        share_food(rules, land, scratch, a, k, 1)
    least = least_evidence(land, a, land.noise[a])
    for k in ranked(rules.right[a, :living].astype(np.float64)):
        count_outside(land, a, total, rules.lower[a, k], rules.upper[a, k], outside)
        if eaten_alone(rules, land, scratch, a, k) < least:
            share_food(rules, land, scratch, a, k, -1)
            scratch.dead[k] = True
            scratch.tally[STARVED] += 1
    scratch.fed_count[a] = 0
    remove(rules, scratch, a)


@part
def share_food(rules: Rules, land: Land, scratch: Scratch, a: int, k: int, more: int) -> None:
    """Count rule k, which `scratch.outside` is of, among the eaters of its right food."""
    for j in range(known(land, a)):
        if scratch.outside[j] == 0 and land.rewards[a, j] == rules.prediction[a, k]:
            scratch.eaters[j] += more


@part
def eaten_alone(rules: Rules, land: Land, scratch: Scratch, a: int, k: int) -> int:
    """How much right food nobody eats but rule k."""
    alone = 0
    for j in range(known(land, a)):
        is_right = land.rewards[a, j] == rules.prediction[a, k]
        alone += scratch.outside[j] == 0 and is_right and scratch.eaters[j] == 1
    return alone


@part
def settle_uneaten(
    rules: Rules, land: Land, numbers: Numbers, scratch: Scratch, a: int, rng: np.random.Generator
) -> None:
    """Somebody reaches for food that is left, or sprouts there, while there is room."""
    x = scratch.place
    for j in range(known(land, a)):
        if scratch.eaters[j] > 0:
            continue
        for i in range(x.size):
            x[i] = land.foods[a, i, j]
        if is_held(rules, land, a, x):
            continue
        reward = land.rewards[a, j]
        if numbers.grows == 0 or reach(rules, land, a, x, reward) < 0:
            bear_sprout(rules, land, numbers, scratch, a, x, reward, rng)


@part
def is_held(rules: Rules, land: Land, a: int, x: Array) -> bool:
    """Whether any body of landscape a holds x (n,)."""
    for k in range(rules.living[a]):
        inside = True
        for i in range(x.size):
            if not is_inside(x[i], rules.lower[a, k, i], rules.upper[a, k, i], land.high[i]):
                inside = False
                break
        if inside:
            return True
    return False

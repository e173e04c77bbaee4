"""Corpses: what a rule that died of the wrong food leaves to those that sprout (4.3.5)."""

import math

from lcs.alcsr.kernels.layout import Corpses, Land, Numbers, Rules, Scratch
from lcs.arrays import Array
from lcs.compiled import part


@part
def bury(
    rules: Rules,
    corpses: Corpses,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    a: int,
    k: int,
) -> None:
    """A corpse, one of whose fractions is halved towards where it fed well; neighbors learn."""
    at = corpses.buried[a]
    lower, upper, center = corpses.lower[a, at], corpses.upper[a, at], corpses.center[a, at]
    span(rules, land, numbers, a, k, lower, upper)
    halved = halve(rules, a, k, lower, upper)
    for i in range(center.size):
        center[i] = 0.5 * (rules.lower[a, k, i] + rules.upper[a, k, i])
    corpses.prediction[a, at] = rules.prediction[a, k]
    found = nearest_corpses(corpses, numbers, scratch, a, center, rules.prediction[a, k])
    for j in range(found):
        other = scratch.near[j]
        rate = rate_at(numbers, scratch.distance[j], scratch.distance[0])
        for i in range(center.size):
            if numbers.corpses_learn == 0 or i == halved:
                corpses.lower[a, other, i] += rate * (lower[i] - corpses.lower[a, other, i])
                corpses.upper[a, other, i] += rate * (upper[i] - corpses.upper[a, other, i])
    corpses.buried[a] = at + 1


@part
def span(
    rules: Rules, land: Land, numbers: Numbers, a: int, k: int, lower: Array, upper: Array
) -> None:
    """Write the cover fractions of rule k before one is halved."""
    for i in range(lower.size):
        width = land.high[i] - land.low[i]
        low, up = rules.lower[a, k, i], rules.upper[a, k, i]
        if width <= 0.0:
            below = 0.0
            above = 0.0
        elif numbers.corpse_spans == 2 and rules.right[a, k] > 0:
            below = (rules.right_center[a, k, i] - low) / width
            above = (up - rules.right_center[a, k, i]) / width
        else:
            below = (up - low) / width
            if numbers.corpse_spans == 1:
                below = 0.5 * below
            above = below
        lower[i] = numbers.sprout_width * below
        upper[i] = numbers.sprout_width * above


@part
def halve(rules: Rules, a: int, k: int, lower: Array, upper: Array) -> int:
    """Halve the fraction that probably reached over a decision surface; its dimension, or -1."""
    if rules.right[a, k] == 0 or rules.wrong[a, k] == 0:
        return -1
    well, ill = rules.right_center[a, k], rules.wrong_center[a, k]
    widest = 0
    for i in range(1, well.size):
        if abs(well[i] - ill[i]) > abs(well[widest] - ill[widest]):
            widest = i
    if well[widest] < ill[widest]:
        upper[widest] *= 0.5
    else:
        lower[widest] *= 0.5
    return widest


@part
def rate_at(numbers: Numbers, distance: float, least: float) -> float:
    """The Widrow-Hoff rate of a corpse so far away."""
    if numbers.corpse_rate_is == 1:
        return 1.0 / (1.0 + distance)
    if distance <= 0.0:
        return 1.0
    if numbers.corpse_rate_is == 2:
        return least / distance
    return min(1.0, numbers.corpse_rate / distance)


@part
def nearest_corpses(
    corpses: Corpses, numbers: Numbers, scratch: Scratch, a: int, x: Array, prediction: float
) -> int:
    """How many stand in `scratch.near`, the nearest first, with their `scratch.distance`."""
    found = 0
    for k in range(corpses.buried[a]):
        if numbers.seeding_by == 1 and corpses.prediction[a, k] != prediction:
            continue
        squared = 0.0
        for i in range(x.size):
            squared += (corpses.center[a, k, i] - x[i]) * (corpses.center[a, k, i] - x[i])
        found = insert(scratch, found, numbers.corpse_neighbors, k, squared)
    for j in range(found):
        scratch.distance[j] = math.sqrt(scratch.distance[j])
    return found


@part
def insert(scratch: Scratch, found: int, most: int, k: int, squared: float) -> int:
    """Keep k among the nearest, behind those as near; how many there are."""
    if found == most and squared >= scratch.distance[found - 1]:
        return found
    at = found if found < most else found - 1
    while at > 0 and scratch.distance[at - 1] > squared:
        scratch.distance[at] = scratch.distance[at - 1]
        scratch.near[at] = scratch.near[at - 1]
        at -= 1
    scratch.distance[at] = squared
    scratch.near[at] = k
    return min(found + 1, most)

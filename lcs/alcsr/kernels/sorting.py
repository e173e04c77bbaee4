"""Remembered food in the order of each input, so that a body need not sort what it looks at."""

import numpy as np

from lcs.alcsr.kernels.layout import Land, Scratch
from lcs.alcsr.kernels.remembering import known
from lcs.arrays import Array, Integers
from lcs.compiled import part


@part
def ranked(values: Array) -> Integers:
    """The places of the values in rising order; sorting is compiled once, here."""
    order: Integers = np.argsort(values)
    return order


@part
def sort_in(land: Land, scratch: Scratch, a: int) -> None:
    """Bring the orders of landscape a up to date, and those of the sample, its first places."""
    room, total = land.rewards.shape[1], known(land, a)
    since = min(land.met[a] - land.ordered[a], total)
    if since == 0:
        return
    first = (land.met[a] - since) % room
    for i in range(land.low.size):
        order = land.order[a, i]
        kept = 0
        for k in order[: total if land.ordered[a] >= room else land.ordered[a]]:
            ago = k - first
            order[kept] = k
            kept += ago + room * (ago < 0) >= since
        merge_in(land.foods[a, i], order, kept, first, since, scratch.values)
        chosen = 0
        for k in order[:total]:
            if chosen < land.sample.shape[2]:
                land.sample[a, i, chosen] = k
                chosen += k < land.sample.shape[2]
    land.ordered[a] = land.met[a]


@part
def merge_in(
    foods: Array, order: Integers, kept: int, first: int, since: int, values: Array
) -> None:
    """Merge `since` new foods, from place `first` on, into the `kept` ones that are in order."""
    for j in range(since):
        values[j] = foods[(first + j) % foods.size]
    fresh = ranked(values[:since])
    at, old = kept + since - 1, kept - 1
    for j in range(since - 1, -1, -1):
        k = (first + fresh[j]) % foods.size
        while old >= 0 and foods[order[old]] > foods[k]:
            order[at] = order[old]
            at -= 1
            old -= 1
        order[at] = k
        at -= 1

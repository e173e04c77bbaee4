"""Trees that divide places by chance, and expect in each leaf the mean of what is in it.

Source: Geurts, Ernst and Wehenkel (2006), extremely randomized trees.
"""

from typing import NamedTuple

import numpy as np

from lcs.arrays import Array, Indices, Integers
from lcs.compiled import part

TRIES = 4
"""Places that are tried for a cut, along each input."""


class Trees(NamedTuple):
    """F trees of up to M nodes: below `place` along `along` it goes on at `child`, else next to it.

    along (F, M): -1 of a leaf. place (F, M). child (F, M). nodes (F,): how many.
    """

    along: Indices
    place: Array
    child: Indices
    nodes: Integers


@part
def seedlings(families: int, count: int, fed: int) -> Trees:
    """Room for trees of so many places, with `fed` in each leaf at least."""
    most = 2 * (count // fed) + 3
    return Trees(
        np.full((families, most), -1, np.int32),
        np.zeros((families, most)),
        np.zeros((families, most), np.int32),
        np.zeros(families, np.int64),
    )


@part
def grow_tree(
    trees: Trees, f: int, x: Array, target: Array, fed: int, chance: np.random.Generator
) -> None:
    """Divide the places (N, n) by their targets (N,) until halves would go hungry."""
    order = np.arange(target.size)
    first, last = np.zeros_like(trees.child[f]), np.zeros_like(trees.child[f])
    last[0] = target.size
    trees.nodes[f] = 1
    at = 0
    while at < trees.nodes[f]:
        those = order[first[at] : last[at]].copy()
        i, place = cut(x, target, those, fed, chance)
        trees.along[f, at] = i
        if i >= 0:
            below = _divided(x[:, i], those, place, order[first[at] : last[at]])
            new = trees.nodes[f]
            trees.place[f, at], trees.child[f, at] = place, new
            first[new], last[new] = first[at], first[at] + below
            first[new + 1], last[new + 1] = first[at] + below, last[at]
            trees.nodes[f] = new + 2
        at += 1


@part
def cut(
    x: Array, target: Array, those: Integers, fed: int, chance: np.random.Generator
) -> tuple[int, float]:
    """Along which input, and where; (-1, 0) where nothing is gained or a half would go hungry."""
    best_input, best_place, most = -1, 0.0, 1e-12
    if those.size < 2 * fed:
        return best_input, best_place
    places = np.empty(x.shape[1] * TRIES)
    for j in range(places.size):
        places[j] = x[those[int(chance.random() * those.size)], j // TRIES]
    count, below, total = _below(x, target, those, places)
    for j in range(places.size):
        above = those.size - count[j]
        if count[j] < fed or above < fed:
            continue
        gain = below[j] ** 2 / count[j] + (total - below[j]) ** 2 / above - total**2 / those.size
        if gain > most:
            best_input, best_place, most = j // TRIES, places[j], gain
    return best_input, best_place


@part
def _below(x: Array, target: Array, those: Integers, places: Array) -> tuple[Array, Array, float]:
    """How many are below each of the tried places, the sum of their targets, and that of all.

    All tries at once: a row of x is fetched once for them, and not once for each.
    """
    count, below, total = np.zeros(places.size), np.zeros(places.size), 0.0
    for k in those:
        led_to = target[k]
        total += led_to
        for i in range(x.shape[1]):
            for j in range(i * TRIES, (i + 1) * TRIES):
                is_below = x[k, i] < places[j]
                count[j] += is_below
                below[j] += is_below * led_to
    return count, below, total


@part
def _divided(values: Array, those: Integers, place: float, into: Integers) -> int:
    """Those below the cut, then the others; how many are below."""
    below = 0
    for k in those:
        if values[k] < place:
            into[below] = k
            below += 1
    above = below
    for k in those:
        if values[k] >= place:
            into[above] = k
            above += 1
    return below


@part
def leaf_at(trees: Trees, f: int, place: Array) -> int:
    """The leaf of a tree that holds a place (n,)."""
    at = 0
    while trees.along[f, at] >= 0:
        is_above = place[trees.along[f, at]] >= trees.place[f, at]
        at = trees.child[f, at] + is_above
    return at

"""Trees that divide places by chance, and expect in each leaf the mean of what is in it.

Source: Geurts, Ernst and Wehenkel (2006), extremely randomized trees.
"""

from typing import NamedTuple

import numpy as np

from lcs.arrays import Array, Integers
from lcs.compiled import part

TRIES = 4
"""Places that are tried for a cut, along each input."""


class Trees(NamedTuple):
    """F trees of up to M nodes: below `place` along `along` it goes on at `child`, else next to it.

    along (F, M): -1 of a leaf. place (F, M). child (F, M). nodes (F,): how many.
    """

    along: Integers
    place: Array
    child: Integers
    nodes: Integers


@part
def seedlings(families: int, count: int, fed: int) -> Trees:
    """Room for trees of so many places, with `fed` in each leaf at least."""
    most = 2 * (count // fed) + 3
    return Trees(
        np.full((families, most), -1),
        np.zeros((families, most)),
        np.zeros((families, most), np.int64),
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
    total = 0.0
    for k in those:
        total += target[k]
    for i in range(x.shape[1]):
        for _ in range(TRIES):
            place = x[those[int(chance.random() * those.size)], i]
            count, below = 0, 0.0
            for k in those:
                is_below = x[k, i] < place
                count += is_below
                below += is_below * target[k]
            above = those.size - count
            if count < fed or above < fed:
                continue
            gain = below**2 / count + (total - below) ** 2 / above - total**2 / those.size
            if gain > most:
                best_input, best_place, most = i, place, gain
    return best_input, best_place


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

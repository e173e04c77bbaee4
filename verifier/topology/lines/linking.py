"""From zeros on the edges of a grid to polylines: marching squares with crossings.

Cells (i, j) lie between the nodes (i, j) and (i + 1, j + 1). Zeros of a cell are counted round
its border: below, right, above, left, up to two on each edge.
"""

from collections.abc import Callable
from typing import Final, TypeAlias

import numpy as np

from runtime.arrays import Array, Integers, frozen
from verifier.topology.lines.edge_zeros import CROSSING, TOUCHING, EdgeZeros, Values

Crossings: TypeAlias = Callable[[Array], Array]
"""For starts (k, 2): the nearest points (k, 2) where branches cross, NaN where they don't."""

LEAST: Final = 1e-9
"""A line that is shorter, as a share of all of them, is rounding on a node."""

WITHIN: Final = 1e-6
"""By how much, as a share of it, a crossing may lie beyond its cell."""

Pairs: TypeAlias = list[tuple[int, int]]


def polylines(
    f_at: Values,
    nodes: tuple[Array, Array],
    zeros: tuple[EdgeZeros, EdgeZeros],
    crossings: Crossings,
) -> tuple[Array, ...]:
    """Lines (k, 2) through the zeros on the edges along axis 0 and along axis 1."""
    numbers, places, kinds = _numbered(_opened(zeros))
    # A kind for the empty slots, which have number -1.
    kind = np.append(kinds, 0)[numbers]
    pairs: Pairs = []
    odd: list[tuple[Integers, Array]] = []
    for which in (CROSSING, TOUCHING):
        count = np.sum(kind == which, axis=-1)
        simple = kind[count == 2] == which
        pairs += map(tuple, numbers[count == 2][simple].reshape(-1, 2).tolist())
        odd += _crowded(numbers, kind == which, count, nodes)
    middle = _meeting(places, odd, crossings)
    for (row, _), meet in zip(odd, middle, strict=True):
        if np.all(np.isfinite(meet)) and len(row) % 2 == 0:
            pairs += _through(row, len(places))
            places = np.concatenate([places, np.repeat(meet[None], len(row) // 2, axis=0)])
        else:
            pairs += _past(f_at, row, places)
    return _chained(pairs, places)


def _opened(zeros: tuple[EdgeZeros, EdgeZeros]) -> tuple[EdgeZeros, EdgeZeros]:
    """The zeros, with each one that touches and leads nowhere turned into two that cross.

    Two lines that cross just beside an edge meet it twice, at places too near to be told apart.
    """
    flat, tall = (np.sum(one.kind == TOUCHING, axis=-1) for one in zeros)
    inside = flat[:, :-1] + flat[:, 1:] + tall[:-1] + tall[1:]
    opened = []
    for along, one in enumerate(zeros):
        # The most of the cells on both sides of the edge.
        padded = np.pad(inside, [(0, 0), (1, 1)] if along == 0 else [(1, 1), (0, 0)])
        sides = (padded[:, :-1], padded[:, 1:]) if along == 0 else (padded[:-1], padded[1:])
        alone = (one.kind[..., 0] == TOUCHING) & (np.maximum(*sides) == 1)
        kind = np.where(alone[..., None], CROSSING, one.kind)
        twice = np.repeat(one.at[..., :1, :], 2, axis=-2)
        opened.append(EdgeZeros(kind, np.where(alone[..., None, None], twice, one.at)))
    return opened[0], opened[1]


def _numbered(zeros: tuple[EdgeZeros, EdgeZeros]) -> tuple[Integers, Array, Integers]:
    """For each cell the numbers of its zeros (.., 8), -1 for none; all places and kinds."""
    numbers: list[Integers] = []
    total = 0
    for one in zeros:
        has = one.kind > 0
        number = np.full(has.shape, -1)
        number[has] = total + np.arange(int(has.sum()))
        total += int(has.sum())
        numbers.append(number)
    flat, tall = numbers
    round_it = [flat[:, :-1], tall[1:], flat[:, 1:, ::-1], tall[:-1, :, ::-1]]
    places = [one.at[one.kind > 0] for one in zeros]
    kinds = [one.kind[one.kind > 0] for one in zeros]
    return np.concatenate(round_it, axis=-1), np.concatenate(places), np.concatenate(kinds)


def _crowded(
    numbers: Integers, chosen: Array, count: Integers, nodes: tuple[Array, Array]
) -> list[tuple[Integers, Array]]:
    """The zeros of cells with more than two, in order, and the cells' corners (2, 2)."""
    found = []
    for i, j in np.argwhere(count > 2):
        corners = np.array([[nodes[0][i], nodes[1][j]], [nodes[0][i + 1], nodes[1][j + 1]]])
        found.append((numbers[i, j][chosen[i, j]], corners))
    return found


def _meeting(
    places: Array, cells: list[tuple[Integers, Array]], crossings: Crossings
) -> list[Array]:
    """For each of `cells` the point (2,) within it where its branches cross, or NaN."""
    if not cells:
        return []
    found = crossings(np.array([places[row].mean(axis=0) for row, _ in cells]))
    low, high = (np.array([corners[k] for _, corners in cells]) for k in (0, 1))
    margin = WITHIN * (high - low)
    inside = np.all((found >= low - margin) & (found <= high + margin), axis=-1)
    return list(np.where(inside[:, None], found, np.nan))


def _through(row: Integers, first: int) -> Pairs:
    """Lines that cross: each zero is joined with the opposite one by a point from `first` on."""
    half = len(row) // 2
    pairs: Pairs = []
    for k in range(half):
        pairs += [(int(row[k]), first + k), (first + k, int(row[k + half]))]
    return pairs


def _past(f_at: Values, row: Integers, places: Array) -> Pairs:
    """Lines that pass one another: of the two ways to join neighbours the one that fits.

    It is the one that f is nearer to zero on, halfway. With an odd number of zeros: the two that
    are farthest apart.
    """
    if len(row) % 2 == 1:
        each = [(int(a), int(b)) for a in row for b in row if a < b]
        return [max(each, key=lambda pair: float(np.ptp(places[list(pair)], axis=0).max()))]
    ways: list[Pairs] = [
        [(int(row[k]), int(row[(k + 1) % len(row)])) for k in range(first, len(row), 2)]
        for first in (0, 1)
    ]
    halfway = np.array([0.5 * (places[a] + places[b]) for way in ways for a, b in way])
    off = np.abs(f_at(halfway)).reshape(2, -1).max(axis=-1)
    return ways[int(np.argmin(off))]


def _chained(pairs: Pairs, places: Array) -> tuple[Array, ...]:
    """Polylines from pairs of neighbours, each point in two of them at most."""
    neighbours: list[list[int]] = [[] for _ in places]
    for a, b in pairs:
        neighbours[a].append(b)
        neighbours[b].append(a)
    ends = [i for i, near in enumerate(neighbours) if len(near) == 1]
    seen = [False] * len(neighbours)
    lines: list[Array] = []
    for start in (*ends, *range(len(neighbours))):
        if seen[start] or not neighbours[start]:
            continue
        line = [start]
        seen[start] = True
        while further := [k for k in neighbours[line[-1]] if not seen[k]]:
            line.append(further[0])
            seen[further[0]] = True
        if len(line) > 2 and start in neighbours[line[-1]]:
            line.append(start)
        lines.append(frozen(places[line]))
    least = LEAST * np.ptp(places, axis=0).max() if len(places) else 0.0
    return tuple(line for line in lines if np.ptp(line, axis=0).max() > least)

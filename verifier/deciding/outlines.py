"""Pieces of a plane put together: areas of neighbours that are alike, and the lines between areas.

Pieces meet edge to edge; an edge that two alike share is inside, all others are outlines.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from verifier.deciding.cutting import Point, Polygon, area

DIGITS: Final = 9
"""Corners that agree in so many digits of the width of the plane are one."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Joined:
    """Neighbours of one sort. rings: closed outlines (n, 2), holes clockwise. pieces: of which."""

    sort: int
    rings: tuple[Array, ...]
    pieces: tuple[int, ...]
    size: float


@final
@dataclass(frozen=True, eq=False, slots=True)
class Line:
    """Where two sorts meet: points (n, 2), the sort on the left of them, and on the right."""

    points: Array
    left: int
    right: int


def put_together(
    pieces: Sequence[Polygon], sorts: Sequence[int], low: Point, high: Point
) -> tuple[tuple[Joined, ...], tuple[Line, ...]]:
    """Areas and the lines between them; low, high: corners of the plane."""
    corners = _numbered(pieces, low, high)
    owner = {edge: k for k, ring in enumerate(corners.rings) for edge in _edges(ring)}
    beyond = {edge: owner.get((edge[1], edge[0])) for edge in owner}
    root = _groups(len(pieces), owner, beyond, sorts)
    outer: dict[int, list[tuple[int, int]]] = {}
    between: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for edge, k in owner.items():
        other = beyond[edge]
        if other is None or sorts[other] != sorts[k]:
            outer.setdefault(root[k], []).append(edge)
        if other is not None and sorts[k] < sorts[other]:
            between.setdefault((sorts[k], sorts[other]), []).append(edge)
    members: dict[int, list[int]] = {}
    for k, first in enumerate(root):
        members.setdefault(first, []).append(k)
    sizes = [area(piece) for piece in pieces]
    joined = tuple(
        Joined(
            sorts[first],
            tuple(_straightened(corners.places[chain]) for chain in _chains(outer[first])),
            tuple(members[first]),
            sum(sizes[k] for k in members[first]),
        )
        for first in members
    )
    lines = tuple(
        Line(_straightened(corners.places[chain]), left, right)
        for (left, right), edges in between.items()
        for chain in _chains(edges)
    )
    return joined, lines


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Corners:
    """places: (n, 2). rings: of each piece the numbers of its corners."""

    places: Array
    rings: list[list[int]]


def _numbered(pieces: Sequence[Polygon], low: Point, high: Point) -> _Corners:
    width = np.array(high) - np.array(low)
    known: dict[tuple[float, float], int] = {}
    places: list[Point] = []
    rings = []
    for piece in pieces:
        ring: list[int] = []
        for point, near in zip(
            piece, np.round((np.array(piece) - low) / width, DIGITS) + 0.0, strict=True
        ):
            key = (float(near[0]), float(near[1]))
            if key not in known:
                known[key] = len(places)
                places.append(point)
            if not ring or known[key] != ring[-1]:
                ring.append(known[key])
        rings.append(ring[:-1] if len(ring) > 1 and ring[0] == ring[-1] else ring)
    return _Corners(np.array(places), rings)


def _edges(ring: Sequence[int]) -> Iterable[tuple[int, int]]:
    return zip(ring, [*ring[1:], *ring[:1]], strict=True)


def _groups(
    count: int,
    owner: dict[tuple[int, int], int],
    beyond: dict[tuple[int, int], int | None],
    sorts: Sequence[int],
) -> list[int]:
    """Of each piece the first of those that it is joined with."""
    parent = list(range(count))

    def first(k: int) -> int:
        while parent[k] != k:
            parent[k] = parent[parent[k]]
            k = parent[k]
        return k

    for edge, k in owner.items():
        other = beyond[edge]
        if other is not None and sorts[other] == sorts[k]:
            a, b = sorted((first(k), first(other)))
            parent[b] = a
    return [first(k) for k in range(count)]


def _chains(edges: Sequence[tuple[int, int]]) -> list[list[int]]:
    """Edges, each from one corner to another, as paths; a closed one ends where it began."""
    after: dict[int, list[int]] = {}
    into: dict[int, int] = {}
    for a, b in edges:
        after.setdefault(a, []).append(b)
        into[b] = into.get(b, 0) + 1
    starts = [a for a in after for _ in range(max(0, len(after[a]) - into.get(a, 0)))]
    found = []
    for start in [*starts, *after]:
        while after.get(start):
            chain = [start]
            while after.get(chain[-1]):
                chain.append(after[chain[-1]].pop())
                if chain[-1] == start:
                    break
            found.append(chain)
    return found


def _straightened(points: Array) -> Array:
    """A path without the corners at which it goes straight on."""
    if len(points) < 3:
        return points
    is_closed = bool((points[0] == points[-1]).all())
    scale = np.maximum(np.ptp(points, axis=0), 1e-300)
    steps = np.diff(points / scale, axis=0)
    lengths = np.maximum(np.hypot(*steps.T), 1e-300)
    before, following = (steps / lengths[:, None])[:-1], (steps / lengths[:, None])[1:]
    turns = np.abs(before[:, 0] * following[:, 1] - before[:, 1] * following[:, 0]) > 1e-6
    turns |= (before * following).sum(axis=1) < 0.0
    kept = points[np.concatenate([[True], turns, [True]])]
    if is_closed and len(kept) > 3:
        first, last = kept[1] - kept[0], kept[-1] - kept[-2]
        first, last = first / scale, last / scale
        if abs(first[0] * last[1] - first[1] * last[0]) <= 1e-6 * np.hypot(*first) * np.hypot(
            *last
        ):
            kept = np.vstack([kept[1:-1], kept[1:2]])
    return np.asarray(kept)

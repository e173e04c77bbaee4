"""When a path has come to its end: places that nothing leaves, and closeness to a cycle.

m: number of axes. e: differences from a point as shares of the axes' widths. For a flow followed
backward in time `sign` is -1: what repels is then an end.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers, frozen
from verifier.topology.features import Cycle, FixedPoint, PointKind, Stability
from verifier.topology.slices import Slice, jacobians_at, rates_at, shortest

SHELLS: Final = 0.8 ** np.arange(40.0)[::-1]
"""Sizes of the ellipsoids that are tried, as shares of the largest one."""

DECAY: Final = 0.05
"""What of its decay by the linearisation e'Pe must keep on every shell of a trap."""

DIRECTIONS: Final = {1: 2, 2: 96, 3: 400, 4: 1200}
"""How many points of each shell are looked at, by the number of axes."""

REACH: Final = 4e-3
"""A path is on a cycle when it is this close to it; closer where other features are near."""

RASTER: Final = {1: 200, 2: 200, 3: 100, 4: 30}
"""Cells per axis of the raster in which the points of a cycle are found; wider than REACH."""

STABLE: Final = frozenset({PointKind.STABLE_NODE, PointKind.STABLE_FOCUS})
UNSTABLE: Final = frozenset({PointKind.UNSTABLE_NODE, PointKind.UNSTABLE_FOCUS})
DRAWS: Final = {
    1: frozenset({Stability.STABLE, Stability.SEMI_STABLE}),
    -1: frozenset({Stability.UNSTABLE, Stability.SEMI_STABLE}),
}
"""Cycles that paths may come to, forward and backward in time."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Trap:
    """An ellipsoid e'Pe <= 1 round the fixed point `index` at `at` that nothing leaves.

    On samples of every shell in it, e'Pe falls: Lyapunov's function of the linearisation (Khalil
    2002, theorem 4.6) is one of the field itself. Samples, no proof: kinks between may escape.
    """

    index: int
    at: Array
    metric: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class Tube:
    """The neighbourhood of a cycle: what is within `reach` of `shares` (k, m), points of it.

    raster: for each cell of the domain the row of `members` that lists the points in it and in
    the cells around it, -1 where there are none. members: (rows, most), filled up with -1.
    """

    index: int
    shares: Array
    reach: float
    raster: Integers
    members: Integers


def traps_of(
    view: Slice, fixed_points: Sequence[FixedPoint], cycles: Sequence[Cycle], sign: int
) -> tuple[Trap, ...]:
    """The traps round the fixed points that attract (for sign -1, repel), where there is one."""
    kinds = STABLE if sign > 0 else UNSTABLE
    others = np.concatenate([*(p.at[None] for p in fixed_points), *(c.points for c in cycles)])
    found = [
        _trap(view, index, point, others, sign)
        for index, point in enumerate(fixed_points)
        if point.kind in kinds
    ]
    return tuple(trap for trap in found if trap is not None)


def trapped(view: Slice, trap: Trap, points: Array) -> Booleans:
    """Which of `points` (..., m) lie in the trap."""
    e = shortest(view, points - trap.at) / view.width
    return np.asarray(np.einsum("...i,ij,...j", e, trap.metric, e) <= 1.0)


def tubes_of(
    view: Slice, fixed_points: Sequence[FixedPoint], cycles: Sequence[Cycle], sign: int
) -> tuple[Tube, ...]:
    """The neighbourhoods of the cycles that paths come to when followed in this direction."""
    return tuple(
        _tube(view, index, fixed_points, cycles)
        for index, cycle in enumerate(cycles)
        if cycle.stability in DRAWS[sign]
    )


def beside(view: Slice, tube: Tube, points: Array) -> Booleans:
    """Which of `points` (k, m) lie within the tube's reach of its cycle."""
    return gaps_to(view, tube, points) <= tube.reach


def gaps_to(view: Slice, tube: Tube, points: Array) -> Array:
    """How far `points` (k, m) are from a cycle, as shares of the widths; infinite if far."""
    shares = _shares(view, points)
    known = np.flatnonzero(np.all(np.isfinite(shares), axis=-1))
    rows = tube.raster[_cells(view, shares[known], len(tube.raster))]
    near, rows = known[rows >= 0], rows[rows >= 0]
    members = tube.members[rows]
    apart = shares[near, None] - tube.shares[members]
    apart -= np.where(view.periodic, np.round(apart), 0.0)
    squares = np.where(members >= 0, np.sum(apart * apart, axis=-1), np.inf)
    gaps = np.full(len(points), np.inf)
    gaps[near] = np.sqrt(squares.min(axis=-1, initial=np.inf))
    return gaps


def _trap(view: Slice, index: int, point: FixedPoint, others: Array, sign: int) -> Trap | None:
    """The largest of the ellipsoids in which e'Pe falls on every shell; None where none is."""
    P = _lyapunov(view, point.at, sign)
    if P is None:
        return None
    largest = _room(view, point.at, P, others)
    root = np.linalg.inv(np.linalg.cholesky(P)).T
    unit = _directions(len(point.at)) @ root.T
    e = np.sqrt(largest) * SHELLS[:, None, None] * unit
    moved = sign * rates_at(view, point.at + e * view.width) / view.width
    if view.is_map:
        falls = _energy(P, e + moved) - _energy(P, e)
    else:
        falls = 2.0 * np.einsum("...i,ij,...j", e, P, moved)
    # NaN, outside the domain, fails as well.
    good = np.all(falls <= -DECAY * np.sum(e * e, axis=-1), axis=-1)
    count = len(good) if good.all() else int(np.argmin(good))
    if count == 0:
        return None
    size = largest * SHELLS[count - 1] ** 2
    return Trap(index, point.at, frozen(P / size))


def _lyapunov(view: Slice, at: Array, sign: int) -> Array | None:
    """P with J'P + PJ = -1, of maps J'PJ - P = -1, in shares; None where it is not positive."""
    J = jacobians_at(view, at[None])[0] * view.width / view.width[:, None]
    one = np.eye(len(at))
    if not np.all(np.isfinite(J)):
        return None
    if view.is_map:
        system = np.kron(J.T, J.T) - np.kron(one, one)
    else:
        system = sign * (np.kron(one, J.T) + np.kron(J.T, one))
    try:
        P = np.linalg.solve(system, -one.ravel()).reshape(one.shape)
    except np.linalg.LinAlgError:
        return None
    P = 0.5 * (P + P.T)
    return P if np.linalg.eigvalsh(P).min() > 0.0 else None


def _room(view: Slice, at: Array, P: Array, others: Array) -> float:
    """The largest e'Pe of an ellipsoid within the domain and without other features."""
    low, high = (at - view.low) / view.width, (view.low + view.width - at) / view.width
    gap = np.where(view.periodic, 0.5, np.minimum(low, high))
    inside = float(np.min(gap * gap / np.diag(np.linalg.inv(P))))
    apart = _energy(P, shortest(view, others - at) / view.width)
    apart = apart[apart > 1e-12 * np.trace(P)]
    return min(inside, 0.99 * float(apart.min(initial=np.inf)))


def _energy(P: Array, e: Array) -> Array:
    return np.asarray(np.einsum("...i,ij,...j", e, P, e))


def _directions(m: int) -> Array:
    """Points (d, m) all over the unit sphere, the same every time."""
    if m == 1:
        return np.array([[-1.0], [1.0]])
    if m == 2:
        angles = 2.0 * np.pi * np.arange(DIRECTIONS[2]) / DIRECTIONS[2]
        return np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    normal = np.random.default_rng(0).standard_normal((DIRECTIONS[m], m))
    return np.asarray(normal / np.linalg.norm(normal, axis=-1, keepdims=True))


def _tube(
    view: Slice, index: int, fixed_points: Sequence[FixedPoint], cycles: Sequence[Cycle]
) -> Tube:
    closed = cycles[index].points
    others = [p.at[None] for p in fixed_points]
    others += [c.points for i, c in enumerate(cycles) if i != index]
    shares = _shares(view, closed)
    gaps = [_gaps(view, _shares(view, other), shares).min() for other in others]
    reach = min(REACH, *(0.25 * float(gap) for gap in gaps)) if gaps else REACH
    dense = shares if view.is_map else _shares(view, _filled(view, closed, 0.5 * reach))
    return Tube(index, frozen(dense), reach, *_raster(view, dense))


def _raster(view: Slice, shares: Array) -> tuple[Integers, Integers]:
    """Which of `shares` (k, m) lie in each cell and around it: see `Tube`."""
    m = len(view.axes)
    shape = (RASTER[m],) * m
    offsets = np.array(list(product((-1.0, 0.0, 1.0), repeat=m))) / RASTER[m]
    around = (shares[:, None] + offsets).reshape(-1, m)
    cells = np.ravel_multi_index(_cells(view, around, RASTER[m]), shape)
    pairs = np.unique(np.stack([cells, np.repeat(np.arange(len(shares)), len(offsets))]), axis=1)
    filled, first, counts = np.unique(pairs[0], return_index=True, return_counts=True)
    members = np.full((len(filled), int(counts.max())), -1)
    row = np.repeat(np.arange(len(filled)), counts)
    members[row, np.arange(len(row)) - first[row]] = pairs[1]
    raster = np.full(shape, -1)
    raster.flat[filled] = np.arange(len(filled))
    return raster, members


def _filled(view: Slice, points: Array, stride: float) -> Array:
    """`points` (k, m) with more between them, at most `stride` apart (but at most 20,000)."""
    steps = shortest(view, np.diff(points, axis=0))
    lengths = np.linalg.norm(steps / view.width, axis=-1)
    parts = np.ceil(lengths / max(stride, float(lengths.sum()) / 20_000)).astype(np.int64)
    parts = np.maximum(parts, 1)
    which = np.repeat(np.arange(len(parts)), parts)
    begun = np.repeat(np.cumsum(parts) - parts, parts)
    share = (np.arange(len(which)) - begun) / parts[which]
    return np.asarray(points[which] + share[:, None] * steps[which])


def _shares(view: Slice, points: Array) -> Array:
    share = (points - view.low) / view.width
    return np.asarray(np.where(view.periodic, np.mod(share, 1.0), share))


def _cells(view: Slice, shares: Array, count: int) -> tuple[Integers, ...]:
    inside = np.where(view.periodic, np.mod(shares, 1.0), shares)
    index = np.clip((inside * count).astype(np.int64), 0, count - 1)
    return tuple(index.T)


def _gaps(view: Slice, shares: Array, others: Array) -> Array:
    """For each of `shares` (k, m) how far it is from the nearest of `others` (l, m)."""
    apart = shares[:, None] - others[None]
    apart -= np.where(view.periodic, np.round(apart), 0.0)
    return np.asarray(np.sqrt(np.sum(apart * apart, axis=-1).min(axis=-1, initial=np.inf)))

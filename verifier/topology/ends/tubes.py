"""Neighbourhoods of cycles: how far points are from a cycle, many at once.

m: number of axes. Distances are shares of the axes' widths.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Integers, frozen
from verifier.topology.features import Cycle, FixedPoint
from verifier.topology.slices import Slice, shortest

REACH: Final = 4e-3
"""A path is on a cycle when it is this close to it; closer where other features are near."""

MOST_POINTS: Final = 20_000
"""Of a cycle at most."""

RASTER: Final = {1: 200, 2: 200, 3: 100, 4: 30}
"""Cells per axis of the raster in which the points of a cycle are found; wider than REACH."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Tube:
    """The neighbourhood of a cycle: what is within `reach` of it.

    shares, steps: (k, m) points of it and what leads from each to the next; 0 for a map.
    raster: for each cell of the domain the row of `members` that lists the points in it and in
    the cells around it, -1 where there are none. members: (rows, most), filled up with -1.
    """

    index: int
    shares: Array
    steps: Array
    reach: float
    raster: Integers
    members: Integers


def gaps_to(view: Slice, tube: Tube, points: Array) -> Array:
    """How far `points` (k, m) are from a cycle, as shares of the widths; infinite if far."""
    shares = _shares(view, points)
    known = np.flatnonzero(np.all(np.isfinite(shares), axis=-1))
    rows = tube.raster[_cells(view, shares[known], len(tube.raster))]
    near, rows = known[rows >= 0], rows[rows >= 0]
    members = tube.members[rows]
    apart = shares[near, None] - tube.shares[members]
    apart -= np.where(view.periodic, np.round(apart), 0.0)
    steps = tube.steps[members]
    along = np.sum(apart * steps, axis=-1) / np.maximum(np.sum(steps * steps, axis=-1), 1e-300)
    apart -= np.clip(along, 0.0, 1.0)[..., None] * steps
    squares = np.where(members >= 0, np.sum(apart * apart, axis=-1), np.inf)
    gaps = np.full(len(points), np.inf)
    gaps[near] = np.sqrt(squares.min(axis=-1, initial=np.inf))
    return gaps


def tube_round(
    view: Slice, index: int, fixed_points: Sequence[FixedPoint], cycles: Sequence[Cycle]
) -> Tube:
    """The neighbourhood of the cycle `index`; narrower where other features are near."""
    closed = cycles[index].points
    others = [p.at[None] for p in fixed_points]
    others += [c.points for i, c in enumerate(cycles) if i != index]
    shares = _shares(view, closed)
    gaps = [_gaps(view, _shares(view, other), shares).min() for other in others]
    reach = min(REACH, *(0.25 * float(gap) for gap in gaps)) if gaps else REACH
    dense, steps = (shares, np.zeros_like(shares)) if view.is_map else _filled(view, closed, reach)
    return Tube(index, frozen(dense), frozen(steps), reach, *_raster(view, dense))


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


def _filled(view: Slice, points: Array, stride: float) -> tuple[Array, Array]:
    """More points, at most `stride` apart, between `points` (k, m), and the steps between them."""
    whole = shortest(view, np.diff(points, axis=0)) / view.width
    lengths = np.linalg.norm(whole, axis=-1)
    parts = np.maximum(np.ceil(lengths / max(stride, float(lengths.sum()) / MOST_POINTS)), 1.0)
    counts = parts.astype(np.int64)
    which = np.repeat(np.arange(len(counts)), counts)
    number = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
    steps = whole[which] / parts[which, None]
    return _shares(view, points)[which] + number[:, None] * steps, steps


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

"""Evenly spaced lines of a planar field, everywhere about equally far from one another.

In the spirit of B. Jobard and W. Lefer, "Creating evenly-spaced streamlines of arbitrary density"
(1997), but all candidates are followed at once, and then taken one after the other, each as far
as nothing that was taken before comes too close. Lengths are those of the drawing, in inches.
L: lanes; T: points of a line.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans

GOLDEN: Final = 1.3247179572447460
"""The root of x³ = x + 1: seeds by the recurrence R2 (M. Roberts, 2018)."""

FINE: Final = 8
"""Cells of the raster in which lines are recorded, per spacing."""

CLOSEST: Final = 0.5
"""A line ends where it comes nearer than this share of the spacing to another one."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Sheet:
    """The field on the paper: velocities (n1, n2, 2) in inches per second, NaN where unknown.

    size: (2,) of the drawing, from its lower left corner.
    """

    velocity: Array
    size: Array


@final
@dataclass(frozen=True, slots=True)
class Spacing:
    """How far lines begin from others, how long they are at least and at most; their points."""

    apart: float = 0.15
    shortest: float = 0.25
    longest: float = 2.4
    step: float = 0.03


def evenly_spaced(sheet: Sheet, spacing: Spacing, drawn: Sequence[Array] = ()) -> list[Array]:
    """Lines (T, 2) in inches along the flow, each begun beside those before it.

    They keep away from the curves (T, 2) that are `drawn` already, too.
    """
    seeds = _seeds(sheet, spacing)
    half = max(2, round(0.5 * spacing.longest / spacing.step))
    behind = _followed(sheet, seeds, -spacing.step, half)[:, :0:-1]
    lanes = np.concatenate([behind, _followed(sheet, seeds, spacing.step, half)], axis=1)
    taken = np.zeros(tuple(np.ceil(sheet.size * FINE / spacing.apart).astype(int) + 1), dtype=bool)
    away = np.full(len(seeds), 2.0 * float(sheet.size.sum()))
    for curve in drawn:
        _take(taken, curve, spacing)
        away = np.minimum(away, _distances(seeds, curve))
    lines: list[Array] = []
    while (away >= spacing.apart).any():
        nearest = int(np.argmin(np.where(away >= spacing.apart, away, np.inf)))
        line = _free_stretch(taken, lanes[nearest], half - 1, spacing)
        away[nearest] = 0.0
        if (len(line) - 1) * spacing.step >= spacing.shortest:
            # The step that left the sheet ends at its edge.
            lines.append(np.clip(line, 0.0, sheet.size))
            _take(taken, line, spacing)
            away = np.minimum(away, _distances(seeds, line))
    return lines


def _distances(points: Array, line: Array) -> Array:
    """From each of `points` (L, 2) to the nearest point of `line` (T, 2)."""
    corners = line[::2]
    products = (np.square(corners).sum(axis=-1) - 2.0 * points @ corners.T).min(axis=1)
    return np.asarray(np.sqrt(np.maximum(np.square(points).sum(axis=-1) + products, 0.0)))


def _seeds(sheet: Sheet, spacing: Spacing) -> Array:
    count = int(1.6 * np.prod(sheet.size) / spacing.apart**2)
    steps = GOLDEN ** -np.arange(1.0, 3.0)
    return np.mod(0.5 + np.outer(np.arange(count), steps), 1.0) * sheet.size


def _followed(sheet: Sheet, seeds: Array, step: float, count: int) -> Array:
    """Points (L, count, 2) at equal distances along the field, NaN after a line's end."""
    lanes = np.full((len(seeds), count, 2), np.nan)
    at = seeds
    for k in range(count):
        lanes[:, k] = at
        middle = at + 0.5 * step * _direction(sheet, at)
        at = at + step * _direction(sheet, middle)
    return lanes


def _direction(sheet: Sheet, at: Array) -> Array:
    """Unit vectors (L, 2) of the field, NaN outside the sheet and where it stands still."""
    v = velocity_at(sheet, at)
    speed = np.hypot(v[..., 0], v[..., 1])
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where((speed > 0.0)[..., None], v / speed[..., None], np.nan)


def velocity_at(sheet: Sheet, at: Array) -> Array:
    """The velocity (..., 2) at points (..., 2), bilinear between nodes; NaN outside."""
    n1, n2 = sheet.velocity.shape[:2]
    x = at[..., 0] * ((n1 - 1) / sheet.size[0])
    y = at[..., 1] * ((n2 - 1) / sheet.size[1])
    inside = (x >= 0.0) & (x <= n1 - 1) & (y >= 0.0) & (y <= n2 - 1)
    x, y = np.where(inside, x, 0.0), np.where(inside, y, 0.0)
    i = np.minimum(x.astype(np.int64), n1 - 2)
    j = np.minimum(y.astype(np.int64), n2 - 2)
    s, t = (x - i)[..., None], (y - j)[..., None]
    nodes = sheet.velocity.reshape(n1 * n2, 2)
    corner = i * n2 + j
    low = nodes[corner] * (1.0 - s) + nodes[corner + n2] * s
    high = nodes[corner + 1] * (1.0 - s) + nodes[corner + n2 + 1] * s
    return np.where(inside[..., None], low * (1.0 - t) + high * t, np.nan)


def _free_stretch(taken: Booleans, lane: Array, seed: int, spacing: Spacing) -> Array:
    """What of `lane` around its seed runs where nothing is taken, and not close to itself."""
    known = np.isfinite(lane[:, 0])
    free = known.copy()
    free[known] = ~taken[_cells(taken, lane[known], spacing)]
    if not free[seed]:
        return lane[:0]
    blocked = np.flatnonzero(~free)
    after = int(np.searchsorted(blocked, seed))
    begin = int(blocked[after - 1]) + 1 if after else 0
    end = int(blocked[after]) if after < blocked.size else len(lane)
    return _until_itself(lane[begin:end], seed - begin, spacing)


def _until_itself(line: Array, seed: int, spacing: Spacing) -> Array:
    """The line from its seed on, both ways, until it comes back to itself: spirals end."""
    apart = CLOSEST * spacing.apart
    gap = int(4.0 * apart / spacing.step)
    every = 2
    coarse = line[::every]
    near = np.hypot(*np.moveaxis(coarse[:, None] - coarse[None], -1, 0)) < apart
    index = np.arange(len(coarse)) * every
    pairs = np.argwhere(near & (index[None] - index[:, None] > gap)) * every
    begin, end = 0, len(line)
    for a, b in pairs.tolist():
        if a >= begin and b < end:
            # Cut the side that lies further from the seed.
            begin, end = (a + every, end) if seed - a > b - seed else (begin, b)
    return line[begin:end]


def _take(taken: Booleans, line: Array, spacing: Spacing) -> None:
    """Marks all cells too close to `line`."""
    reach = round(CLOSEST * FINE)
    offsets = (
        np.argwhere(np.hypot(*np.mgrid[-reach : reach + 1, -reach : reach + 1]) <= reach) - reach
    )
    cells = np.stack(_cells(taken, line, spacing), axis=-1)
    cells = np.unique(cells, axis=0)
    around = (cells[:, None] + offsets[None]).reshape(-1, 2)
    around = np.clip(around, 0, np.array(taken.shape) - 1)
    taken[tuple(around.T)] = True


def _cells(taken: Booleans, points: Array, spacing: Spacing) -> tuple[Array, ...]:
    index = np.clip((points * FINE / spacing.apart).astype(np.int64), 0, np.array(taken.shape) - 1)
    return tuple(index.T)

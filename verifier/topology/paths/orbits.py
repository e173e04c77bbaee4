"""Orbits of a map: what comes of well-spread points, step by step."""

from typing import Final

import numpy as np

from runtime.arrays import Array, frozen
from verifier.topology.features import Trajectory
from verifier.topology.paths.seeds import spread
from verifier.topology.slices import Slice, rates_at, wrapped

STEPS: Final = {1: 40, 2: 300}
"""How many steps an orbit takes, by the number of axes."""


def find_orbits(view: Slice, count: int) -> tuple[Trajectory, ...]:
    """`count` orbits from evenly spread starts, each until it leaves the domain."""
    steps = STEPS[len(view.axes)]
    points = np.full((count, steps + 1, len(view.axes)), np.nan)
    points[:, 0] = spread(view, count)
    for k in range(steps):
        points[:, k + 1] = _next(view, points[:, k])
    return tuple(_orbit(view, path) for path in points)


def _next(view: Slice, points: Array) -> Array:
    """The next points (L, m); NaN once an orbit has left the domain."""
    alive = np.all(np.isfinite(points), axis=-1)
    moved = np.full_like(points, np.nan)
    moved[alive] = wrapped(view, points[alive] + rates_at(view, points[alive]))
    low, high = view.low, view.low + view.width
    outside = ~np.all(view.periodic | ((moved >= low) & (moved <= high)), axis=-1)
    moved[outside] = np.nan
    return moved


def _orbit(view: Slice, path: Array) -> Trajectory:
    known = np.all(np.isfinite(path), axis=-1)
    count = len(path) if known.all() else int(np.argmin(known))
    times = view.program.field.every * np.arange(count)
    return Trajectory(frozen(times), frozen(path[:count]), 0)

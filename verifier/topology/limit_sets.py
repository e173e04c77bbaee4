"""Where trajectories from everywhere end up, forwards and backwards: cycles among their limits.

m: number of axes; L: lanes.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array
from verifier.topology.features import FixedPoint
from verifier.topology.motion import moved
from verifier.topology.seeds import spread
from verifier.topology.slices import Slice, rates_at, shortest

SEEDS: Final = 24
"""Trajectories in each direction of time."""

SETTLING: Final = 40.0
"""Paces after which trajectories are near their limits."""

WATCHED: Final = 12.0
"""Paces during which they must come back then."""

SAMPLES: Final = 1200

NEAR: Final = 0.02
"""How close to where they were, in widths, is back; at a limit they come much closer."""

TOLERANCE: Final = 1e-8

AT_REST: Final = 1e-3
"""This close to a fixed point, in widths, a trajectory ends there."""

MOST: Final = 8
"""Recurrences that are handed on; an attractor that is no cycle has many."""


def recurrences(
    view: Slice, fixed_points: tuple[FixedPoint, ...], tempo: float
) -> list[tuple[Array, float]]:
    """Points (m,) that trajectories come back to, and after which time; negative: backwards."""
    found: list[tuple[Array, float]] = []
    for direction in (tempo, -tempo):
        settling = np.array([0.0, 0.5, 1.0]) * SETTLING * direction
        ends = moved(view, spread(view, SEEDS), settling, TOLERANCE)[:, -1]
        ends = ends[np.all(np.isfinite(ends), axis=-1)]
        ends = _moving(view, ends, fixed_points)
        found += _returning(view, _apart(view, ends), direction)
    return found


def _moving(view: Slice, points: Array, fixed_points: tuple[FixedPoint, ...]) -> Array:
    for fixed in fixed_points:
        gaps = np.abs(shortest(view, points - fixed.at) / view.width).max(axis=-1)
        points = points[gaps > AT_REST]
    return points


def _apart(view: Slice, points: Array) -> Array:
    """At most `MOST` of `points` (L, m), far from one another."""
    kept: list[Array] = []
    for point in points:
        gaps = [np.abs(shortest(view, point - other) / view.width).max() for other in kept]
        if len(kept) < MOST and min(gaps, default=1.0) > AT_REST:
            kept.append(point)
    return np.array(kept).reshape(-1, len(view.axes))


def _returning(view: Slice, points: Array, direction: float) -> list[tuple[Array, float]]:
    """Which of `points` (L, m) come near themselves again, and after which time."""
    if not len(points):
        return []
    times = np.linspace(0.0, WATCHED * direction, SAMPLES + 1)
    paths = moved(view, points, times, TOLERANCE)
    z = shortest(view, paths - points[:, None]) / view.width
    normals = rates_at(view, points) / view.width * np.sign(direction)
    normals /= np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-300)
    across = np.einsum("lti,li->lt", z, normals)
    found = []
    for lane, start in enumerate(points):
        with np.errstate(invalid="ignore"):
            rises = (across[lane, :-1] < 0.0) & (across[lane, 1:] >= 0.0)
        for i in np.flatnonzero(rises):
            a, b = across[lane, i], across[lane, i + 1]
            part = a / (a - b)
            gap = np.linalg.norm((1.0 - part) * z[lane, i] + part * z[lane, i + 1])
            if gap < NEAR:
                found.append((start, float(times[i] + part * (times[i + 1] - times[i]))))
                break
    return found

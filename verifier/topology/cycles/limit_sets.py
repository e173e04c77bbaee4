"""Where trajectories from everywhere end up, forwards and backwards: cycles among their limits.

m: number of axes; L: lanes.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array
from verifier.topology.features import FixedPoint
from verifier.topology.paths.motion import LASTING, moved, travelled
from verifier.topology.paths.seeds import spread
from verifier.topology.slices import Slice, rates_at, shortest

SEEDS: Final = 24
"""Trajectories in each direction of time."""

SETTLED: Final = 12.0
"""The length, in widths, after which trajectories are near their limits."""

LONGEST: Final = 6.0
"""The length, in widths, within which they must come back then."""

SETTLING_SAMPLES: Final = 64

SAMPLES: Final = 400
"""Times at which they are looked at in each duration for which they are followed."""

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
    for step in (tempo, -tempo):
        ends = _moving(view, _settled(view, step), fixed_points)
        found += _returning(view, _apart(view, ends), step)
    return found


def _settled(view: Slice, step: float) -> Array:
    """Where trajectories (L, m) from everywhere are after a long way; fewer if some are lost."""
    here, ended = spread(view, SEEDS), [np.empty((0, len(view.axes)))]
    length = np.zeros(len(here))
    for chunk in LASTING:
        paths = moved(view, here, np.linspace(0.0, chunk * step, SETTLING_SAMPLES + 1), TOLERANCE)
        done = travelled(view, paths, chunk)
        length += done
        there = (done > 0.0) & np.isfinite(length) & (length >= SETTLED)
        ended.append(paths[there, -1])
        rest = (done > 0.0) & (length < SETTLED)
        here, length = paths[rest, -1], length[rest]
        if not len(here):
            break
    return np.concatenate(ended)


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


def _returning(view: Slice, points: Array, step: float) -> list[tuple[Array, float]]:
    """Which of `points` (L, m) come near themselves again, and after which time."""
    if not len(points):
        return []
    normals = rates_at(view, points) / view.width * np.sign(step)
    normals /= np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-300)
    found: list[tuple[Array, float]] = []
    going, here, passed = np.arange(len(points)), points, 0.0
    length = np.zeros(len(points))
    for chunk in LASTING:
        times = np.linspace(0.0, chunk * step, SAMPLES + 1)
        paths = moved(view, here, times, TOLERANCE)
        z = shortest(view, paths - points[going, None]) / view.width
        back = [_first_return(one, normal) for one, normal in zip(z, normals[going], strict=True)]
        found += [
            (points[lane], passed + float(np.interp(at, np.arange(SAMPLES + 1), times)))
            for lane, at in zip(going, back, strict=True)
            if at is not None
        ]
        done = travelled(view, paths, chunk)
        length += done
        rest = np.array([at is None for at in back]) & (done > 0.0) & (length < LONGEST)
        going, here, length = going[rest], paths[rest, -1], length[rest]
        passed += float(times[-1])
        if not going.size:
            break
    return found


def _first_return(z: Array, normal: Array) -> float | None:
    """At which fractional sample a path z (T, m), in widths, comes back to 0 along `normal`."""
    across = z @ normal
    with np.errstate(invalid="ignore"):
        rises = (across[:-1] < 0.0) & (across[1:] >= 0.0)
    for i in np.flatnonzero(rises):
        part = float(across[i] / (across[i] - across[i + 1]))
        if np.linalg.norm((1.0 - part) * z[i] + part * z[i + 1]) < NEAR:
            return float(i) + part
    return None

"""One path of a flow, followed closely enough to be drawn, and cut where it shows nothing new.

m: number of axes; L: lanes. Lengths are shares of the domain: a path straight across has one.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, frozen
from runtime.integrators import adaptive
from verifier.topology.features import Trajectory
from verifier.topology.slices import Slice, shortest, states_at

LONGEST: Final = 4.0
"""The length at which a path is cut."""

STRIDE: Final = 0.008
"""About how far apart the points of a path are."""

ARRIVED: Final = 0.02
"""A path ends this close to a node or focus that it runs into."""

RTOL: Final = 1e-8
"""Of the integration, relative to the state; the absolute one is relative to the domain."""

MOST_STEPS: Final = 10_000
"""A path that needs more steps chatters along a jump of the field: what is shown of it ends."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Follower:
    """Follows paths in one direction of time.

    times: (T,) when paths are first looked at, rising or falling from 0. ends: (k, m) nodes and
    foci at which they end.
    """

    view: Slice
    times: Array
    ends: Array


def coarse_paths(follower: Follower, starts: Array) -> Array:
    """Points (L, T, m) from `starts` at the follower's times, NaN beyond the longest length."""
    points = _points(follower, starts, follower.times)
    steps = np.linalg.norm(np.diff(points, axis=1) / follower.view.width, axis=-1)
    length = np.concatenate([np.zeros((len(points), 1)), np.nancumsum(steps, axis=1)], axis=1)
    return np.where((length <= LONGEST)[..., None], points, np.nan)


def follow(follower: Follower, start: Array) -> Trajectory:
    """The path from `start` (m,), looked at as often as its speed asks."""
    coarse = _points(follower, start[None], follower.times)[0]
    times = _times_between(follower, coarse)
    points = _points(follower, start[None], times)[0]
    count = _useful(follower, points)
    return Trajectory(frozen(times[:count]), frozen(points[:count]), 0)


def turned_round(path: Trajectory) -> Trajectory:
    """A path that was followed backward, in the direction of time."""
    times = frozen(path.times[::-1])
    return Trajectory(times, frozen(path.points[::-1]), len(times) - 1)


def joined(before: Trajectory, after: Trajectory) -> Trajectory:
    """What came before a point and what comes after it, as one path."""
    return Trajectory(
        frozen(np.concatenate([before.times[:-1], after.times])),
        frozen(np.concatenate([before.points[:-1], after.points])),
        len(before.times) - 1,
    )


def _points(follower: Follower, starts: Array, times: Array) -> Array:
    """Points (L, T, m) along the flow, continuous on periodic axes, NaN outside the domain."""
    view = follower.view
    x = states_at(view, starts)
    atol = 1e-9 * float(view.width.min())
    found = adaptive(view.flow, x, view.u, times, RTOL, atol, MOST_STEPS)
    points = found.states[..., view.columns]
    steps = shortest(view, np.diff(points, axis=1))
    travelled = np.concatenate([np.zeros_like(points[:, :1]), steps.cumsum(axis=1)], axis=1)
    return np.asarray(starts[:, None] + travelled)


def _times_between(follower: Follower, points: Array) -> Array:
    """The times, more of them where `points` (T, m) run fast, up to the longest length."""
    times = follower.times
    steps = np.linalg.norm(np.diff(points, axis=0) / follower.view.width, axis=-1)
    known = np.isfinite(steps)
    # One interval more: where a path leaves the domain, it does so within it.
    ends = len(steps) if known.all() else int(np.argmin(known)) + 1
    ends = min(ends, int(np.searchsorted(np.nancumsum(steps), LONGEST)) + 1)
    parts = np.ceil(np.nan_to_num(steps[:ends], nan=0.5) / STRIDE).astype(np.int64)
    pieces = [
        np.linspace(a, b, max(1, int(n)), endpoint=False)
        for a, b, n in zip(times[:ends], times[1 : ends + 1], parts, strict=False)
    ]
    return np.concatenate([*pieces, times[ends : ends + 1]])


def _useful(follower: Follower, points: Array) -> int:
    """How many of `points` (T, m) to keep: to the domain's edge, an end, or one whole turn."""
    known = np.all(np.isfinite(points), axis=-1)
    count = len(points) if known.all() else int(np.argmin(known))
    for end in follower.ends:
        count = _until_back(follower, points[:count], end, ARRIVED)
    return _until_back(follower, points[:count], points[0], 0.5 * STRIDE)


def _until_back(follower: Follower, points: Array, place: Array, reach: float) -> int:
    """How many of `points` to keep until they come within `reach` of `place` from afar."""
    view = follower.view
    gaps = np.linalg.norm(shortest(view, points - place) / view.width, axis=-1)
    away = np.flatnonzero(gaps > 3.0 * reach)
    back = np.flatnonzero(gaps[away[0] :] < reach) if away.size else away
    return int(away[0] + back[0]) + 1 if back.size else len(points)

"""A few trajectories that show a flow: through well-spread seeds, and out of its saddles.

m: number of axes; L: lanes.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array, Booleans
from verifier.topology.features import Course, FixedPoint, Grid, PointKind, Trajectory
from verifier.topology.paths import (
    LONGEST,
    Follower,
    coarse_paths,
    follow,
    joined,
    turned_round,
)
from verifier.topology.seeds import spread
from verifier.topology.slices import Slice

CANDIDATES: Final = 36
"""Seeds that are followed; those that cover most of the portrait are kept."""

SAMPLES: Final = 400
"""Times at which every candidate is looked at before the chosen ones are followed closely."""

CELLS: Final = 20
"""The portrait is split into this many cells per axis to see what a trajectory covers."""

BESIDE_SADDLE: Final = 1e-4
"""How far from a saddle, as a share of the widths, its manifolds are begun."""

BESIDE_SOURCE: Final = 0.02
"""How far from an unstable node or focus a trajectory is begun."""

ENDS: Final = frozenset(
    {
        PointKind.STABLE_NODE,
        PointKind.STABLE_FOCUS,
        PointKind.UNSTABLE_NODE,
        PointKind.UNSTABLE_FOCUS,
    }
)


def find_trajectories(
    view: Slice, grid: Grid, fixed_points: tuple[FixedPoint, ...], count: int
) -> tuple[Trajectory, ...]:
    """Manifolds of saddles, a path out of each source, and at most `count` through other places."""
    times = np.linspace(0.0, _duration(view, grid, fixed_points), SAMPLES)
    ends = np.array([p.at for p in fixed_points if p.kind in ENDS]).reshape(-1, len(view.axes))
    ahead = Follower(view, times, ends)
    behind = Follower(view, -times, ends)
    shown = [
        *(follow(ahead, s, Course.UNSTABLE_MANIFOLD) for s in _branches(view, fixed_points, 0)),
        *(
            turned_round(follow(behind, s, Course.STABLE_MANIFOLD))
            for s in _branches(view, fixed_points, -1)
        ),
        *(follow(ahead, start, Course.SEED) for start in _beside_sources(view, fixed_points)),
    ]
    seeds = spread(view, CANDIDATES)
    chosen = _spread_out(
        view, shown, (coarse_paths(ahead, seeds), coarse_paths(behind, seeds)), count
    )
    for i in chosen:
        before = turned_round(follow(behind, seeds[i], Course.SEED))
        shown.append(joined(before, follow(ahead, seeds[i], Course.SEED)))
    return tuple(path for path in shown if len(path.times) > 1)


def _duration(view: Slice, grid: Grid, fixed_points: tuple[FixedPoint, ...]) -> float:
    """Long enough for slow places of the field, and for leaving its fixed points."""
    speed = np.linalg.norm(grid.rates / view.width, axis=-1)
    moving = speed[np.isfinite(speed) & (speed > 0.0)]
    slow = LONGEST / float(np.quantile(moving, 0.2)) if moving.size else 1.0
    rates = [
        abs(value.real)
        for point in fixed_points
        if point.kind is PointKind.SADDLE
        for value in point.eigenvalues
    ]
    return float(max(slow, 2.0 * np.log(1.0 / BESIDE_SADDLE) / min(rates))) if rates else slow


def _branches(view: Slice, fixed_points: tuple[FixedPoint, ...], column: int) -> list[Array]:
    """Starts (m,) on both sides of each saddle along the eigenvector in `column`."""
    starts: list[Array] = []
    for point in fixed_points:
        if point.kind is PointKind.SADDLE:
            direction = np.array([row[column].real for row in point.vectors]) / view.width
            nudge = BESIDE_SADDLE * direction / np.linalg.norm(direction) * view.width
            starts += [point.at + nudge, point.at - nudge]
    low, high = view.low, view.low + view.width
    return [s for s in starts if np.all(view.periodic | ((s >= low) & (s <= high)))]


def _beside_sources(view: Slice, fixed_points: tuple[FixedPoint, ...]) -> list[Array]:
    """Starts (m,) near the unstable nodes and foci, towards the middle of the domain."""
    sources = {PointKind.UNSTABLE_NODE, PointKind.UNSTABLE_FOCUS}
    starts: list[Array] = []
    for point in fixed_points:
        if point.kind in sources:
            inward = np.where(point.at > view.low + 0.5 * view.width, -1.0, 1.0)
            starts.append(point.at + BESIDE_SOURCE * inward * view.width)
    return starts


def _spread_out(
    view: Slice, shown: list[Trajectory], candidates: tuple[Array, Array], count: int
) -> list[int]:
    """Candidates, one after the other, each covering the most that nothing covered before."""
    covered = np.zeros((CELLS,) * len(view.axes), dtype=bool)
    for path in shown:
        covered |= _cells(view, path.points)
    pairs = zip(*candidates, strict=True)
    cells = [_cells(view, np.concatenate([ahead, behind])) for ahead, behind in pairs]
    chosen: list[int] = []
    while len(chosen) < count:
        gains = [int(np.sum(c & ~covered)) for c in cells]
        best = int(np.argmax(gains))
        if gains[best] < 0.4 * CELLS:
            break
        chosen.append(best)
        covered |= cells[best]
    return chosen


def _cells(view: Slice, points: Array) -> Booleans:
    """The cells (CELLS, ..., CELLS) that `points` (T, m) go through."""
    covered = np.zeros((CELLS,) * len(view.axes), dtype=bool)
    known = points[np.all(np.isfinite(points), axis=-1)]
    share = (known - view.low) / view.width
    share = np.where(view.periodic, np.mod(share, 1.0), share)
    index = np.clip((share * CELLS).astype(np.int64), 0, CELLS - 1)
    covered[tuple(index.T)] = True
    return covered

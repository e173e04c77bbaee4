"""A few trajectories that show a flow: out of its sources, and through well-spread seeds.

m: number of axes; L: lanes.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array, Booleans
from verifier.topology.features import (
    FixedPoint,
    Grid,
    PointKind,
    Separatrix,
    Trajectory,
)
from verifier.topology.paths.following import (
    LONGEST,
    Follower,
    coarse_paths,
    follow,
    joined,
    turned_round,
)
from verifier.topology.paths.seeds import spread
from verifier.topology.slices import Slice

CANDIDATES: Final = 36
"""Seeds that are followed; those that cover most of the portrait are kept."""

SAMPLES: Final = 400
"""Times at which every candidate is looked at before the chosen ones are followed closely."""

CELLS: Final = 20
"""The portrait is split into this many cells per axis to see what a trajectory covers."""

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
    view: Slice,
    grid: Grid,
    fixed_points: tuple[FixedPoint, ...],
    separatrices: tuple[Separatrix, ...],
    count: int,
) -> tuple[Trajectory, ...]:
    """A path out of each source, and at most `count` through places that nothing shows yet."""
    times = np.linspace(0.0, _duration(view, grid), SAMPLES)
    ends = np.array([p.at for p in fixed_points if p.kind in ENDS]).reshape(-1, len(view.axes))
    ahead = Follower(view, times, ends)
    behind = Follower(view, -times, ends)
    shown = [follow(ahead, start) for start in _beside_sources(view, fixed_points)]
    covered = [*(s.points for s in separatrices), *(path.points for path in shown)]
    seeds = spread(view, CANDIDATES)
    chosen = _spread_out(
        view, covered, (coarse_paths(ahead, seeds), coarse_paths(behind, seeds)), count
    )
    for i in chosen:
        before = turned_round(follow(behind, seeds[i]))
        shown.append(joined(before, follow(ahead, seeds[i])))
    return tuple(path for path in shown if len(path.times) > 1)


def _duration(view: Slice, grid: Grid) -> float:
    """Long enough for slow places of the field."""
    speed = np.linalg.norm(grid.rates / view.width, axis=-1)
    moving = speed[np.isfinite(speed) & (speed > 0.0)]
    return LONGEST / float(np.quantile(moving, 0.2)) if moving.size else 1.0


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
    view: Slice, shown: list[Array], candidates: tuple[Array, Array], count: int
) -> list[int]:
    """Candidates, one after the other, each covering the most that nothing covered before."""
    covered = np.zeros((CELLS,) * len(view.axes), dtype=bool)
    for points in shown:
        covered |= _cells(view, points)
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

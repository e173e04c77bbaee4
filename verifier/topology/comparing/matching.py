"""Which feature of one portrait is which of another, and how far it moved.

m: number of axes; widths: of the part of the domains that both share.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import Final, final

import numpy as np
from scipy.optimize import linear_sum_assignment

from runtime.arrays import Array, frozen
from verifier.topology.features import AxisRange, Cycle, FixedPoint, Portrait
from verifier.topology.slices import Slice, shortest

FARTHEST: Final = 0.25
"""Features that are further apart than this share of the widths are not the same one."""

CHANGED: Final = 0.05
"""What a change of type counts, in widths, when features are matched."""


@final
class Fate(StrEnum):
    """What became of a feature that is wanted, or wasn't."""

    SAME = "same"
    MOVED = "moved"
    CHANGED = "changed"
    MISSING = "missing"
    EXTRA = "extra"


@final
@dataclass(frozen=True, eq=False, slots=True)
class Feature:
    """A fixed point or cycle on either side; found: what there is, wanted: what should be.

    The types are empty on the side that lacks it. at: where it is (where wanted, if missing): of
    a cycle its point of largest first coordinate. moved: how far, (m,), of a cycle the farthest
    that a point of it is off. periods: found and wanted, s; 0 for fixed points. points: found and
    wanted, each (T, m): one for a fixed point, a closed path for a cycle, none where it is not.
    """

    fate: Fate
    found: str
    wanted: str
    at: Array
    moved: Array
    periods: tuple[float, float]
    points: tuple[Array, Array]


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Thing:
    """A fixed point or a cycle: its type, its points (T, m), its period, its turns."""

    kind: str
    points: Array
    period: float
    turns: tuple[int, ...]

    @property
    def at(self) -> Array:
        """The point that stands for it: of a cycle the one of largest first coordinate."""
        return frozen(self.points[int(np.argmax(self.points[:, 0]))])


def matched_features(
    view: Slice, found: Portrait, wanted: Portrait, axes: tuple[AxisRange, ...], tolerance: float
) -> tuple[Feature, ...]:
    """The fixed points, then the cycles, that `found` or `wanted` has within `axes`.

    tolerance: of places, as a share of the widths; of periods, relative.
    """
    width = np.array([axis.width for axis in axes])
    return tuple(
        feature
        for things in (_points, _cycles)
        for feature in _fates(things(axes, found), things(axes, wanted), view, width, tolerance)
    )


def _points(axes: tuple[AxisRange, ...], portrait: Portrait) -> list[_Thing]:
    return [_point(p) for p in portrait.fixed_points if _covers(axes, p.at)]


def _cycles(axes: tuple[AxisRange, ...], portrait: Portrait) -> list[_Thing]:
    return [_cycle(c) for c in portrait.cycles if all(_covers(axes, at) for at in c.points)]


def _point(point: FixedPoint) -> _Thing:
    return _Thing(str(point.kind), point.at[None], 0.0, (0,) * point.at.size)


def _cycle(cycle: Cycle) -> _Thing:
    return _Thing(f"{cycle.stability} cycle", cycle.points, cycle.period, cycle.turns)


def _covers(axes: tuple[AxisRange, ...], at: Array) -> bool:
    return all(
        axis.periodic or -1e-9 <= (value - axis.low) / axis.width <= 1.0 + 1e-9
        for axis, value in zip(axes, at, strict=True)
    )


def _fates(
    ours: list[_Thing], theirs: list[_Thing], view: Slice, width: Array, tolerance: float
) -> list[Feature]:
    gaps = [[_apart(view, a, b, width) for b in theirs] for a in ours]
    costs = (np.array(gaps).reshape(len(ours), len(theirs), width.size) / width).max(axis=-1)
    pairs = _matched(costs, ours, theirs)
    features = []
    for i, j in pairs:
        a, b = ours[i], theirs[j]
        near = costs[i, j] <= tolerance and abs(a.period - b.period) <= tolerance * b.period
        fate = Fate.CHANGED if a.kind != b.kind else Fate.SAME if near else Fate.MOVED
        features.append(
            Feature(
                fate,
                a.kind,
                b.kind,
                a.at,
                frozen(gaps[i][j]),
                (a.period, b.period),
                (a.points, b.points),
            )
        )
    still, none = frozen(np.zeros(width.size)), frozen(np.empty((0, width.size)))
    for j in sorted(set(range(len(theirs))) - {j for _, j in pairs}):
        lost = theirs[j]
        periods, points = (0.0, lost.period), (none, lost.points)
        features.append(Feature(Fate.MISSING, "", lost.kind, lost.at, still, periods, points))
    for i in sorted(set(range(len(ours))) - {i for i, _ in pairs}):
        new = ours[i]
        periods, points = (new.period, 0.0), (new.points, none)
        features.append(Feature(Fate.EXTRA, new.kind, "", new.at, still, periods, points))
    return features


def _matched(costs: Array, ours: list[_Thing], theirs: list[_Thing]) -> list[tuple[int, int]]:
    """Which of ours is which of theirs: the matching that moves and changes least in total."""
    other = np.array([[a.kind != b.kind for b in theirs] for a in ours]).reshape(costs.shape)
    # Unmatched pairs cost all the same, so that near ones are never given up for far ones.
    rows, columns = linear_sum_assignment(np.minimum(costs, FARTHEST) + CHANGED * other)
    return [(int(i), int(j)) for i, j in zip(rows, columns, strict=True) if costs[i, j] < FARTHEST]


def _apart(view: Slice, a: _Thing, b: _Thing, width: Array) -> Array:
    """The farthest, (m,), that a point of one is from the other (Hausdorff)."""
    if a.turns != b.turns:
        return np.full(width.size, np.inf)
    ways = shortest(view, a.points[:, None] - b.points[None])
    sizes = np.linalg.norm(ways / width, axis=-1)
    there = ways[np.arange(len(a.points)), sizes.argmin(axis=1)]
    back = ways[sizes.argmin(axis=0), np.arange(len(b.points))]
    every = np.abs(np.concatenate([there, back]))
    return np.asarray(every[int(np.argmax(np.linalg.norm(every / width, axis=-1)))])

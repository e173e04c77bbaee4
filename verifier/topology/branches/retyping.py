"""Where fixed points of a branch change their type although nothing bifurcates: focus and node."""

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Final

import numpy as np

from runtime.arrays import Array
from verifier.topology.branches.continuation import Bifurcation, Change, PointBranch
from verifier.topology.features import FixedPoint, PointKind, Portrait

HALVINGS: Final = 16
"""Of the interval between two samples of a branch."""

NEITHER: Final = frozenset({PointKind.DEGENERATE, PointKind.CENTER})
"""Types that are a point's at single values only."""


def retypings(
    branches: Sequence[PointBranch],
    bifurcations: Sequence[Bifurcation],
    points_at: Callable[[float], Portrait],
) -> tuple[Bifurcation, ...]:
    """Where a branch changes type between samples that no bifurcation parts, by bisection.

    points_at: the portrait at a value of the control.
    """
    found = []
    for branch in branches:
        for k, (old, new) in enumerate(pairwise(branch.kinds)):
            low, high = float(branch.values[k]), float(branch.values[k + 1])
            parted = any(low <= one.value <= high for one in bifurcations)
            if old is not new and not parted and not {old, new} & NEITHER:
                ends = (branch.points[k], branch.points[k + 1])
                found.append(_located((low, high), ends, (old, new), points_at))
    return tuple(sorted(found, key=lambda one: one.value))


def _located(
    values: tuple[float, float],
    ends: tuple[Array, Array],
    kinds: tuple[PointKind, PointKind],
    points_at: Callable[[float], Portrait],
) -> Bifurcation:
    low, high = values
    at = ends[0]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        share = (middle - values[0]) / (values[1] - values[0])
        near = _nearest(points_at(middle), ends[0] + share * (ends[1] - ends[0]))
        if near is None:
            break
        at = near.at
        low, high = (middle, high) if near.kind is kinds[0] else (low, middle)
    about = f"{_a(kinds[0])} becomes {_a(kinds[1])}"
    return Bifurcation(Change.TYPE, 0.5 * (low + high), 0.5 * (high - low), at, about)


def _nearest(seen: Portrait, place: Array) -> FixedPoint | None:
    width = np.array([axis.width for axis in seen.axes])
    gaps = [float(np.linalg.norm((p.at - place) / width)) for p in seen.fixed_points]
    return seen.fixed_points[int(np.argmin(gaps))] if gaps else None


def _a(kind: PointKind) -> str:
    return f"{'an' if kind[0] in 'aeiou' else 'a'} {kind}"

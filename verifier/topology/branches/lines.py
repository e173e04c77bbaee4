"""From portraits along a control to branches: features of neighbours that are one, joined."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arrays import Array, frozen
from verifier.topology.branches.bifurcations import Steps, matched
from verifier.topology.branches.continuation import CycleBranch, PointBranch
from verifier.topology.features import Cycle, FixedPoint, Portrait

StepsBetween: TypeAlias = Callable[[float, float], Steps]
"""How far the points at two values of the control move between them."""

LIKE: Final = 0.25
"""Two cycles of neighbours whose swings and periods differ by less, relatively, are one."""


@final
@dataclass(slots=True)
class Growing:
    """A branch under way: the values of the control, and what was found there."""

    values: list[float] = field(default_factory=list)
    points: list[FixedPoint] = field(default_factory=list)
    cycles: list[Cycle] = field(default_factory=list)


def point_branches(
    values: list[float], portraits: list[Portrait], steps_between: StepsBetween
) -> tuple[PointBranch, ...]:
    """Fixed points of portraits at the values, joined along their tangents."""
    open_ones: list[Growing] = []
    done: list[Growing] = []
    for k, (value, seen) in enumerate(zip(values, portraits, strict=True)):
        last = tuple(branch.points[-1] for branch in open_ones)
        rows = [_row(portraits[k - 1], point) for point in last]
        steps = steps_between(values[k - 1] if k else value, value)
        steps = Steps(steps.old[rows], steps.new)
        pairs, gone, new = matched(seen.axes, last, seen.fixed_points, steps)
        done += [open_ones[i] for i in gone]
        kept = []
        for i, j in sorted(pairs):
            open_ones[i].values.append(value)
            open_ones[i].points.append(seen.fixed_points[j])
            kept.append(open_ones[i])
        open_ones = kept + [Growing([value], [seen.fixed_points[j]]) for j in new]
    return tuple(
        PointBranch(
            frozen(branch.values),
            frozen(np.array([point.at for point in branch.points])),
            tuple(point.kind for point in branch.points),
        )
        for branch in (*done, *open_ones)
    )


def _row(seen: Portrait, point: FixedPoint) -> int:
    return next(i for i, other in enumerate(seen.fixed_points) if other is point)


def cycle_branches(values: list[float], portraits: list[Portrait]) -> tuple[CycleBranch, ...]:
    """Cycles of portraits at the values, joined where they hardly differ."""
    open_ones: list[Growing] = []
    done: list[Growing] = []
    for value, seen in zip(values, portraits, strict=True):
        width = np.array([axis.width for axis in seen.axes])
        free = list(seen.cycles)
        kept = []
        for branch in open_ones:
            before = branch.cycles[-1]
            unlike = [_unlike(before, cycle, width) for cycle in free]
            if not free or min(unlike) > LIKE:
                done.append(branch)
                continue
            nearest = free.pop(unlike.index(min(unlike)))
            branch.values.append(value)
            branch.cycles.append(nearest)
            kept.append(branch)
        open_ones = kept + [Growing([value], cycles=[cycle]) for cycle in free]
    return tuple(_finished(branch) for branch in (*done, *open_ones))


def _unlike(a: Cycle, b: Cycle, width: Array) -> float:
    """How different two cycles are: in reach, in widths, and in period, relatively."""
    low = np.abs(a.points.min(axis=0) - b.points.min(axis=0)) / width
    high = np.abs(a.points.max(axis=0) - b.points.max(axis=0)) / width
    period = abs(a.period - b.period) / max(a.period, b.period)
    return float(max(low.max(), high.max(), 0.5 * period))


def _finished(branch: Growing) -> CycleBranch:
    return CycleBranch(
        values=frozen(branch.values),
        lows=frozen(np.array([cycle.points.min(axis=0) for cycle in branch.cycles])),
        highs=frozen(np.array([cycle.points.max(axis=0) for cycle in branch.cycles])),
        periods=frozen([cycle.period for cycle in branch.cycles]),
        stabilities=tuple(cycle.stability for cycle in branch.cycles),
    )

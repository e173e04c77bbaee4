"""Basins: which attractor each place of a slice goes to.

m: number of axes; L: lanes, one for each cell. Distances are shares of the axes' widths.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers, frozen
from runtime.integrators import ENDINGS, adaptive, fixed_steps
from runtime.rollout import Ending
from verifier.topology.ends.capture import STABLE, Trap, traps_of, tubes_of
from verifier.topology.ends.shares import shares_within
from verifier.topology.ends.tubes import Tube, gaps_to
from verifier.topology.features import Attractor, Basins, Cycle, FixedPoint, PointKind
from verifier.topology.paths.motion import pace
from verifier.topology.slices import Slice, shortest, states_at, wrapped

LEAVES: Final = -1
OPEN: Final = -2

MOST_CELLS: Final = {1: 4096, 2: 512, 3: 40, 4: 12}
"""Cells per axis at most, by the number of axes."""

TOLERANCE: Final = 1e-6
"""The local error of a step, as a share of the widths and relative to the state."""

MOST_STEPS: Final = 3_000
"""A lane that needs more steps until the next look chatters along a jump of the field."""

GROWTH: Final = 1.4
"""Looks get rarer: the first is after one typical crossing of the domain."""

LOOKS: Final = 14
"""How often lanes are looked at before those that came to no end are left open."""

STEPS: Final = 40
"""Steps of a map between two looks."""

CLOSER: Final = 0.95
"""What converges is closer by this factor at the next look."""

ON_IT: Final = 0.25
"""So close to a stable cycle, as a share of a tube's reach, a lane need not come closer."""

CLOSE: Final = 0.02
"""A lane that still comes closer at the end converges to a degenerate point this close."""


@final
@dataclass(frozen=True, slots=True)
class Goal:
    """What lanes may come to; `certain` if it attracts all that is near."""

    is_cycle: bool
    index: int
    certain: bool


@final
@dataclass(frozen=True, eq=False, slots=True)
class Lanes:
    """Lanes on the way: which of all they are (L,), where they are and were before, (L, m)."""

    number: Integers
    at: Array
    before: Array

    def some(self, chosen: Booleans) -> "Lanes":
        """Only those of `chosen` (L,)."""
        return Lanes(self.number[chosen], self.at[chosen], self.before[chosen])


def find_basins(
    view: Slice, fixed_points: Sequence[FixedPoint], cycles: Sequence[Cycle], cells: int
) -> Basins | None:
    """The attractor of the centre of each of `cells` per axis; None where nothing attracts.

    A place has reached a fixed point once it is in one of its traps (see `capture`), a cycle once
    it is close to it at two looks and comes closer. Listed are all stable points and cycles, and
    half-stable ones that some place goes to. What came to no end in the time is open: on a
    separatrix, round a center, on the way to something that is not listed.
    """
    if cells < 1 or not (fixed_points or cycles):
        return None
    traps = traps_of(view, fixed_points, cycles, 1)
    tubes = tubes_of(view, fixed_points, cycles, 1)
    goals = _goals(fixed_points, cycles, traps, tubes)
    if not goals:
        return None
    centres = centres_of(view, min(cells, MOST_CELLS[len(view.axes)]))
    starts = np.stack(np.meshgrid(*centres, indexing="ij"), axis=-1).reshape(-1, len(view.axes))
    labels, lanes = _followed(view, goals, traps, tubes, starts)
    _label_converging(view, goals, fixed_points, labels, lanes)
    return _basins(goals, centres, labels)


def _goals(
    fixed_points: Sequence[FixedPoint],
    cycles: Sequence[Cycle],
    traps: Sequence[Trap],
    tubes: Sequence[Tube],
) -> tuple[Goal, ...]:
    """Points first, then cycles, in their order."""
    trapping = {trap.index for trap in traps}
    points = [
        Goal(is_cycle=False, index=i, certain=point.kind in STABLE)
        for i, point in enumerate(fixed_points)
        if point.kind in STABLE or point.kind is PointKind.DEGENERATE or i in trapping
    ]
    closed = [
        Goal(is_cycle=True, index=tube.index, certain=cycles[tube.index].is_attracting)
        for tube in tubes
    ]
    return (*points, *closed)


def centres_of(view: Slice, count: int) -> tuple[Array, ...]:
    """Per axis the centres of `count` cells that fill it."""
    shares = (np.arange(count) + 0.5) / count
    return tuple(frozen(axis.low + shares * axis.width) for axis in view.axes)


def _followed(
    view: Slice,
    goals: Sequence[Goal],
    traps: Sequence[Trap],
    tubes: Sequence[Tube],
    starts: Array,
) -> tuple[Integers, Lanes]:
    """For each of `starts` the index of its goal, `LEAVES` or `OPEN`; the lanes that are open."""
    labels = np.full(len(starts), OPEN)
    points = {goal.index: k for k, goal in enumerate(goals) if not goal.is_cycle}
    closed = {goal.index: k for k, goal in enumerate(goals) if goal.is_cycle}
    lanes = Lanes(np.arange(len(starts)), starts, np.full_like(starts, np.nan))
    typical = 0.0 if view.is_map else pace(view)
    for look in range(LOOKS + 1):
        for trap in traps:
            labels[lanes.number[trap.holds(view, lanes.at)]] = points[trap.index]
        for tube in tubes:
            k = closed[tube.index]
            labels[lanes.number[_settled(view, tube, lanes, certain=goals[k].certain)]] = k
        lanes = lanes.some(labels[lanes.number] == OPEN)
        if not lanes.number.size or look == LOOKS:
            break
        at, gone = _moved(view, lanes.at, typical * GROWTH**look)
        labels[lanes.number[gone]] = LEAVES
        lanes = Lanes(lanes.number, at, lanes.at).some(np.all(np.isfinite(at), axis=-1))
    return labels, lanes


def _settled(view: Slice, tube: Tube, lanes: Lanes, *, certain: bool) -> Booleans:
    """Which lanes (L,) are close to the cycle now, were before, and have come closer."""
    settled = gaps_to(view, tube, lanes.at) <= tube.reach
    near = np.flatnonzero(settled)
    now, before = (gaps_to(view, tube, at[near]) for at in (lanes.at, lanes.before))
    closer = now <= CLOSER * before
    if certain:
        closer |= now <= ON_IT * tube.reach
    settled[near] = closer & (before <= tube.reach)
    return settled


def _moved(view: Slice, starts: Array, duration: float) -> tuple[Array, Booleans]:
    """Where `starts` (L, m) are after the duration, or after some steps; which left the domain."""
    x = states_at(view, starts)
    n, p = x.shape[-1], view.u.size
    if view.is_map:
        times = view.program.field.every * np.arange(STEPS + 1.0)
        found = fixed_steps(view.flow, x, times, view.u[None, None], np.arange(n, n + p))
    else:
        atol = np.full(n, TOLERANCE)
        atol[list(view.columns)] *= view.width
        times = np.array([0.0, duration])
        found = adaptive(view.flow, x, view.u, times, TOLERANCE, atol, MOST_STEPS)
    at = wrapped(view, found.states[:, -1, view.columns])
    return at, np.asarray(found.endings == ENDINGS.index(Ending.LEFT_DOMAIN))


def _label_converging(
    view: Slice,
    goals: Sequence[Goal],
    fixed_points: Sequence[FixedPoint],
    labels: Integers,
    lanes: Lanes,
) -> None:
    """Label what slowly comes closer to a degenerate point, as near x' = -x³ or x' = x²."""
    for k, goal in enumerate(goals):
        if not goal.is_cycle and fixed_points[goal.index].kind is PointKind.DEGENERATE:
            place = fixed_points[goal.index].at
            now, before = (
                np.linalg.norm(shortest(view, at - place) / view.width, axis=-1)
                for at in (lanes.at, lanes.before)
            )
            labels[lanes.number[(now < CLOSE) & (now <= CLOSER * before)]] = k


def _basins(goals: Sequence[Goal], centres: tuple[Array, ...], labels: Integers) -> Basins:
    """The goals that attract, numbered anew, with their shares."""
    shares = [float(np.mean(labels == k)) for k in range(len(goals))]
    kept = [k for k, goal in enumerate(goals) if goal.certain or shares[k] > 0.0]
    number = np.full(len(goals) + 2, OPEN)
    number[kept] = np.arange(len(kept))
    number[LEAVES] = LEAVES
    cells = number[labels].reshape([len(axis) for axis in centres])
    *within, leaves_within, open_within = shares_within(cells, [*range(len(kept)), LEAVES, OPEN])
    return Basins(
        centres=centres,
        labels=cells,
        attractors=tuple(
            Attractor(goals[k].is_cycle, goals[k].index, shares[k], off)
            for k, off in zip(kept, within, strict=True)
        ),
        leaves=float(np.mean(labels == LEAVES)),
        open=float(np.mean(labels == OPEN)),
        leaves_within=leaves_within,
        open_within=open_within,
    )

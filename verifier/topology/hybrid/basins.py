"""Basins with modes: which attractor each place of the shown mode goes to, through all switches.

m: number of axes; L: lanes. Distances are shares of the axes' widths.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.integrators import ENDINGS
from runtime.rollout import Ending
from verifier.topology.ends.basins import LEAVES, MOST_CELLS, OPEN, centres_of
from verifier.topology.ends.capture import STABLE
from verifier.topology.ends.shares import shares_within
from verifier.topology.features import Attractor, Basins, Cycle, FixedPoint
from verifier.topology.hybrid.flow import Hybrid, followed, on_axes, points_in

LOOKS: Final = (2.0, 3.0, 5.0, 10.0, 20.0, 40.0, 80.0, 160.0)
"""How long, in tempos, lanes go on from look to look, those that have come to no end."""
TOLERANCE: Final = 1e-6
AGAIN: Final = 0.37
"""How much later, in tempos, a lane must still be there: it may only have passed."""
NEAR: Final = 0.02
AT_ONCE: Final = 512
"""Lanes whose distances are taken at once."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Goal:
    """An attractor, as `points` (k, 1 + m): the mode, and shares of the widths.

    periodic: (1 + m,) which of these go round.
    """

    is_cycle: bool
    index: int
    points: Array
    periodic: Booleans

    def holds(self, places: Array) -> Booleans:
        """Which of `places` (L, 1 + m) are near; modes are far apart."""
        near = np.zeros(len(places), dtype=np.bool_)
        for begin in range(0, len(places), AT_ONCE):
            part = slice(begin, begin + AT_ONCE)
            gaps = places[part, None] - self.points
            gaps -= np.where(self.periodic, np.round(gaps), 0.0)
            # What is unknown is not near.
            near[part] = (np.sum(gaps * gaps, axis=-1) < NEAR**2).any(axis=-1)
        return near


def find_hybrid_basins(
    hybrid: Hybrid,
    fixed_points: tuple[tuple[FixedPoint, int], ...],
    cycles: tuple[Cycle, ...],
    cells: int,
) -> Basins | None:
    """The attractor of the centre of each of `cells` per axis; None where nothing attracts.

    fixed_points: each with its mode. What leaves the domain on the way, also by a jump,
    leaves; what chatters is open.
    """
    goals = _goals(hybrid, fixed_points, cycles)
    if cells < 1 or not goals or not np.isfinite(hybrid.tempo):
        return None
    view = hybrid.view
    centres = centres_of(view, min(cells, MOST_CELLS[len(view.axes)]))
    starts = np.stack(np.meshgrid(*centres, indexing="ij"), axis=-1).reshape(-1, len(view.axes))
    labels = _labelled(hybrid, goals, starts)
    cells_of = labels.reshape([len(axis) for axis in centres])
    *within, leaves_within, open_within = shares_within(
        cells_of, [*range(len(goals)), LEAVES, OPEN]
    )
    share = [float(np.mean(labels == k)) for k in range(len(goals))]
    return Basins(
        centres=centres,
        labels=cells_of,
        attractors=tuple(
            Attractor(goal.is_cycle, goal.index, part, off)
            for goal, part, off in zip(goals, share, within, strict=True)
        ),
        leaves=float(np.mean(labels == LEAVES)),
        open=float(np.mean(labels == OPEN)),
        leaves_within=leaves_within,
        open_within=open_within,
    )


def _goals(
    hybrid: Hybrid, fixed_points: tuple[tuple[FixedPoint, int], ...], cycles: tuple[Cycle, ...]
) -> tuple[Goal, ...]:
    view = hybrid.view
    points = [
        _goal(hybrid, i, point.at[None], np.array([mode]), is_cycle=False)
        for i, (point, mode) in enumerate(fixed_points)
        if point.kind in STABLE
    ]
    closed = [
        _goal(hybrid, i, cycle.points, np.array(cycle.modes), is_cycle=True)
        for i, cycle in enumerate(cycles)
        if cycle.is_attracting and cycle.points.shape[-1] == len(view.axes)
    ]
    return (*points, *closed)


def _goal(hybrid: Hybrid, index: int, points: Array, modes: Array, *, is_cycle: bool) -> Goal:
    periodic = np.array([False, *hybrid.view.periodic])
    return Goal(is_cycle, index, _places(hybrid, points, modes), periodic)


def _places(hybrid: Hybrid, points: Array, modes: Array) -> Array:
    """Modes, and shares of the widths, (L, 1 + m)."""
    shares = (points - hybrid.view.low) / hybrid.view.width
    shares = np.where(hybrid.view.periodic, np.mod(shares, 1.0), shares)
    return np.column_stack([modes, shares])


def _labelled(hybrid: Hybrid, goals: tuple[Goal, ...], starts: Array) -> Integers:
    labels = np.full(len(starts), OPEN)
    waiting = np.arange(len(starts))
    states = points_in(hybrid, starts, hybrid.shown)
    for look in LOOKS:
        times = hybrid.tempo * np.array([0.0, look, look + AGAIN])
        ran = followed(hybrid, states, times, TOLERANCE)
        for k, goal in enumerate(goals):
            there = [
                goal.holds(_places(hybrid, on_axes(hybrid, x), x[:, hybrid.column]))
                for x in (ran.states[:, 1], ran.states[:, 2])
            ]
            labels[waiting[there[0] & there[1]]] = k
        gone = ran.endings == ENDINGS.index(Ending.LEFT_DOMAIN)
        labels[waiting[gone]] = LEAVES
        going = (labels[waiting] == OPEN) & (ran.endings == ENDINGS.index(Ending.COMPLETED))
        waiting, states = waiting[going], ran.states[going, 2]
        if not waiting.size:
            break
    return labels

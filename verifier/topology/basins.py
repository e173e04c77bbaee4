"""Basins: which attractor each place of a slice goes to.

m: number of axes; L: lanes, one for each cell.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers, frozen
from runtime.integrators import ENDINGS, adaptive
from runtime.rollout import Ending
from verifier.topology.capture import STABLE, beside, trapped, traps_of, tubes_of
from verifier.topology.features import (
    Attractor,
    Basins,
    Cycle,
    FixedPoint,
)
from verifier.topology.motion import pace
from verifier.topology.slices import Slice, states_at, wrapped

LEAVES: Final = -1
OPEN: Final = -2

MOST_CELLS: Final = {1: 4096, 2: 512, 3: 40, 4: 12}
"""Cells per axis at most, by the number of axes."""

TOLERANCE: Final = 1e-6
"""The local error of a step, as a share of the widths and relative to the state."""

MOST_STEPS: Final = 3_000
"""A lane that needs more steps in one look chatters along a jump of the field."""

FIRST_LOOK: Final = 1.0
"""After how many typical crossings of the domain lanes are looked at first; then less often."""

GROWTH: Final = 1.4

LOOKS: Final = 14
"""How often lanes are looked at before those that came to no end are left open."""

STEPS: Final = 4_000
"""Steps of a map before its lanes are left open."""

CLOSE: Final = 0.02
"""A lane that still comes closer at the end converges to a point or cycle that is this close."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Lanes:
    """Where lanes are: `at` (L, m), NaN after the domain was left, and `gone` (L,) if it was."""

    at: Array
    gone: Booleans


def find_basins(
    view: Slice, fixed_points: Sequence[FixedPoint], cycles: Sequence[Cycle], cells: int
) -> Basins | None:
    """The attractor of the centre of each of `cells` per axis; None where nothing attracts.

    A place has reached a fixed point once it is in its trap (see `capture`), a cycle once it is
    close to it at two looks, one after the other. What came to no end within the time is open:
    places on a separatrix, round a center, on the way to something that nobody listed.
    """
    ends = _attracting(fixed_points, cycles)
    if not ends or cells < 1:
        return None
    centres = _centres(view, min(cells, MOST_CELLS[len(view.axes)]))
    starts = np.stack(np.meshgrid(*centres, indexing="ij"), axis=-1)
    labels = _labels(view, fixed_points, cycles, ends, starts.reshape(-1, len(view.axes)))
    return Basins(
        centres=centres,
        labels=labels.reshape(starts.shape[:-1]),
        attractors=tuple(
            Attractor(is_cycle, index, float(np.mean(labels == k)))
            for k, (is_cycle, index) in enumerate(ends)
        ),
        leaves=float(np.mean(labels == LEAVES)),
        open=float(np.mean(labels == OPEN)),
    )


def _attracting(
    fixed_points: Sequence[FixedPoint], cycles: Sequence[Cycle]
) -> tuple[tuple[bool, int], ...]:
    """The attractors, as (is a cycle, index); first the fixed points."""
    return (
        *((False, i) for i, point in enumerate(fixed_points) if point.kind in STABLE),
        *((True, i) for i, cycle in enumerate(cycles) if cycle.is_attracting),
    )


def _centres(view: Slice, count: int) -> tuple[Array, ...]:
    shares = (np.arange(count) + 0.5) / count
    return tuple(frozen(axis.low + shares * axis.width) for axis in view.axes)


def _labels(
    view: Slice,
    fixed_points: Sequence[FixedPoint],
    cycles: Sequence[Cycle],
    ends: tuple[tuple[bool, int], ...],
    starts: Array,
) -> Integers:
    """For each of `starts` (L, m) the index into `ends`, `LEAVES` or `OPEN`."""
    number = {end: k for k, end in enumerate(ends)}
    traps = traps_of(view, fixed_points, cycles, 1)
    tubes = [
        tube for tube in tubes_of(view, fixed_points, cycles, 1) if (True, tube.index) in number
    ]
    labels = np.full(len(starts), OPEN)
    beside_before = np.full(len(starts), OPEN)
    lanes, at = np.arange(len(starts)), starts
    duration = FIRST_LOOK * pace(view)
    for look in range(LOOKS + 1):
        for trap in traps:
            labels[lanes[trapped(view, trap, at)]] = number[False, trap.index]
        for tube in tubes:
            k = number[True, tube.index]
            near = lanes[beside(view, tube, at)]
            labels[near[beside_before[near] == k]] = k
            beside_before[near] = k
        lanes, at = lanes[labels[lanes] == OPEN], at[labels[lanes] == OPEN]
        if not lanes.size or look == LOOKS:
            break
        moved = _moved(view, at, duration)
        labels[lanes[moved.gone]] = LEAVES
        known = np.all(np.isfinite(moved.at), axis=-1)
        lanes, at = lanes[known], moved.at[known]
        duration *= GROWTH
    return labels


def _moved(view: Slice, starts: Array, duration: float) -> Lanes:
    """Where `starts` (L, m) are after some time."""
    x = states_at(view, starts)
    atol = np.full(x.shape[-1], TOLERANCE)
    atol[list(view.columns)] *= view.width
    times = np.array([0.0, duration])
    found = adaptive(view.flow, x, view.u, times, TOLERANCE, atol, MOST_STEPS)
    at = wrapped(view, found.states[:, -1, view.columns])
    return Lanes(at, found.endings == ENDINGS.index(Ending.LEFT_DOMAIN))

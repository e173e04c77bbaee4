"""The mean lap of the robot, and how far it swings.

All samples of the laps are laid over one another by phase and smoothed by a local parabola. What
smoothing does to a sharp turn it does to the spec's cycle, too, when that is sampled at the same
phases: the robot's swing is the spec's plus the difference of the two smooth laps. Intervals come
from resampling whole laps (the bootstrap of blocks, a lap being a block).

A cycle that changes its mode has corners and jumps there. The phase of a sample is then told from
the changes before and after it, and each arc between two changes is smoothed on its own.

Letters: N samples, G phases of the grid, k laps, m axes, B resamples.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Integers
from verifier.report.features import Estimate
from verifier.robot_topology.intervals import student
from verifier.robot_topology.laps import FEWEST, Laps, on_cycle
from verifier.robot_topology.swings import swing, swing_with_corners
from verifier.topology.features import Cycle

GRID: Final = 120
WIDTH: Final = 0.03
"""Of the smoother, in laps."""
PER_PHASE: Final = 6.0
"""The smoother is wide enough to hold so many samples."""
PER_END: Final = 4.0
"""And at the end of an arc, to one side, so many of each lap."""
RESAMPLES: Final = 200
MOST: Final = 20_000
"""So many samples are enough."""
BLOCKS: Final = 60
"""Of more laps, successive ones are taken together."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Samples:
    """Samples by phase in [0, 1): `values` (N, m), `spec` (N, m) there, the `lap` of each (N,).

    arcs: phases in [0, 1) at which the arcs begin, the first one 0; empty for a smooth cycle.
    step: from a sample to the next, in laps.
    """

    phase: Array
    values: Array
    spec: Array
    lap: Integers
    arcs: Array
    step: float


@final
@dataclass(frozen=True, eq=False, slots=True)
class MeanLap:
    """`points` (G, m) of the robot; its swing on each axis from `lowest` to `highest`."""

    points: Array
    lowest: tuple[Estimate, ...]
    highest: tuple[Estimate, ...]
    amplitude: tuple[Estimate, ...]


def mean_lap(
    laps: tuple[Laps, ...], cycle: Cycle, confidence: float, rng: np.random.Generator
) -> MeanLap | None:
    """The mean lap, None for fewer than three laps."""
    samples = _gathered(laps, cycle)
    count = int(samples.lap.max(initial=-1)) + 1
    if count < FEWEST:
        return None
    grid = _grid(samples.arcs)
    moments, of_robot = _moments(samples, samples.values, grid, count)
    _, of_spec = _moments(samples, samples.spec, grid, count)
    everything = np.ones((1, count))
    picks = rng.multinomial(count, np.full(count, 1.0 / count), RESAMPLES).astype(np.float64)
    swings = swing_with_corners if len(samples.arcs) else swing
    exact = spec_swing(cycle)
    plain = swings(_smooth(everything, moments, of_spec))
    loop = _smooth(everything, moments, of_robot)
    drawn = swings(_smooth(picks, moments, of_robot)) - swings(_smooth(picks, moments, of_spec))
    # The highest of many noisy values is too high, in resamples once more by as much.
    value = (2.0 * (swings(loop) - plain) - np.mean(drawn, axis=0) + exact)[0]
    error = np.sqrt(count / (count - 1.0)) * np.std(drawn, axis=0)
    low, high, amplitude = (
        tuple(
            student(float(v), float(e), count, confidence)
            for v, e in zip(values, errors, strict=True)
        )
        for values, errors in zip(value, error, strict=True)
    )
    return MeanLap(loop[0], low, high, amplitude)


def spec_swing(cycle: Cycle) -> Array:
    """Lowest, highest and half their distance (3, m) of the spec's own cycle."""
    return swing_with_corners(cycle.points)


def _grid(arcs: Array) -> Array:
    """Phases at which the lap is smoothed: those of each arc from end to end."""
    if not len(arcs):
        return np.arange(GRID) / GRID
    ends = np.append(arcs, 1.0)
    return np.concatenate(
        [
            np.linspace(low, np.nextafter(high, low), max(3, round(GRID * (high - low))))
            for low, high in pairwise(ends)
        ]
    )


def _gathered(laps: tuple[Laps, ...], cycle: Cycle) -> Samples:
    phases, values, spec, lap = [], [], [], []
    before = 0
    for each in laps:
        origin = each.arcs[0] if len(each.arcs) else 0.0
        times, inside = each.stretch.times, each.stretch.values
        kept = (times >= each.starts[0]) & (times < each.starts[-1])
        gone = _phases(each, times[kept])
        index = np.floor(gone).astype(np.int64)
        phases.append(gone - index)
        spec.append(on_cycle(cycle, phases[-1] + origin))
        values.append(_on_one_turn(inside[kept], index, spec[-1], cycle))
        lap.append(index + before)
        before += each.count
    if not phases:
        none, axes = np.empty(0), np.empty((0, cycle.points.shape[1]))
        return Samples(none, axes, axes, np.empty(0, np.int64), none, 0.0)
    arcs = laps[0].arcs
    every = slice(None, None, max(1, sum(map(len, phases)) // MOST))
    which = np.concatenate(lap) * min(before, BLOCKS) // max(before, 1)
    return Samples(
        phase=np.concatenate(phases)[every],
        values=np.concatenate(values)[every],
        spec=np.concatenate(spec)[every],
        lap=which[every],
        arcs=arcs - arcs[0] if len(arcs) else arcs,
        step=max(each.stretch.step * each.count / np.ptp(each.starts) for each in laps),
    )


def _phases(laps: Laps, times: Array) -> Array:
    """How many laps have gone by at `times`, between the passages that are known."""
    if not len(laps.arcs):
        return np.asarray(np.interp(times, laps.starts, np.arange(laps.count + 1.0)))
    gone = np.arange(laps.count + 1.0)[:, None] + (laps.arcs - laps.arcs[0])
    passages = laps.passages.T
    known = np.isfinite(passages) & (passages <= laps.starts[-1])
    return np.asarray(np.interp(times, passages[known], gone[known]))


def _on_one_turn(values: Array, index: Integers, spec: Array, cycle: Cycle) -> Array:
    """Angles of each lap moved by whole turns to where the spec's cycle is."""
    moved = np.array(values)
    for j, turns in enumerate(cycle.turns):
        period = abs(cycle.points[-1, j] - cycle.points[0, j]) / turns if turns else 0.0
        if period == 0.0:
            continue
        for lap in np.unique(index):
            own = index == lap
            off = np.median(values[own, j] - spec[own, j])
            moved[own, j] -= abs(period) * np.rint(off / abs(period))
    return moved


def _moments(samples: Samples, values: Array, grid: Array, count: int) -> tuple[Array, Array]:
    """Per lap the normal equations of the parabola at each phase: (k, G, 3, 3), (k, G, 3, m)."""
    width = max(WIDTH, 0.5 * PER_PHASE / max(len(samples.phase), 1))
    if len(samples.arcs):
        width = max(width, PER_END * samples.step)
    together = _arc(samples, grid)[:, None] == _arc(samples, samples.phase)[None, :]
    normal = np.zeros((count, len(grid), 3, 3))
    right = np.zeros((count, len(grid), 3, values.shape[1]))
    for lap in range(count):
        own = samples.lap == lap
        off = samples.phase[own][None, :] - grid[:, None]
        off = (off - (0.0 if len(samples.arcs) else np.rint(off))) / width
        weight = np.maximum(1.0 - off**2, 0.0) * together[:, own]
        powers = np.stack([np.ones_like(off), off, off**2], axis=-1)
        weighted = powers * weight[..., None]
        normal[lap] = np.einsum("gni,gnj->gij", weighted, powers)
        right[lap] = np.einsum("gni,nj->gij", weighted, values[own])
    return normal, right


def _arc(samples: Samples, phases: Array) -> Integers:
    """On which arc each phase lies."""
    return np.asarray(np.searchsorted(samples.arcs, phases, side="right"))


def _smooth(picks: Array, normal: Array, right: Array) -> Array:
    """The smooth lap (B, G, m) of each choice of laps, `picks` (B, k) saying how often each."""
    matrix = np.einsum("bk,kgij->bgij", picks, normal)
    trace = np.trace(matrix, axis1=-2, axis2=-1)[..., None, None]
    matrix += 1e-9 * np.maximum(trace, 1e-300) * np.eye(3)
    sides = np.einsum("bk,kgij->bgij", picks, right)
    return np.asarray(np.linalg.solve(matrix, sides)[..., 0, :])

"""A copy of a trace as a robot with a known fault would have left it.

The copy is y' = y + d: what was measured, and by how much the faulty robot would have been
elsewhere, with

    d' = f_faulty(y + d, u') - f(y, u),    d = 0 where a judged stretch begins,

f the spec's rates, y the measured states, u the measured inputs, u' the late ones. So the
copy has the trace's own noise, gaps, inputs and process noise, and whatever else the robot did. A
fault of a sensor adds its constant to the log, and the robot does not change.

All faults and sizes are integrated at once, as lanes: L lanes, K knots, n states, D predicted.
"""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Integers
from verifier.fidelity.shooting.noise import quantum_of
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.needs import period_of
from verifier.fidelity.stretches.segments import GAP_PERIODS, GAP_SECONDS
from verifier.fidelity.stretches.spans import contains
from verifier.limits.knots import Knots, knots_of
from verifier.limits.lanes import Lane, integrated
from verifier.report.limits import Fault
from verifier.traces.trace import Series, Trace

FINE: Final = 0.1
"""A quantum is no larger than this share of a series' range: a series of two values has none."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Plantings:
    """The deviation of every robot's lane: `deviations` (K, L, D); cuts (c, 2): lane and knot.

    A fault of a sensor leaves the robot where it was.
    """

    study: Study
    knots: Knots
    lanes: tuple[Lane, ...]
    deviations: Array
    cuts: Integers


def plant(study: Study, lanes: tuple[Lane, ...]) -> Plantings:
    """The deviations of robots with the faults of `lanes`."""
    knots = knots_of(study)
    moving = np.array([lane.planned.fault is not Fault.SENSOR for lane in lanes], dtype=bool)
    acting = tuple(lane for lane, moves in zip(lanes, moving, strict=True) if moves)
    deviations = np.zeros((len(knots.times), len(lanes), len(study.plan.needs.driven)))
    deviations[:, moving], cuts = integrated(study, knots, acting)
    cuts[:, 0] = np.flatnonzero(moving)[cuts[:, 0]]
    return Plantings(study, knots, lanes, deviations, cuts)


def copy_of(trace: Trace, plantings: Plantings, lane: int, rng: np.random.Generator) -> Trace:
    """The trace as the robot of one lane would have left it; `rng` is for rounding to a quantum."""
    needs, knots = plantings.study.plan.needs, plantings.knots
    starts = knots.times[plantings.cuts[plantings.cuts[:, 0] == lane, 1] - 1]
    gap = 1.01 * max(GAP_SECONDS, *(GAP_PERIODS * period_of(s.times) for s in needs.series))
    gaps = np.column_stack([starts, starts + gap])
    planned, size = plantings.lanes[lane].planned, plantings.lanes[lane].size
    if planned.fault is Fault.SENSOR:
        shown = trace.series[planned.variable]
        wrong = replace(shown, values=shown.values + size)
        return replace(trace, series=trace.series | {planned.variable: wrong})
    changed = {}
    for j, series in enumerate(needs.series):
        deviation = np.interp(series.times, knots.times, plantings.deviations[:, lane, j])
        deviation = np.where(contains(knots.spans, series.times), deviation, 0.0)
        changed[series.name] = _without(_moved(series, deviation, rng), gaps)
    return replace(trace, series=trace.series | changed)


def _moved(series: Series, deviation: Array, rng: np.random.Generator) -> Series:
    """The series with a deviation added; that of a quantised sensor stays on its steps.

    Rounding up or down by chance, so that a deviation below one step is not lost.
    """
    quantum = quantum_of(series.values)
    if 0.0 < quantum <= FINE * float(np.ptp(series.values)):
        deviation = quantum * np.floor(deviation / quantum + rng.random(len(deviation)))
    return replace(series, values=series.values + deviation)


def _without(series: Series, gaps: Array) -> Series:
    kept = ~np.any(
        (series.times[:, None] > gaps[:, 0]) & (series.times[:, None] < gaps[:, 1]), axis=1
    )
    return replace(series, times=series.times[kept], values=series.values[kept])

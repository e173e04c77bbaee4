"""Which stretches of a trace are judged, and why the others are not.

A stretch is cut where a needed series has a gap (longer than five of its median periods and than
half a second), where `judge_when` is false, where a variable is outside its domain, where the mode
switches, since states may jump there, and where what is left is shorter than the horizon.

A switch does not cut beside a stay that is too short for windows of its own, if its time is known
well enough: there windows go on through the switch, at the time at which the robot took it, with
the jump that the spec gives it.
"""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array
from runtime.machine import evaluate
from runtime.program import Control, Kind, Program, State
from verifier.fidelity.stretches.needs import Needs, changes_of, held, parts_of, period_of
from verifier.fidelity.stretches.spans import contains, intersect, length, spans_of, without
from verifier.report.report import Exclusion
from verifier.traces.trace import Series

GAP_PERIODS = 5.0
GAP_SECONDS = 0.5
STAY = 1.5
"""A stay in a mode that is shorter than so many horizons is too short for windows of its own."""
SURE = 1e-3
"""The time of a switch is known well enough within this share of the horizon."""
EDGE = 1e-9
"""How far beyond its domain, as a share of it, a value may be by rounding."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Segments:
    """The judged stretches (k, 2), what was taken out, and the whole stretch (start, end)."""

    spans: Array
    exclusions: tuple[Exclusion, ...]
    whole: tuple[float, float]


def segments_of(program: Program, needs: Needs, horizon: float) -> Segments:
    """The judged stretches of the trace: every cause takes from what the ones before it left."""
    base = needs.series[needs.base].times
    left = spans_of([(float(base[0]), float(base[-1]))])
    exclusions = []
    switches = _switches(program, needs, left, horizon)
    for cause, allowed in [*_causes(program, needs, left), *switches]:
        kept = intersect(left, allowed)
        exclusions += _exclusion(cause, left, kept, base)
        left = kept
    long_enough = left[left[:, 1] - left[:, 0] >= horizon * (1.0 - EDGE)]
    exclusions += _exclusion(too_short_cause(horizon), left, long_enough, base)
    return Segments(long_enough, tuple(exclusions), (float(base[0]), float(base[-1])))


def too_short_cause(horizon: float) -> str:
    """The cause of what is left out because the others have left too little of it."""
    return f"shorter than the horizon of {horizon:g} s"


def spans_between_exclusions(program: Program, needs: Needs) -> Array:
    """The stretches (k, 2) of any length that may be judged, with switches of the mode in them."""
    base = needs.series[needs.base].times
    left = spans_of([(float(base[0]), float(base[-1]))])
    for _, allowed in _causes(program, needs, left):
        left = intersect(left, allowed)
    return left


def _causes(program: Program, needs: Needs, whole: Array) -> list[tuple[str, Array]]:
    """Each cause of exclusion with the spans (k, 2) that it leaves."""
    told = [s for s in (each.series for each in (*needs.inputs, *needs.signals)) if s is not None]
    held_on = [(series, period_of(series.times)) for series in told]
    covered = [
        each
        for series, hold in [*((series, 0.0) for series in needs.series), *held_on]
        for each in _covered(series, hold)
    ]
    judged = [("judge_when is false", _judged(program, needs, whole))]
    domains = [
        (f"{part.name} outside its domain", inside)
        for part, _, inside in inside_domains(program, needs, whole)
    ]
    return [*covered, *judged, *domains]


def _exclusion(cause: str, before: Array, after: Array, base: Array) -> list[Exclusion]:
    seconds = length(before) - length(after)
    samples = int(np.sum(contains(before, base))) - int(np.sum(contains(after, base)))
    return [Exclusion(cause, seconds, samples)] if samples > 0 or seconds > EDGE else []


def _covered(series: Series, hold: float) -> list[tuple[str, Array]]:
    """From the first to the last sample, which holds for `hold` seconds more; and without gaps."""
    times = series.times
    if len(times) == 1:
        return [(f"{series.name} has not begun", spans_of([(float(times[0]), np.inf)]))]
    whole = spans_of([(float(times[0]), float(times[-1]) + hold)])
    long = np.diff(times) > max(GAP_PERIODS * period_of(times), GAP_SECONDS)
    gaps = np.column_stack([times[:-1][long], times[1:][long]])
    return [
        (f"{series.name} has not begun, or has ended", whole),
        (f"a gap in {series.name}", without(whole, gaps)),
    ]


def _switches(
    program: Program, needs: Needs, whole: Array, horizon: float
) -> list[tuple[str, Array]]:
    """The switches that cut, each with the time in which it may have happened.

    That is at least the sample period of the time base before it.
    """
    changes = changes_of(program, needs)
    if len(changes) == 0:
        return []
    ends = np.concatenate([[whole[0, 0]], changes.times, [whole[-1, 1]]])
    is_short = np.diff(ends) < STAY * horizon
    ways = {(guard.mode, guard.target) for guard in program.field.guards}
    declared = [way in ways for way in zip(changes.left, changes.entered, strict=True)]
    is_sure = changes.doubt <= SURE * horizon
    cuts = ~((is_short[:-1] | is_short[1:]) & np.array(declared) & is_sure)
    period = period_of(needs.series[needs.base].times)
    since = np.minimum(changes.since, changes.until - period)
    holes = np.column_stack([since, changes.until])[cuts]
    return [(f"{program.field.mode} changes", without(whole, holes))]


def _judged(program: Program, needs: Needs, whole: Array) -> Array:
    """Where `judge_when` holds: evaluated at every sample of what it may read, and held."""
    if program.judge_when is None:
        return whole
    told = [s for s in (each.series for each in (*needs.inputs, *needs.signals)) if s is not None]
    knots = np.unique(np.concatenate([each.times for each in (*needs.series, *told)]))
    names = (*program.register, *(signal.name for signal in needs.signals))
    truth = evaluate([program.judge_when], names, _register(program, needs, knots))[..., 0]
    is_false = ~(np.nan_to_num(truth, nan=0.0) != 0.0)
    after = np.append(knots[1:], np.inf)
    before = np.where(knots == knots[0], -np.inf, knots)
    return without(whole, np.column_stack([before[is_false], after[is_false]]))


def _register(program: Program, needs: Needs, times: Array) -> Array:
    """The register and the signals at each time: (T, r + number of signals)."""
    columns = {state.name: np.full(len(times), state.hold) for state in program.states}
    columns |= {control.name: np.full(len(times), control.default) for control in program.controls}
    columns |= {c.name: np.full(len(times), c.value) for c in program.constants}
    for state, series in zip(needs.driven, needs.series, strict=True):
        columns[state.name] = held(series, times)
    for each in (*needs.inputs, *needs.signals):
        known = np.full(len(times), each.value)
        columns[each.name] = known if each.series is None else held(each.series, times)
    for state in program.states:
        columns[state.name] = on_circle(state, columns[state.name])
    return np.stack(list(columns.values()), axis=-1)


def on_circle(part: State | Control, values: Array) -> Array:
    """Values of a periodic state within its domain; others as they are."""
    if isinstance(part, Control) or part.kind is not Kind.PERIODIC:
        return values
    return np.asarray(part.low + np.mod(values - part.low, part.high - part.low))


def inside_domains(
    program: Program, needs: Needs, whole: Array
) -> list[tuple[State | Control, Series, Array]]:
    """Each variable that was logged, and where (k, 2) it is inside its domain.

    Of a predicted state, a sample outside takes the time from the sample before it to the one
    after it; of an input, the time for which it is held.
    """
    found: list[tuple[State | Control, Series, Array]] = []
    for state, series in zip(needs.driven, needs.series, strict=True):
        before = np.append(-np.inf, series.times[:-1])
        found.append((state, series, before))
    parts = parts_of(program)
    told = [(parts[each.name], each.series) for each in needs.inputs if each.series is not None]
    found += [(part, series, series.times) for part, series in told]
    return [(part, series, _inside(part, series, before, whole)) for part, series, before in found]


def _inside(part: State | Control, series: Series, before: Array, whole: Array) -> Array:
    if isinstance(part, State) and part.kind is not Kind.CONTINUOUS:
        return whole
    slack = EDGE * (part.high - part.low)
    inside = (series.values >= part.low - slack) & (series.values <= part.high + slack)
    after = np.append(series.times[1:], np.inf)
    return without(whole, np.column_stack([before[~inside], after[~inside]]))

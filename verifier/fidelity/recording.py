"""One recording, as a verdict needs it, alone or with others: evidence, and what it is of."""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.program import Program
from verifier.fidelity.judging.evidence import Evidence, evidence_of
from verifier.fidelity.judging.outside import Outside, outside_of
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.needs import held
from verifier.fidelity.stretches.segments import Segments, on_circle
from verifier.fidelity.stretches.spans import contains, intersect, length, merge
from verifier.report.report import Exclusion, TraceIdentity
from verifier.traces.trace import Loss, Trace

THINNED: Final = 0.02
"""Samples closer than this share of the horizon count once for the coverage."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Recording:
    """What a verdict rests on. It is small: what was read and predicted is not kept.

    visited: the effective samples (N,) by name, inside judged windows. constant: the inputs that
    never change here, with their values. outside: the variables that mostly lie outside their
    domain.
    """

    evidence: Evidence
    identity: TraceIdentity
    visited: dict[str, Array]
    constant: dict[str, float]
    exclusions: tuple[Exclusion, ...]
    losses: tuple[Loss, ...]
    notes: tuple[str, ...]
    outside: tuple[Outside, ...]


def recording_of(program: Program, trace: Trace, study: Study) -> Recording:
    """A trace that was shot."""
    windows = study.plan.windows
    inside = merge(np.column_stack([windows.times, windows.times + windows.horizon]))
    return Recording(
        evidence=evidence_of(program, study, trace.source),
        identity=identity_of(trace, study.segments, length(inside)),
        visited=_visited(program, study, inside),
        constant={e.name: e.value for e in study.plan.needs.inputs if e.series is None},
        exclusions=(*study.segments.exclusions, *_left_over(study, inside)),
        losses=trace.losses,
        notes=trace.notes,
        outside=outside_of(program, study.plan.needs),
    )


def identity_of(trace: Trace, segments: Segments | None, judged: float) -> TraceIdentity:
    """Which trace it is, with the seconds that were `judged`."""
    times = [series.times for series in trace.series.values() if len(series.times)]
    first, last = (
        segments.whole
        if segments is not None
        else (min((t[0] for t in times), default=0.0), max((t[-1] for t in times), default=0.0))
    )
    return TraceIdentity(trace.source, trace.start, float(last - first), judged)


def _left_over(study: Study, inside: Array) -> list[Exclusion]:
    """What the windows, which start every half horizon, leave at the ends of the stretches."""
    base = study.plan.samples[study.plan.needs.base].times
    spans = study.segments.spans
    seconds = length(spans) - length(intersect(spans, inside))
    samples = int(np.sum(contains(spans, base) & ~contains(inside, base)))
    if samples == 0:
        return []
    return [Exclusion("left over at the ends of stretches, where no window fits", seconds, samples)]


def stride_of(horizon: float, period: float) -> int:
    """Of samples so many seconds apart, each how many-th is an effective one."""
    return max(1, round(THINNED * horizon / period))


def _visited(program: Program, study: Study, inside: Array) -> dict[str, Array]:
    """Where the robot went inside judged windows.

    Effective samples: those of the time base that are not closer than a share of the horizon, so
    that a fast sensor alone does not make a short visit a long one.
    """
    base = study.plan.samples[study.plan.needs.base]
    stride = stride_of(study.plan.windows.horizon, base.distance)
    times = base.times[contains(inside, base.times)][::stride]
    assumed = zip(program.register, study.plan.model.flow.defaults, strict=True)
    columns = {name: np.full(len(times), float(value)) for name, value in assumed}
    for each in study.plan.samples:
        columns[each.state.name] = on_circle(each.state, np.interp(times, each.times, each.values))
    for given in study.plan.needs.inputs:
        known = np.full(len(times), given.value)
        columns[given.name] = known if given.series is None else held(given.series, times)
    return columns

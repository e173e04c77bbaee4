"""The verification: does the robot in this trace do what the program says?

PASS: every judged variable is shown to be within its tolerance, enough of the region was seen, and
every input was measured or declared. FAIL: some variable is shown to exceed its tolerance.
INCONCLUSIVE: anything else, with the data that would decide. Only the declared horizon decides;
shorter ones are reported, because a late or smoothed input can make a wrong spec look the better
one over short times.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array, frozen
from runtime.flow import flow_of
from runtime.program import Fidelity, Program
from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.source import Source
from verifier.fidelity.judging.departure import CONFIDENCE
from verifier.fidelity.judging.judgement import places_of, results_of
from verifier.fidelity.judging.regions import axes_of, coverage_of
from verifier.fidelity.judging.verdict import decide, not_told, notes_of, too_short
from verifier.fidelity.shooting.study import Study, study_of
from verifier.fidelity.stretches.needs import Needs, held, needs_of, parts_of
from verifier.fidelity.stretches.segments import Segments, on_circle, segments_of
from verifier.fidelity.stretches.spans import contains, intersect, length, merge
from verifier.fidelity.switching.judge import switching_of
from verifier.fidelity.switching.verdict import with_switching
from verifier.report.report import (
    CellAxis,
    Coverage,
    Exclusion,
    Report,
    SpecIdentity,
    TraceIdentity,
    Verdict,
)
from verifier.traces.trace import Trace

SEED: Final = 20_240
"""Of the noisy copies of sensed-only inputs: the same trace gives the same report."""
THINNED: Final = 0.02
"""Samples closer than this share of the horizon count once for the coverage."""


def verify(program: Program, trace: Trace) -> Report:
    """Judge the driven states of `trace` against `program`, by its `fidelity`.

    Raises:
        SpecError: the spec does not say what it would be verified against (V351).
    """
    report, _study = judged(program, trace)
    return report


def judged(program: Program, trace: Trace) -> tuple[Report, Study | None]:
    """The report, and the study that it rests on; None where nothing can be compared.

    Raises:
        SpecError: the spec does not say what it would be verified against (V351).
    """
    fidelity = _fidelity(program)
    needs = needs_of(program, trace)
    absent = not_told(needs)
    if absent:
        return _unjudged(program, trace, fidelity, None, absent), None
    found = switching_of(program, needs, fidelity)
    if found is None:
        return _compared(program, trace, fidelity, needs)
    switching, told = found
    report, study = _compared(program, trace, fidelity, told)
    return with_switching(report, switching, needs), study


def _compared(
    program: Program, trace: Trace, fidelity: Fidelity, needs: Needs
) -> tuple[Report, Study | None]:
    segments = segments_of(program, needs, fidelity.horizon)
    if len(segments.spans) == 0:
        reason = too_short(needs, segments, fidelity.horizon)
        return _unjudged(program, trace, fidelity, segments, reason), None
    study = study_of(flow_of(program), fidelity, needs, segments, np.random.default_rng(SEED))
    if isinstance(study, str):
        return _unjudged(program, trace, fidelity, segments, study), None
    return _judged(program, trace, fidelity, study), study


def _fidelity(program: Program) -> Fidelity:
    if program.fidelity is not None and program.fidelity.tolerance:
        return program.fidelity
    source = Source(program.source.file, program.source.text)
    message = f"'{program.name}' does not say what a faithful robot is: it declares no tolerance"
    help_ = (
        "write, for example\n"
        "fidelity:\n"
        f"  tolerance: {{{program.field.driven[0]}: 0.05}}   # at the horizon, in its own unit\n"
        "  horizon: 2 s"
    )
    raise SpecError([Diagnostic("V351", Severity.ERROR, message, source, None, help=help_)])


def _judged(program: Program, trace: Trace, fidelity: Fidelity, study: Study) -> Report:
    axes = axes_of(program, study.plan.needs, fidelity)
    results = results_of(program, fidelity, study)
    windows = study.plan.windows
    inside = merge(np.column_stack([windows.times, windows.times + windows.horizon]))
    required = fidelity.coverage if fidelity.region else 0.0
    coverage = _coverage(program, study, axes, inside, required)
    units = {name: part.unit for name, part in parts_of(program).items()}
    finding = decide(study, results, coverage, length(inside), units)
    return Report(
        verdict=finding.verdict,
        reasons=finding.reasons,
        advice=finding.advice,
        horizon=windows.horizon,
        confidence=CONFIDENCE,
        variables=results,
        coverage=coverage,
        exclusions=(*study.segments.exclusions, *_left_over(study, inside)),
        losses=trace.losses,
        notes=(*trace.notes, *notes_of(study, results)),
        spec=_spec(program),
        trace=_identity(trace, study.segments, length(inside)),
        starts=frozen(windows.times),
        places=places_of(program, study),
        units=units,
    )


def _left_over(study: Study, inside: Array) -> list[Exclusion]:
    """What the windows, which start every half horizon, leave at the ends of the stretches."""
    base = study.plan.samples[study.plan.needs.base].times
    spans = study.segments.spans
    seconds = length(spans) - length(intersect(spans, inside))
    samples = int(np.sum(contains(spans, base) & ~contains(inside, base)))
    if samples == 0:
        return []
    return [Exclusion("left over at the ends of stretches, where no window fits", seconds, samples)]


def _unjudged(
    program: Program, trace: Trace, fidelity: Fidelity, segments: Segments | None, reason: str
) -> Report:
    """The report of a trace in which nothing can be compared."""
    return Report(
        verdict=Verdict.INCONCLUSIVE,
        reasons=(reason,),
        advice=(),
        horizon=fidelity.horizon,
        confidence=CONFIDENCE,
        variables=(),
        coverage=None,
        exclusions=() if segments is None else segments.exclusions,
        losses=trace.losses,
        notes=trace.notes,
        spec=_spec(program),
        trace=_identity(trace, segments, 0.0),
        starts=frozen([]),
        places={},
        units={name: part.unit for name, part in parts_of(program).items()},
    )


def _coverage(
    program: Program,
    study: Study,
    axes: tuple[CellAxis, ...],
    inside: Array,
    required: float,
) -> Coverage:
    """The cells that the robot went through inside judged windows.

    Effective samples: those of the time base that are not closer than a share of the horizon, so
    that a fast sensor alone does not make a short visit a long one.
    """
    base = study.plan.samples[study.plan.needs.base]
    stride = max(1, round(THINNED * study.plan.windows.horizon / base.distance))
    times = base.times[contains(inside, base.times)][::stride]
    columns = {name: np.full(len(times), assumed) for name, assumed in _assumed(program, study)}
    for each in study.plan.samples:
        columns[each.state.name] = on_circle(each.state, np.interp(times, each.times, each.values))
    for given in study.plan.needs.inputs:
        known = np.full(len(times), given.value)
        columns[given.name] = known if given.series is None else held(given.series, times)
    values = np.stack([columns[axis.name] for axis in axes], axis=-1)
    return coverage_of(axes, values, required)


def _assumed(program: Program, study: Study) -> list[tuple[str, float]]:
    return [
        (name, float(value))
        for name, value in zip(program.register, study.plan.model.flow.defaults, strict=True)
    ]


def _spec(program: Program) -> SpecIdentity:
    return SpecIdentity(program.name, program.source.file, program.source.sha256)


def _identity(trace: Trace, segments: Segments | None, judged: float) -> TraceIdentity:
    times = [series.times for series in trace.series.values() if len(series.times)]
    first, last = (
        segments.whole
        if segments is not None
        else (min((t[0] for t in times), default=0.0), max((t[-1] for t in times), default=0.0))
    )
    return TraceIdentity(trace.source, trace.start, float(last - first), judged)

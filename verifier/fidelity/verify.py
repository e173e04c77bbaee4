"""The verification: does the robot in this trace do what the program says?

PASS: every judged variable is shown to be within its tolerance, enough of the region was seen, and
every input was measured or declared. FAIL: some variable is shown to exceed its tolerance.
INCONCLUSIVE: anything else, with the data that would decide. Only the declared horizon decides;
shorter ones are reported, because a late or smoothed input can make a wrong spec look the better
one over short times.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import frozen
from runtime.flow import flow_of
from runtime.program import Fidelity, Program
from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.source import Source
from verifier.fidelity.judging.departure import CONFIDENCE
from verifier.fidelity.judging.evidence import joined
from verifier.fidelity.judging.judgement import results_of
from verifier.fidelity.judging.misread import turned_in_another_unit
from verifier.fidelity.judging.outside import outside_of
from verifier.fidelity.judging.regions import axes_of, coverage_of
from verifier.fidelity.judging.uncompared import not_told, open_for, too_short, too_slow
from verifier.fidelity.judging.verdict import Finding, decide, notes_of, with_outside
from verifier.fidelity.recording import Recording, identity_of, recording_of
from verifier.fidelity.shooting.study import Study, study_of
from verifier.fidelity.stretches.needs import Needs, needs_of, parts_of
from verifier.fidelity.stretches.segments import Segments, segments_of
from verifier.fidelity.switching.judge import switching_of
from verifier.fidelity.switching.verdict import with_switching
from verifier.report.report import Coverage, Report, SpecIdentity
from verifier.report.switching import Switching
from verifier.traces.trace import Trace

SEED: Final = 20_240
"""Of the noisy copies of sensed-only inputs: the same trace gives the same report."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Judgement:
    """A report, and what it rests on.

    study, recording: None where nothing can be compared. switching: the changes of mode; None
    where there are no ways out of modes, or nothing that would be predicted in the trace.
    """

    report: Report
    study: Study | None
    recording: Recording | None
    switching: Switching | None


def verify(program: Program, trace: Trace) -> Report:
    """Judge the driven states of `trace` against `program`, by its `fidelity`.

    Raises:
        SpecError: the spec does not say what it would be verified against (V351).
    """
    return judgement_of(program, trace).report


def judged(program: Program, trace: Trace) -> tuple[Report, Study | None]:
    """The report, and the study that it rests on; None where nothing can be compared.

    Raises:
        SpecError: the spec does not say what it would be verified against (V351).
    """
    found = judgement_of(program, trace)
    return found.report, found.study


def judgement_of(program: Program, trace: Trace) -> Judgement:
    """The report with what it rests on.

    Raises:
        SpecError: the spec does not say what it would be verified against (V351).
    """
    fidelity = fidelity_of(program)
    needs = needs_of(program, trace)
    absent = not_told(needs)
    is_predicted = not needs.missing and bool(needs.driven)
    if is_predicted:
        strange = too_slow(needs, fidelity.horizon, trace) or turned_in_another_unit(program, needs)
        if strange:
            return Judgement(_unjudged(program, trace, None, strange), None, None, None)
    is_read = is_predicted and not any(each.is_far for each in outside_of(program, needs))
    found = switching_of(program, needs, fidelity) if is_read else None
    if absent:
        switching = None if found is None else found[0]
        return Judgement(_unjudged(program, trace, None, absent), None, None, switching)
    if found is None:
        return _compared(program, trace, fidelity, needs)
    switching, told = found
    plain = _compared(program, trace, fidelity, told)
    report = with_switching(plain.report, switching, needs.unknown)
    return Judgement(report, plain.study, plain.recording, switching)


def _compared(program: Program, trace: Trace, fidelity: Fidelity, needs: Needs) -> Judgement:
    segments = segments_of(program, needs, fidelity.horizon)
    if len(segments.spans) == 0:
        why = too_short(needs, segments, fidelity.horizon, outside_of(program, needs))
        return Judgement(_unjudged(program, trace, segments, why), None, None, None)
    study = study_of(flow_of(program), fidelity, needs, segments, np.random.default_rng(SEED))
    if isinstance(study, str):
        return Judgement(_unjudged(program, trace, segments, open_for(study)), None, None, None)
    recording = recording_of(program, trace, study)
    return Judgement(report_on(program, (recording,)), study, recording, None)


def fidelity_of(program: Program) -> Fidelity:
    """What the robot is held against.

    Raises:
        SpecError: the spec does not say (V351).
    """
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


def report_on(program: Program, recordings: Sequence[Recording]) -> Report:
    """The report on the windows of all recordings, under the name of the first."""
    fidelity = fidelity_of(program)
    evidence = joined([each.evidence for each in recordings])
    results = results_of(fidelity, evidence)
    coverage = _coverage(program, fidelity, recordings)
    units = {name: part.unit for name, part in parts_of(program).items()}
    seconds = sum(each.identity.judged for each in recordings)
    outside = [each for recording in recordings for each in recording.outside]
    finding = with_outside(decide(evidence, results, coverage, seconds, units), outside)
    return Report(
        verdict=finding.verdict,
        reasons=finding.reasons,
        advice=finding.advice,
        horizon=evidence.horizon,
        confidence=CONFIDENCE,
        variables=results,
        coverage=coverage,
        exclusions=tuple(each for recording in recordings for each in recording.exclusions),
        losses=tuple(each for recording in recordings for each in recording.losses),
        notes=(*(n for r in recordings for n in r.notes), *notes_of(evidence, results)),
        spec=spec_of(program),
        trace=recordings[0].identity,
        starts=frozen(evidence.starts),
        places=evidence.places,
        units=units,
    )


def _unjudged(program: Program, trace: Trace, segments: Segments | None, why: Finding) -> Report:
    """The report of a trace in which nothing can be compared."""
    return Report(
        verdict=why.verdict,
        reasons=why.reasons,
        advice=why.advice,
        horizon=fidelity_of(program).horizon,
        confidence=CONFIDENCE,
        variables=(),
        coverage=None,
        exclusions=() if segments is None else segments.exclusions,
        losses=trace.losses,
        notes=trace.notes,
        spec=spec_of(program),
        trace=identity_of(trace, segments, 0.0),
        starts=frozen([]),
        places={},
        units={name: part.unit for name, part in parts_of(program).items()},
    )


def _coverage(program: Program, fidelity: Fidelity, recordings: Sequence[Recording]) -> Coverage:
    """The cells that the robot went through inside judged windows, in all recordings."""
    first = recordings[0].constant
    constant = [
        name
        for name, value in first.items()
        if all(each.constant.get(name) == value for each in recordings)
    ]
    axes = axes_of(program, constant, fidelity)
    visited = [np.stack([r.visited[axis.name] for axis in axes], axis=-1) for r in recordings]
    return coverage_of(axes, np.concatenate(visited), fidelity.coverage if fidelity.region else 0.0)


def spec_of(program: Program) -> SpecIdentity:
    """Which spec it is."""
    return SpecIdentity(program.name, program.source.file, program.source.sha256)

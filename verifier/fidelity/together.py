"""Several recordings of one spec, judged together: short ones may decide together what none does.

The windows of all are judged at once, with the statistics that one recording is judged with.
Nothing depends across recordings: windows of two are never in one cluster, the noise is that of
each. A recording in which nothing can be compared is named and left out, and so is one that is
there twice.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from runtime.arrays import frozen
from runtime.program import Program
from verifier.fidelity.recording import Recording
from verifier.fidelity.switching.together import with_every_switching
from verifier.fidelity.verify import Judgement, judgement_of, report_on
from verifier.report.report import Report, TraceIdentity, Verdict
from verifier.report.wording import LEFT_OUT
from verifier.traces.trace import Trace


def verify_together(program: Program, traces: Iterable[Trace]) -> Report:
    """Judge several recordings of robots that shall do what `program` says as one.

    Raises:
        SpecError: the spec does not say what it would be verified against (V351).
        ValueError: there is no recording.
    """
    return pooled(program, [replace(judgement_of(program, each), study=None) for each in traces])


def pooled(program: Program, judgements: Sequence[Judgement]) -> Report:
    """The report on all recordings together, each of which was judged by `program`.

    Raises:
        ValueError: there is none.
    """
    if not judgements:
        raise ValueError("name at least one recording")
    if len(judgements) == 1:
        return judgements[0].report
    kept: list[Recording] = []
    switchings, left = [], []
    for each in judgements:
        why = _left_out(each, kept)
        if why or each.recording is None:
            left.append(f"{each.report.trace.source}{LEFT_OUT}{why}")
        else:
            kept.append(each.recording)
            switchings.append((each.report.trace.source, each.switching))
    if not kept:
        return _nothing(judgements, left)
    report = report_on(program, [_named(each) for each in kept])
    report = with_every_switching(report, switchings)
    return replace(
        report, reasons=(*report.reasons, *left), trace=_identity([each.identity for each in kept])
    )


def _left_out(judgement: Judgement, kept: Sequence[Recording]) -> str:
    """Why a recording says nothing; empty where it does. `kept`: those before it that do."""
    recording = judgement.recording
    if recording is None or recording.evidence.unknown:
        return judgement.report.reasons[0]
    if any(_is_copy(recording, other) for other in kept):
        return "it is there twice"
    return ""


def _is_copy(one: Recording, other: Recording) -> bool:
    """Whether two recordings are one: the same errors to the last bit, at the same times."""
    a, b = one.evidence, other.evidence
    return np.array_equal(a.starts, b.starts) and all(
        np.array_equal(mine.mean, theirs.mean, equal_nan=True)
        for mine, theirs in zip(a.errors[-1], b.errors[-1], strict=True)
    )


def _named(recording: Recording) -> Recording:
    """With its name before all that is told of it."""
    source = recording.identity.source
    return replace(
        recording,
        exclusions=tuple(replace(e, cause=f"{source}: {e.cause}") for e in recording.exclusions),
        losses=tuple(replace(loss, cause=f"{source}: {loss.cause}") for loss in recording.losses),
        notes=tuple(f"{source}: {note}" for note in recording.notes),
        outside=tuple(replace(e, reason=f"{source}: {e.reason}") for e in recording.outside),
    )


def _identity(every: Sequence[TraceIdentity]) -> TraceIdentity:
    """The name of all, with their lengths added."""
    return TraceIdentity(
        source="1 recording" if len(every) == 1 else f"{len(every)} recordings together",
        start=min(each.start for each in every),
        duration=sum(each.duration for each in every),
        judged=sum(each.judged for each in every),
    )


def _nothing(judgements: Sequence[Judgement], left: Sequence[str]) -> Report:
    """The report where no recording can be compared: it says why of each."""
    advice = [sentence for each in judgements for sentence in each.report.advice]
    return replace(
        judgements[0].report,
        verdict=Verdict.INCONCLUSIVE,
        reasons=("nothing can be compared in any of the recordings", *left),
        advice=tuple(dict.fromkeys(advice)),
        variables=(),
        coverage=None,
        exclusions=(),
        losses=(),
        notes=(),
        trace=replace(_identity([each.report.trace for each in judgements]), judged=0.0),
        starts=frozen([]),
        places={},
    )

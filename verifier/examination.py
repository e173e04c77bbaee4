"""The examination of a trace: the verdict, and what else the trace tells, put together.

This is the one place where the sections of a report meet. The verdict is the report's own; the
other sections explain it, say how far it reaches, and never make it better.
"""

from collections.abc import Callable
from dataclasses import replace

from runtime.program import Program
from verifier.diagnosis.diagnose import diagnose
from verifier.fidelity.judging.stuck import with_stuck
from verifier.fidelity.judging.verdict import advice_on_open
from verifier.fidelity.stretches.needs import parts_of
from verifier.fidelity.verify import Judgement, judgement_of
from verifier.limits.limits import limits_of
from verifier.report.advice import advised
from verifier.report.examination import Depth, Examination
from verifier.report.report import Verdict
from verifier.robot_topology.compare import compare_features
from verifier.scores.scores import scores_of
from verifier.traces.trace import Trace


def examine(
    program: Program,
    trace: Trace,
    *,
    depth: Depth = "all",
    progress: Callable[[str], None] | None = None,
) -> Examination:
    """Judge `trace` against `program`, and explain the judgement.

    Args:
        depth: what is found out beside the report.
        progress: is told what is done next, as a phrase, before each phase.

    Raises:
        SpecError: the spec does not say what it would be verified against (V351).
    """
    tell = progress or _in_silence
    tell("judging")
    return explain(program, trace, judgement_of(program, trace), tell, depth=depth)


def explain(
    program: Program,
    trace: Trace,
    judgement: Judgement,
    tell: Callable[[str], None],
    *,
    depth: Depth,
) -> Examination:
    """What `examine` does, with the `judgement` of `trace` at hand."""
    report, study = judgement.report, judgement.study
    origins = origins_of(program)
    if depth == "verdict" or (depth == "reasons" and report.verdict is Verdict.PASS):
        return Examination(with_stuck(report, program, trace), origins=origins)
    tell("why it departs")
    diagnosis = diagnose(program, trace, study, report)
    moot = advice_on_open(report.variables, report.trace.judged)
    known = advised(report, diagnosis, judgement.switching, program, moot)
    advisory = with_stuck(known, program, trace)
    tell("features of the field")
    features = compare_features(program, trace, study)
    partial = Examination(advisory, judgement.switching, diagnosis, None, features, None, origins)
    if study is None or depth == "reasons":
        return partial
    tell("the limits of this trace")
    limits = limits_of(program, trace, study, report)
    tell("scores")
    return replace(partial, limits=limits, scores=scores_of(study, report))


def origins_of(program: Program) -> dict[str, str]:
    """Where in the spec each state and control stands, and what is demanded of the robot."""
    parts = {name: part.origin for name, part in parts_of(program).items()}
    fidelity = program.field.origin if program.fidelity is None else program.fidelity.origin
    return parts | {"fidelity": fidelity}


def _in_silence(_phase: str) -> None:
    """Nobody watches."""

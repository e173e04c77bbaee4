"""The limits of a trace: what it leaves open, and the faults that it would have shown."""

from runtime.program import Program
from verifier.diagnosis.sensitivities import Sensitivities
from verifier.fidelity.shooting.study import Study
from verifier.limits.not_told import what_is_not_told
from verifier.limits.self_test import smallest_caught
from verifier.report.limits import Limits
from verifier.report.report import Report
from verifier.traces.trace import Trace


def limits_of(
    program: Program,
    trace: Trace,
    study: Study,
    report: Report,
    found: Sensitivities | None = None,
) -> Limits:
    """What `trace` cannot tell of `program`.

    study, report: of the very trace (`verifier.fidelity.verify.judged`). found: its sensitivities
    where they are known already.
    """
    caught, notes = smallest_caught(program, trace, report, study=study)
    return Limits(what_is_not_told(program, study, found), caught, notes)

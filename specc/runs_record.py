"""Recordings as JSON values, in the format of docs/json_report.md."""

from collections.abc import Sequence

from specc.runs import WORST_FIRST, Outcome, Unusable, together, unusable, verifications
from specc.verifying import Verification
from verifier.report.examination_record import FORMAT, examination_record


def run_record(verification: Verification) -> dict[str, object]:
    """One recording: its report, and how its spec was found."""
    return {**examination_record(verification.examination), "found_by": verification.found.how}


def runs_record(outcomes: Sequence[Outcome]) -> dict[str, object]:
    """Many: the worst verdict, the counts, and each recording by itself."""
    found = [each.report.verdict for each in verifications(outcomes)]
    worst = together(outcomes)
    return {
        "format": FORMAT,
        "verdict": None if worst is None else str(worst),
        "counts": {str(verdict): found.count(verdict) for verdict in WORST_FIRST}
        | {"unusable": len(unusable(outcomes))},
        "runs": [_run(each) for each in outcomes],
    }


def _run(outcome: Outcome) -> dict[str, object]:
    if isinstance(outcome, Unusable):
        diagnostics = [each.as_json() for each in outcome.error.diagnostics]
        return {"trace": {"source": outcome.source}, "diagnostics": diagnostics}
    return run_record(outcome)

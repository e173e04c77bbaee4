"""Recordings as JSON values, in the format of docs/json_report.md."""

from specc.runs import WORST_FIRST, Outcome, Pool, Runs, Unusable, unusable, verifications
from specc.verifying import Verification
from verifier.report.examination_record import FORMAT, examination_record


def run_record(verification: Verification) -> dict[str, object]:
    """One recording: its report, and how its spec was found."""
    return {**examination_record(verification.examination), "found_by": verification.found.how}


def runs_record(runs: Runs) -> dict[str, object]:
    """Many: the verdict, the counts, those of one spec together, and each by itself."""
    found = [each.report.verdict for each in verifications(runs.outcomes)]
    return {
        "format": FORMAT,
        "verdict": None if runs.verdict is None else str(runs.verdict),
        "counts": {str(verdict): found.count(verdict) for verdict in WORST_FIRST}
        | {"unusable": len(unusable(runs.outcomes))},
        "together": [_pool(each) for each in runs.pools],
        "runs": [_run(each) for each in runs.outcomes],
    }


def _pool(pool: Pool) -> dict[str, object]:
    sources = [each.report.trace.source for each in pool.members]
    return {**examination_record(pool.examination), "recordings": sources}


def _run(outcome: Outcome) -> dict[str, object]:
    if isinstance(outcome, Unusable):
        diagnostics = [each.as_json() for each in outcome.error.diagnostics]
        return {"trace": {"source": outcome.source}, "diagnostics": diagnostics}
    return run_record(outcome)

"""Recordings as JSON values, in the format of docs/json_report.md."""

from specc.verifying.architecture import NotJudged
from specc.verifying.runs import Outcome, Pool, Runs, Unusable, not_judged, unusable, verifications
from specc.verifying.trace import Verification
from verifier.report.examination_record import FORMAT, examination_record
from verifier.report.report import WORST_FIRST


def run_record(verification: Verification) -> dict[str, object]:
    """One recording: its report, and how its spec was found."""
    return {
        **examination_record(verification.examination),
        "part": verification.part or None,
        "found_by": verification.found.how,
    }


def record_of(runs: Runs) -> dict[str, object]:
    """One recording under one spec as `run_record` has it, anything else as `runs_record`."""
    return runs_record(runs) if runs.only is None else run_record(runs.only)


def runs_record(runs: Runs) -> dict[str, object]:
    """Many: the verdict, the counts, those of one spec together, and each by itself."""
    found = [each.report.verdict for each in verifications(runs.outcomes)]
    return {
        "format": FORMAT,
        "verdict": None if runs.verdict is None else str(runs.verdict),
        "counts": {str(verdict): found.count(verdict) for verdict in WORST_FIRST}
        | {
            "not_judged": len(not_judged(runs.outcomes)),
            "unusable": len(unusable(runs.outcomes)),
        },
        "together": [_pool(each) for each in runs.pools],
        "runs": [_run(each) for each in runs.outcomes],
    }


def _pool(pool: Pool) -> dict[str, object]:
    sources = [each.report.trace.source for each in pool.members]
    return {**examination_record(pool.examination), "recordings": sources}


def _run(outcome: Outcome) -> dict[str, object]:
    if isinstance(outcome, NotJudged):
        return {"trace": {"source": outcome.source}, "not_judged": outcome.why}
    if isinstance(outcome, Unusable):
        diagnostics = [each.as_json() for each in outcome.error.diagnostics]
        return {"trace": {"source": outcome.source}, "diagnostics": diagnostics}
    return run_record(outcome)

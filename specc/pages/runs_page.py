"""The reports of many recordings as one page: a table of all, and each report after it."""

from collections.abc import Sequence
from typing import Final

from specc.figures.quantities import number, seconds
from specc.pages.page import Page, RunRow, RunsPage
from specc.pages.report_page import SIGNS, gathered, rendered
from specc.runs import Outcome, Unusable, counted, together, verifications
from specc.runs_text import column_of, columns_of, reasons_of
from specc.verifying import Verification
from verifier.report.report import Coverage, Verdict
from verifier.report.wording import percent

DRAWN: Final = 6
"""With more recordings than these, the variables of those that passed get no figures."""
MOST: Final = 8
"""So many reasons stand at the top."""


def runs_page(outcomes: Sequence[Outcome]) -> str:
    """Many recordings as self-contained HTML."""
    return rendered("runs.html.j2", gathered_runs(outcomes))


def gathered_runs(outcomes: Sequence[Outcome]) -> RunsPage:
    """What the page says."""
    worst = together(outcomes)
    columns = columns_of(outcomes)
    found = verifications(outcomes)
    anchors = {id(each): f"run-{k + 1}" for k, each in enumerate(found)}
    how = (
        "Departures are at the declared horizon, without the sensors' noise; bold ones exceed their"
        " tolerance. The verdict on all is the worst of them."
    )
    if _is_long(outcomes):
        how += " The variables of recordings that passed are not drawn."
    return RunsPage(
        title=counted(outcomes),
        verdict="unusable" if worst is None else str(worst),
        sign="!" if worst is None else SIGNS[worst],
        headline=counted(outcomes),
        reasons=reasons_of(outcomes)[:MOST],
        columns=(*columns, "coverage", "judged", "lost"),
        rows=tuple(_row(each, anchors.get(id(each), ""), columns) for each in outcomes),
        how=how,
        pages=tuple(
            (anchors[id(each)], _page(each, anchors[id(each)], outcomes)) for each in found
        ),
    )


def _is_long(outcomes: Sequence[Outcome]) -> bool:
    return len(outcomes) > DRAWN


def _page(verification: Verification, anchor: str, outcomes: Sequence[Outcome]) -> Page:
    is_drawn = not _is_long(outcomes) or verification.report.verdict is not Verdict.PASS
    return gathered(verification.examination, f"{anchor}-", is_drawn=is_drawn)


def _row(outcome: Outcome, anchor: str, columns: Sequence[str]) -> RunRow:
    if isinstance(outcome, Unusable):
        why = "; ".join(each.message for each in outcome.error.diagnostics)
        return RunRow("", outcome.source, "unusable", "!", (), why)
    report = outcome.report
    found = {column_of(report, r.name): r for r in report.variables}
    cells = [
        (number(found[c].declared.departure / found[c].unit.scale), str(found[c].standing))
        if c in found
        else ("–", "")
        for c in columns
    ]
    coverage = report.coverage
    seen = ("–", "") if coverage is None else (percent(coverage.share), _word(coverage))
    lost = str(sum(loss.count for loss in report.losses))
    more = (seen, (seconds(report.trace.judged), ""), (lost, ""))
    verdict = report.verdict
    return RunRow(anchor, report.trace.source, str(verdict), SIGNS[verdict], (*cells, *more), "")


def _word(coverage: Coverage) -> str:
    return "" if coverage.is_reached else "undecided"

"""The reports of many recordings as one page: a table, then all together, then each by itself."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

from specc.figures.quantities import number, seconds
from specc.pages.page import Page, RunRow, RunsPage, RunsTable
from specc.pages.report_page import SIGNS, gathered, rendered
from specc.pages.scenario_tables import scenario_tables
from specc.texts.runs import advice_of, column_of, columns_of, plain_of, reasons_of
from specc.verifying.runs import Outcome, Pool, Runs, Unusable, counted, verifications
from specc.verifying.trace import Verification
from verifier.report.report import Coverage, Report, Verdict
from verifier.report.wording import percent

DRAWN: Final = 6
"""With more recordings than these, the variables of those that passed get no figures."""
MOST: Final = 8
"""So many reasons stand at the top."""


def runs_page(runs: Runs) -> str:
    """Many recordings as self-contained HTML."""
    return rendered("runs.html.j2", gathered_runs(runs))


def gathered_runs(runs: Runs) -> RunsPage:
    """What the page says."""
    worst, outcomes = runs.verdict, runs.outcomes
    found = verifications(outcomes)
    anchors = {id(each): f"run-{k + 1}" for k, each in enumerate(found)}
    anchors |= {id(each): f"together-{k + 1}" for k, each in enumerate(runs.pools)}
    pages = [(anchors[id(e)], _pool_page(e, anchors[id(e)])) for e in runs.pools]
    pages += [(anchors[id(each)], _page(each, anchors[id(each)], outcomes)) for each in found]
    return RunsPage(
        title=counted(runs),
        verdict="unusable" if worst is None else str(worst),
        sign="!" if worst is None else SIGNS[worst],
        headline=counted(runs),
        reasons=top_reasons(runs),
        advice=top_advice(runs),
        tables=(*scenario_tables(runs, anchors), *_plain(runs, anchors)),
        pages=tuple(pages),
    )


def _plain(runs: Runs, anchors: dict[int, str]) -> Iterator[RunsTable]:
    """The table of recordings that are judged by one spec each."""
    outcomes = plain_of(runs.outcomes)
    if not outcomes:
        return
    columns = columns_of(outcomes)
    how = (
        "Departures are at the declared horizon, without the sensors' noise; bold ones exceed their"
        " tolerance. The verdict is FAIL where one recording fails, else that on all together, for"
        " which the windows of all are judged at once."
    )
    if _is_long(runs.outcomes):
        how += " The variables of recordings that passed are not drawn."
    rows = tuple(_row(each, anchors.get(id(each), ""), columns) for each in outcomes)
    pools = [pool for pool in runs.pools if not pool.members[0].part]
    common = tuple(_report_row(each.report, anchors[id(each)], columns) for each in pools)
    titles = (*columns, "coverage", "judged", "lost")
    yield RunsTable("Every trace", "trace", titles, (*rows, *common), how)


def top_reasons(runs: Runs) -> tuple[str, ...]:
    """Why the verdict is what it is: each recording that did not pass, and what all together say.

    What decides comes first. Where not all pass, those that do are told in the tables.
    """
    together = [
        f"{_told(pool)}: {reason}"
        for pool in runs.pools
        if runs.verdict is Verdict.PASS or pool.report.verdict is not Verdict.PASS
        for reason in pool.report.reasons
    ]
    own = reasons_of(runs)
    is_by_one = runs.verdict is None or runs.verdict is Verdict.FAIL
    return ((*own, *together) if is_by_one else (*together, *own))[:MOST]


def top_advice(runs: Runs) -> tuple[str, ...]:
    """What to do next about all together."""
    return tuple(sentence for pool in runs.pools for sentence in advice_of(pool))


def _pool_page(pool: Pool, anchor: str) -> Page:
    """The page on all recordings together; what is drawn over time stands with each of them."""
    page = gathered(pool.examination, f"{anchor}-", is_drawn=False)
    return replace(page, advice=advice_of(pool))


def _told(pool: Pool) -> str:
    return f"{pool.report.trace.source}, {pool.report.verdict.upper()}"


def _is_long(outcomes: Sequence[Outcome]) -> bool:
    return len(outcomes) > DRAWN


def _page(verification: Verification, anchor: str, outcomes: Sequence[Outcome]) -> Page:
    is_drawn = not _is_long(outcomes) or verification.report.verdict is not Verdict.PASS
    return gathered(verification.examination, f"{anchor}-", is_drawn=is_drawn)


def _row(outcome: Outcome, anchor: str, columns: Sequence[str]) -> RunRow:
    if isinstance(outcome, Unusable):
        why = "; ".join(each.message for each in outcome.error.diagnostics)
        return RunRow("", outcome.source, "unusable", "!", (), why)
    assert isinstance(outcome, Verification), "nodes have a table of their own"
    return _report_row(outcome.report, anchor, columns)


def _report_row(report: Report, anchor: str, columns: Sequence[str]) -> RunRow:
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

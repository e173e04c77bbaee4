"""Many recordings as text: a table, and why those that did not pass did not."""

from collections.abc import Sequence

from spec_schema.diagnostics import render
from specc.runs import Outcome, Pool, Runs, Unusable, counted, source_of, unusable, verifications
from verifier.report.examination_text import examination_text
from verifier.report.layout import bullets, section, table, wrapped
from verifier.report.report import Report, Verdict
from verifier.report.wording import percent, seconds, shown


def runs_table(runs: Runs) -> str:
    """A row for each recording and for all together, the reasons, the verdict and the counts."""
    columns = columns_of(runs.outcomes)
    header = ("recording", "verdict", *columns, "coverage", "judged", "lost")
    rows = [_row(each, columns) for each in runs.outcomes]
    rows += [_report_row(pool.report, columns) for pool in runs.pools]
    last = f"{'' if runs.verdict is None else f'{runs.verdict.upper()}  '}{counted(runs.outcomes)}"
    return "\n\n".join(
        part
        for part in (
            table([header, *rows]),
            section("why", [wrapped(reason) for reason in reasons_of(runs.outcomes)]),
            *(section(title, blocks) for title, blocks in _together(runs)),
            last,
        )
        if part
    )


def runs_text(runs: Runs) -> str:
    """The table, and after it every report in full, those on all together first."""
    parts = [runs_table(runs)]
    parts += [examination_text(each.examination) for each in runs.pools]
    parts += [examination_text(each.examination) for each in verifications(runs.outcomes)]
    parts += [render(each.error.diagnostics) for each in unusable(runs.outcomes)]
    return "\n\n\n".join(parts)


def _together(runs: Runs) -> list[tuple[str, list[str]]]:
    """Of each common verdict a title, its reasons, and what to do next where it decides."""
    return [
        (
            f"{pool.report.trace.source}: {pool.report.verdict.upper()}",
            [*map(wrapped, pool.report.reasons), bullets(advice_of(pool))],
        )
        for pool in runs.pools
    ]


def advice_of(pool: Pool) -> tuple[str, ...]:
    """What to do next about a common verdict; nothing where one recording fails, which decides."""
    fails = any(each.report.verdict is Verdict.FAIL for each in pool.members)
    return () if fails and pool.report.verdict is not Verdict.FAIL else pool.report.advice


def reasons_of(outcomes: Sequence[Outcome]) -> tuple[str, ...]:
    """Why each recording that did not pass did not: `run.mcap, FAIL: …`, what decides first."""
    told = sorted((each for each in outcomes if _why(each)), key=_rank)
    return tuple(f"{source_of(each)}{_word(each)}: {_why(each)}" for each in told)


def _rank(outcome: Outcome) -> int:
    """Those that fail first, then those that can't be used."""
    if isinstance(outcome, Unusable):
        return 1
    return 0 if outcome.report.verdict is Verdict.FAIL else 2


def _word(outcome: Outcome) -> str:
    if isinstance(outcome, Unusable):
        return " can't be used"
    return f", {outcome.report.verdict.upper()}"


def columns_of(outcomes: Sequence[Outcome]) -> tuple[str, ...]:
    """The judged variables of all recordings, with their units: `x [m]`."""
    titles = {
        column_of(report, name): None
        for report in (each.report for each in verifications(outcomes))
        for name in (result.name for result in report.variables)
    }
    return tuple(titles)


def column_of(report: Report, name: str) -> str:
    """The title of a variable's column; what two specs measure in other units stands apart."""
    unit = next(result.unit for result in report.variables if result.name == name)
    return name if unit.text in {"", "1"} else f"{name} [{unit.text}]"


def _row(outcome: Outcome, columns: Sequence[str]) -> tuple[str, ...]:
    if isinstance(outcome, Unusable):
        first = outcome.error.diagnostics[0]
        return (outcome.source, f"can't be used: {first.code}", *("-" for _ in columns), "", "", "")
    return _report_row(outcome.report, columns)


def _report_row(report: Report, columns: Sequence[str]) -> tuple[str, ...]:
    found = {column_of(report, r.name): r for r in report.variables}
    cells = [
        f"{shown(found[c].declared.departure, found[c].unit)} {found[c].standing}"
        if c in found
        else "-"
        for c in columns
    ]
    seen = "-" if report.coverage is None else percent(report.coverage.share)
    lost = str(sum(loss.count for loss in report.losses))
    verdict = report.verdict.upper()
    return (report.trace.source, verdict, *cells, seen, seconds(report.trace.judged), lost)


def _why(outcome: Outcome) -> str:
    """The first reason of what did not pass; empty for what did."""
    if isinstance(outcome, Unusable):
        return "; ".join(d.message for d in outcome.error.diagnostics[:3])
    report = outcome.report
    return "" if report.verdict is Verdict.PASS else "".join(report.reasons[:1])

"""Many recordings as text: a table, and why those that did not pass did not."""

from collections.abc import Sequence

from spec_schema.diagnostics import render
from specc.runs import Outcome, Unusable, counted, together, unusable, verifications
from specc.verifying import Verification
from verifier.report.examination_text import examination_text
from verifier.report.layout import section, table, wrapped
from verifier.report.report import Report, Verdict
from verifier.report.wording import percent, seconds, shown


def runs_table(outcomes: Sequence[Outcome]) -> str:
    """A row for each recording, then the reasons, then the worst verdict and the counts."""
    columns = columns_of(outcomes)
    header = ("recording", "verdict", *columns, "coverage", "judged", "lost")
    rows = [_row(each, columns) for each in outcomes]
    worst = together(outcomes)
    last = f"{'' if worst is None else f'{worst.upper()}  '}{counted(outcomes)}"
    return "\n\n".join(
        part
        for part in (
            table([header, *rows]),
            section("why", [wrapped(reason) for reason in reasons_of(outcomes)]),
            last,
        )
        if part
    )


def runs_text(outcomes: Sequence[Outcome]) -> str:
    """The table, and after it every report in full."""
    parts = [runs_table(outcomes)]
    parts += [examination_text(each.examination) for each in verifications(outcomes)]
    parts += [render(each.error.diagnostics) for each in unusable(outcomes)]
    return "\n\n\n".join(parts)


def reasons_of(outcomes: Sequence[Outcome]) -> tuple[str, ...]:
    """Why each recording that did not pass did not: `run.mcap: …`."""
    return tuple(f"{_source(each)}: {_why(each)}" for each in outcomes if _why(each))


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
    report = outcome.report
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


def _source(outcome: Outcome) -> str:
    return outcome.source if isinstance(outcome, Unusable) else outcome.report.trace.source


def _why(outcome: Outcome) -> str:
    """The first reason of what did not pass; empty for what did."""
    if isinstance(outcome, Unusable):
        return "; ".join(d.message for d in outcome.error.diagnostics[:3])
    return _first_reason(outcome)


def _first_reason(verification: Verification) -> str:
    report = verification.report
    return "" if report.verdict is Verdict.PASS else "".join(report.reasons[:1])

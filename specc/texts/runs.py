"""Many recordings as text: a table, and why those that did not pass did not."""

from collections.abc import Iterator, Sequence
from typing import Final

from spec_schema.diagnostics import render
from specc.texts.scenario_runs import (
    NODE_TITLES,
    REQUIREMENT_TITLES,
    RequirementRow,
    left_out,
    node_rows,
    nodes_of,
    pools_of_nodes,
    required_of,
    requirement_rows,
)
from specc.verifying.architecture import NotJudged
from specc.verifying.recording import REQUIREMENTS
from specc.verifying.runs import (
    Outcome,
    Pool,
    Runs,
    Unusable,
    counted,
    is_of_one,
    source_of,
    unusable,
    verifications,
)
from specc.verifying.trace import Verification
from verifier.report.examination_text import examination_text
from verifier.report.layout import bullets, section, table, wide_table, wrapped
from verifier.report.report import Report, Verdict
from verifier.report.wording import LEFT_OUT, percent, seconds, shown

BY_ITSELF: Final = (
    "Each recording by itself, and which faults a PASS would have caught: `--format json`, or"
    " `-o\N{NO-BREAK SPACE}report.html`."
)
FAILS: Final = (
    "A node FAILs where it fails in one recording, else it has the verdict on all together."
)
CAUGHT: Final = (
    "Which faults a PASS would have caught: `--format json`, or `-o\N{NO-BREAK SPACE}report.html`."
)

MOST_OPEN: Final = 3
"""So many reasons are told of why a verdict is open."""


def runs_table(runs: Runs) -> str:
    """A row for each recording and for all together, the reasons, the verdict and the counts.

    Of recordings of scenarios a row for each requirement and for each node.
    """
    last = f"{'' if runs.verdict is None else f'{runs.verdict.upper()}  '}{counted(runs)}"
    return "\n\n".join(
        part
        for part in (
            *_scenarios(runs),
            _plain(runs),
            wrapped(_footer(runs), ""),
            section("why", [wrapped(reason) for reason in reasons_of(runs)]),
            section("note", [bullets(remarks_of(runs))]),
            section("next", [bullets(_advice(runs))]),
            *(section(title, blocks) for title, blocks in _together(runs)),
            last,
        )
        if part
    )


def _plain(runs: Runs) -> str:
    """The table of recordings that are judged by one spec each."""
    plain = plain_of(runs.outcomes)
    if not plain:
        return ""
    columns = columns_of(plain)
    header = ("recording", "verdict", *columns, "coverage", "judged", "lost")
    rows = [_row(each, columns) for each in plain]
    rows += [_report_row(pool.report, columns) for pool in runs.pools if not pool.members[0].part]
    return table([header, *rows])


def _scenarios(runs: Runs) -> Iterator[str]:
    """What scenarios require, and their nodes."""
    required = [*requirement_rows(required_of(runs.outcomes))]
    if required:
        rows = [line for each in required for line in _lines(each)]
        yield wide_table([REQUIREMENT_TITLES, *rows])
    nodes = [*node_rows(runs)]
    if nodes:
        yield wide_table([NODE_TITLES, *nodes])
    if left := left_out(runs):
        yield bullets(left)


def _footer(runs: Runs) -> str:
    """What a table of verdicts has no room for, and where it stands."""
    if all(each.part == REQUIREMENTS for each in verifications(runs.outcomes)):
        return ""  # nothing is planted where only requirements are judged
    told = CAUGHT if is_of_one(runs.outcomes) else BY_ITSELF
    return f"{told} {FAILS}" if pools_of_nodes(runs) else told


def _lines(row: RequirementRow) -> list[tuple[str, ...]]:
    """One line for each recording that is told of it."""
    first, *others = row.told
    return [(row.text, row.count, first), *(("", "", each) for each in others)]


def remarks_of(runs: Runs) -> tuple[str, ...]:
    """What has to be known of how nodes were judged, once for all recordings alike."""
    told = [
        f"{each.part}: {remark}" for each in verifications(runs.outcomes) for remark in each.remarks
    ]
    return tuple(dict.fromkeys(told))


def _advice(runs: Runs) -> tuple[str, ...]:
    """What to do next about each node that is open; of one in several recordings: see together."""
    return tuple(
        f"{each.part}: {sentence}"
        for each in nodes_of(runs.outcomes)
        if isinstance(each, Verification) and each not in runs.members
        if each.report.verdict is Verdict.INCONCLUSIVE
        for sentence in each.report.advice
    )


def plain_of(outcomes: Sequence[Outcome]) -> tuple[Outcome, ...]:
    """Recordings that are no scenarios', and those that can't be used."""
    return tuple(
        each
        for each in outcomes
        if isinstance(each, Unusable) or (isinstance(each, Verification) and not each.part)
    )


def told_text(runs: Runs) -> str:
    """What is printed: a report in full where there is one, else the table."""
    first = runs.outcomes[0] if runs.is_whole and len(runs.outcomes) == 1 else None
    return (
        examination_text(first.examination) if isinstance(first, Verification) else runs_table(runs)
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
            [*map(wrapped, _together_reasons(pool)), bullets(advice_of(pool))],
        )
        for pool in runs.pools
        if not pool.members[0].part or pool.report.verdict is not Verdict.PASS
    ]


def _together_reasons(pool: Pool) -> list[str]:
    """Without the recordings that are left out, which are told below the table of nodes."""
    is_told = bool(pool.members[0].part)
    return [each for each in pool.report.reasons if not is_told or LEFT_OUT not in each]


def advice_of(pool: Pool) -> tuple[str, ...]:
    """What to do next about a common verdict; nothing where one recording fails, which decides."""
    fails = any(each.report.verdict is Verdict.FAIL for each in pool.members)
    return () if fails and pool.report.verdict is not Verdict.FAIL else pool.report.advice


def reasons_of(runs: Runs) -> tuple[str, ...]:
    """Why each recording that did not pass did not: `run.mcap, FAIL: …`, what decides first.

    Of a node that several recordings are judged of together only those that fail by themselves.
    """
    settled = {
        each
        for pool in pools_of_nodes(runs)
        for each in pool.members
        if each.report.verdict is not Verdict.FAIL
    }
    open_ones = [each for each in runs.outcomes if each not in settled and _why(each)]
    is_one = is_of_one(runs.outcomes)
    told = [
        f"{_name(each, is_one=is_one)}{_word(each)}: {_why(each)}"
        for each in sorted(open_ones, key=_rank)
    ]
    return tuple(told)


def _name(outcome: Outcome, *, is_one: bool) -> str:
    """The recording, and the part of it; the part alone where there is one recording of several."""
    if is_one and isinstance(outcome, Verification) and outcome.part:
        return outcome.part
    return source_of(outcome)


def _rank(outcome: Outcome) -> int:
    """Those that fail first, then those that can't be used."""
    if not isinstance(outcome, Verification):
        return 1
    return 0 if outcome.report.verdict is Verdict.FAIL else 2


def _word(outcome: Outcome) -> str:
    if not isinstance(outcome, Verification):
        return " can't be used" if isinstance(outcome, Unusable) else ", not judged"
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
    assert isinstance(outcome, Verification), "nodes have a table of their own"
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
    """What decides about what did not pass; empty for what did."""
    if isinstance(outcome, Unusable):
        return "; ".join(d.message for d in outcome.error.diagnostics[:3])
    if isinstance(outcome, NotJudged):
        return outcome.why
    report = outcome.report
    match report.verdict:
        case Verdict.PASS:
            return ""
        case Verdict.FAIL:
            return "".join(report.reasons[:1])
        case Verdict.INCONCLUSIVE:  # each of them leaves it open
            return "; ".join(report.reasons[:MOST_OPEN])

"""Where the modules of a book stand, as one page: a row for each, then what is known of each."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from specc.figures.quantities import seconds
from specc.pages.page import Page, RunRow, RunsPage, RunsTable
from specc.pages.report_page import SIGNS, gathered, rendered
from specc.texts.book_verdict import (
    done_first,
    done_words,
    lacking,
    last_line,
    module_names,
    open_words,
    unrecorded,
)
from specc.texts.scenario_runs import found_in
from specc.verifying.book_modules import BookVerdict, ModuleVerdict, Standing
from verifier.report.report import Verdict

VERDICTS: Final = {
    Standing.DONE: Verdict.PASS,
    Standing.FAILS: Verdict.FAIL,
    Standing.LACKS: Verdict.INCONCLUSIVE,
    Standing.FREE: Verdict.PASS,
}
"""In whose colours a module's standing is told."""
HOW: Final = (
    "Each module is judged by all recordings of it together, where it had its way; it fails where"
    " it fails in one of them."
)


RUNS: Final = "Runs are those of the book's test procedure that go where no recording has been."


def book_verdict_page(verdict: BookVerdict, *, procedures: bool = False) -> str:
    """All modules as self-contained HTML.

    procedures: whether it also says what to record of modules of which nothing was recorded.
    """
    return rendered("runs.html.j2", gathered_book(verdict, procedures=procedures))


def gathered_book(verdict: BookVerdict, *, procedures: bool = False) -> RunsPage:
    """What the page says."""
    names, ordered = module_names(verdict), done_first(verdict)
    told = lacking(verdict, procedures=procedures)
    left = unrecorded(verdict, procedures=procedures)
    anchors = {id(each): f"module-{k + 1}" for k, each in enumerate(ordered)}
    worst = VERDICTS[verdict.standing]
    rows = tuple(_row(each, names[id(each)], anchors[id(each)]) for each in ordered)
    lost = tuple(
        RunRow("", each.source, "unusable", "!", (), each.error.diagnostics[0].message)
        for each in verdict.unusable
    )
    titles = ("kind", "judged", "what was found")
    return RunsPage(
        title=f"{verdict.name}: {last_line(verdict)}",
        verdict=str(worst),
        sign=SIGNS[worst],
        headline=f"{verdict.name}: {open_words(verdict)}",
        reasons=tuple(
            f"{names[id(each)]}: {each.why[0]}"
            for each in ordered
            if each.standing is Standing.FAILS or each in told
        ),
        advice=(
            *(f"{names[id(each)]}: {each.to_record[0]}" for each in told if each.to_record),
            *([left] if left else []),
        ),
        tables=(
            RunsTable("Every module", "module", titles, (*rows, *lost), HOW, words=True),
            *_to_record(told, names, anchors),
        ),
        pages=tuple(_page(each, anchors[id(each)]) for each in ordered if each.together),
        word=done_words(verdict),
    )


def _row(each: ModuleVerdict, name: str, anchor: str) -> RunRow:
    shown = VERDICTS[each.standing]
    judged = "–" if each.together is None else seconds(each.together.report.trace.judged)
    found = each.why[0] if each.together is None else found_in(each.together)
    cells = ((each.piece.kind, ""), (judged, ""), (found, ""))
    return RunRow(
        anchor if each.together else "",
        name,
        str(shown),
        SIGNS[shown],
        cells,
        "",
        str(each.standing),
    )


def _to_record(
    ordered: list[ModuleVerdict], names: dict[int, str], anchors: dict[int, str]
) -> Iterator[RunsTable]:
    """What is still to be recorded, a row for each sentence."""
    rows = tuple(
        RunRow(
            anchors[id(each)] if each.together else "",
            names[id(each)],
            str(VERDICTS[each.standing]),
            SIGNS[VERDICTS[each.standing]],
            ((told, ""),),
            "",
            str(each.standing),
        )
        for each in ordered
        for told in each.to_record
    )
    if rows:
        yield RunsTable("What is still to be recorded", "module", ("what",), rows, RUNS, words=True)


def _page(each: ModuleVerdict, anchor: str) -> tuple[str, Page]:
    assert each.together is not None, "a page is of what was judged"
    page = gathered(each.together, f"{anchor}-", is_drawn=len(each.members) == 1)
    return anchor, replace(page, word=str(each.standing))

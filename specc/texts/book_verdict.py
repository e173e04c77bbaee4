"""Where the modules of a book stand, as text: a row for each, then why, then what to record."""

from typing import Final

from spec_schema.diagnostics import render
from specc.texts.scenario_runs import found_in
from specc.verifying.book_modules import DONE_FIRST, BookVerdict, ModuleVerdict, Standing
from verifier.report.layout import bullets, section, wide_table, wrapped
from verifier.report.wording import listed, seconds

TITLES: Final = ("module", "kind", "spec", "is", "judged", "what was found")
MOST_REASONS: Final = 2
"""So many reasons are told of each module."""


def book_text(verdict: BookVerdict, *, procedures: bool = False) -> str:
    """The table, why modules are not done, what is still to be recorded, and the last line.

    procedures: whether also of modules of which nothing was recorded.
    """
    names = module_names(verdict)
    rows = [_row(each, names) for each in done_first(verdict)]
    failing = [each for each in verdict.modules if each.standing is Standing.FAILS]
    parts = (
        wide_table([TITLES, *rows]),
        section("fails", [wrapped(_told(each, names)) for each in failing]),
        *(_to_record(each, names) for each in lacking(verdict, procedures=procedures)),
        wrapped(unrecorded(verdict, procedures=procedures)),
        *(render(each.error.diagnostics) for each in verdict.unusable),
        last_line(verdict),
    )
    return "\n\n".join(part for part in parts if part)


def taken_text(verdict: BookVerdict) -> tuple[str, ...]:
    """How it was found what each log is of, a line for all that are alike."""
    sources: dict[str, list[str]] = {}
    for module in verdict.modules:
        for each in module.members:
            if not each.part:
                sources.setdefault(each.found.how, []).append(each.report.trace.source)
    found = {how: list(dict.fromkeys(each)) for how, each in sources.items()}
    return tuple(
        f"{each[0]}{f' and {len(each) - 1} more' if len(each) > 1 else ''}: {how}"
        for how, each in found.items()
    )


def last_line(verdict: BookVerdict) -> str:
    """`2 of 8 modules done, 0 fail, 6 lack data`."""
    return f"{done_words(verdict)}, {open_words(verdict)}"


def open_words(verdict: BookVerdict) -> str:
    """`0 fail, 6 lack data`, and what else is not done."""
    free = verdict.count(Standing.FREE)
    told = [_counted(verdict, each) for each in (Standing.FAILS, Standing.LACKS)]
    told += [_counted(verdict, Standing.FREE)] if free else []
    told += [f"{verdict.left_out} left out"] if verdict.left_out else []
    lost = len(verdict.unusable)
    told += [f"{lost} recording{'s' if lost > 1 else ''} can't be used"] if lost else []
    return ", ".join(told)


def done_words(verdict: BookVerdict) -> str:
    """`2 of 8 modules done`."""
    count = len(verdict.modules) - verdict.count(Standing.FREE)
    modules = "module" if count == 1 else "modules"
    return f"{verdict.count(Standing.DONE)} of {count} {modules} done"


def _counted(verdict: BookVerdict, standing: Standing) -> str:
    count = verdict.count(standing)
    plural = {Standing.FAILS: "fail", Standing.LACKS: "lack data", Standing.FREE: "promise nothing"}
    return f"{count} {standing if count == 1 else plural[standing]}"


def done_first(verdict: BookVerdict) -> list[ModuleVerdict]:
    """The modules, what is done first and what nobody recorded last."""
    return sorted(
        verdict.modules,
        key=lambda each: (DONE_FIRST.index(each.standing), not each.is_recorded),
    )


def lacking(verdict: BookVerdict, *, procedures: bool) -> list[ModuleVerdict]:
    """The modules of which is told what to record: those that were recorded, or all."""
    return [
        each
        for each in done_first(verdict)
        if each.standing is Standing.LACKS and (procedures or each.is_recorded)
    ]


def unrecorded(verdict: BookVerdict, *, procedures: bool) -> str:
    """Where in the book it stands what to record of the other modules; empty where there are none.

    `nothing is recorded of dock and see: what to record stands in the book, on pages/dock.html and
    pages/see.html; --procedures prints it, --only leaves them out`
    """
    told = lacking(verdict, procedures=procedures)
    left = [e for e in verdict.modules if e.standing is Standing.LACKS and e not in told]
    if not left:
        return ""
    names = module_names(verdict)
    return (
        f"nothing is recorded of {listed([names[id(each)] for each in left])}: what to record"
        f" stands in the book, on {listed([each.page for each in left])}; --procedures prints it,"
        " --only leaves them out"
    )


def module_names(verdict: BookVerdict) -> dict[int, str]:
    """Of each module its node; with its architecture where there are several."""
    has_many = len({each.piece.place.architecture for each in verdict.modules}) > 1
    return {
        id(each): (
            f"{each.piece.place.architecture}.{each.piece.place.node}"
            if has_many
            else each.piece.place.node
        )
        for each in verdict.modules
    }


def _row(each: ModuleVerdict, names: dict[int, str]) -> tuple[str, ...]:
    spec = "" if each.piece.spec is None else each.piece.spec.name
    standing = each.standing.upper() if each.standing is Standing.FAILS else str(each.standing)
    if each.together is None:
        return (names[id(each)], each.piece.kind, spec, standing, "-", each.why[0])
    judged = seconds(each.together.report.trace.judged)
    return (names[id(each)], each.piece.kind, spec, standing, judged, found_in(each.together))


def _told(each: ModuleVerdict, names: dict[int, str]) -> str:
    return f"{names[id(each)]}: {'; '.join(each.why[:MOST_REASONS])}"


def _to_record(each: ModuleVerdict, names: dict[int, str]) -> str:
    """What a module lacks: why it is open, and what to record."""
    return section(
        f"{names[id(each)]} lacks data",
        [wrapped("; ".join(each.why[:MOST_REASONS])), bullets(each.to_record)],
    )

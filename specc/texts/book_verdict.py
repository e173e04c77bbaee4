"""Where the modules of a book stand, as text: a row for each, then why, then what to record."""

from typing import Final

from spec_schema.diagnostics import render
from specc.texts.scenario_runs import found_in
from specc.verifying.book_modules import WORST_FIRST, BookVerdict, ModuleVerdict, Standing
from verifier.report.layout import bullets, section, wide_table, wrapped
from verifier.report.wording import seconds

TITLES: Final = ("module", "kind", "spec", "is", "judged", "what was found")
MOST_REASONS: Final = 2
"""So many reasons are told of each module."""


def book_text(verdict: BookVerdict) -> str:
    """The table, why modules are not done, what is still to be recorded, and the last line."""
    names = module_names(verdict)
    rows = [_row(each, names) for each in worst_first(verdict)]
    failing = [each for each in verdict.modules if each.standing is Standing.FAILS]
    lacking = [each for each in verdict.modules if each.standing is Standing.LACKS]
    parts = (
        wide_table([TITLES, *rows]),
        section("fails", [wrapped(_told(each, names)) for each in failing]),
        *(_to_record(each, names) for each in lacking),
        *(render(each.error.diagnostics) for each in verdict.unusable),
        last_line(verdict),
    )
    return "\n\n".join(part for part in parts if part)


def last_line(verdict: BookVerdict) -> str:
    """`FAILS  3 modules: 1 fails, 1 lacks data, 1 done`."""
    counts = {each: verdict.count(each) for each in WORST_FIRST}
    told = ", ".join(f"{count} {_verb(each, count)}" for each, count in counts.items() if count)
    word = {Standing.DONE: "DONE", Standing.FAILS: "FAIL"}.get(verdict.standing, "LACKS DATA")
    modules = len(verdict.modules)
    lost = len(verdict.unusable)
    unusable = f", {lost} recording{'s' if lost > 1 else ''} can't be used" if lost else ""
    return f"{word}  {modules} module{'s' if modules > 1 else ''}: {told}{unusable}"


def _verb(standing: Standing, count: int) -> str:
    plural = {Standing.FAILS: "fail", Standing.LACKS: "lack data", Standing.FREE: "promise nothing"}
    return plural.get(standing, str(standing)) if count > 1 else str(standing)


def worst_first(verdict: BookVerdict) -> list[ModuleVerdict]:
    """The modules, what is not done first."""
    return sorted(verdict.modules, key=lambda each: WORST_FIRST.index(each.standing))


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

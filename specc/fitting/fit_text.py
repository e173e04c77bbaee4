"""A fit as text for people, and as a record for programs."""

from typing import Final

from specc.fitting.fitted import Fitted, Outcome
from specc.fitting.moves import Move
from specc.fitting.weighing import Weighed
from verifier.report.layout import INDENT, bullets, section, table, wrapped
from verifier.report.report import Report, Verdict
from verifier.report.wording import listed

MOST: Final = 12
"""So many moves are listed; the diff shows all."""
FORMAT: Final = 1
"""Counts up when a reader of the record would have to change."""
OPENINGS: Final = {
    Outcome.MOVED: "moved",
    Outcome.NOTHING_TO_MOVE: "nothing is to be moved",
    Outcome.NOTHING_MENDS_IT: "nothing is edited: no number of the spec mends it",
    Outcome.BY_HAND: "nothing is edited: a number within an expression is to be changed by hand",
    Outcome.STRUCTURE_DIFFERS: "nothing is edited: the structure differs",
    Outcome.CANNOT_TELL: "nothing is edited: the recordings can't tell what to move",
}


def fit_text(fitted: Fitted) -> str:
    """The verdicts, the moves with their reasons, what is left open, and the diff."""
    parts = [
        _opening(fitted),
        section("verdict", [table(_verdicts(fitted), "  ")]),
        section("still open with the edit", [wrapped(said) for said in _not_passed(fitted)]),
        _table_of_moves(fitted),
        section("why", [wrapped(reason) for reason in _reasons(fitted)]),
        *(_way(way, place) for place, way in enumerate(fitted.ways)),
        section("what would tell them apart", [bullets(_telling(fitted))]),
        section("what explains it less well", [bullets(fitted.instead)]),
        section("left open", [wrapped(sentence) for sentence in _open(fitted)]),
        fitted.diff.rstrip("\n"),
    ]
    return "\n\n".join(part for part in parts if part)


def fit_record(fitted: Fitted, *, is_written: bool) -> dict[str, object]:
    """The same as numbers and texts."""
    return {
        "format": FORMAT,
        "spec": str(fitted.path),
        "found": fitted.how,
        "outcome": str(fitted.outcome),
        "written": is_written,
        "moves": [_record(move) for move in fitted.moves],
        "ways": [
            {
                "claim": way.explanation.claim,
                "moves": [_record(move) for move in way.moves],
                "after": [_verdict(report) for report in way.after],
                "telling": way.explanation.telling,
            }
            for way in fitted.ways
        ],
        "instead": list(fitted.instead),
        "beyond": list(fitted.beyond),
        "left": list(fitted.left),
        "choices": list(fitted.choices),
        "stays": list(fitted.stays),
        "before": [_verdict(report) for report in fitted.before],
        "after": [_verdict(report) for report in fitted.after],
        "diff": fitted.diff,
    }


def _opening(fitted: Fitted) -> str:
    count = len(fitted.moves)
    numbers = (
        f" {count} number{'' if count == 1 else 's'}" if fitted.outcome is Outcome.MOVED else ""
    )
    return f"{OPENINGS[fitted.outcome]}{numbers}"


def _record(move: Move) -> dict[str, object]:
    return {
        "name": move.name,
        "place": move.place,
        "path": move.path,
        "old": move.old or None,
        "new": move.new,
        "sentence": move.sentence,
    }


def _verdict(report: Report) -> dict[str, object]:
    return {
        "trace": report.trace.source,
        "verdict": str(report.verdict),
        "reason": report.reasons[0] if report.reasons else "",
    }


def _verdicts(fitted: Fitted) -> list[tuple[str, ...]]:
    """One row for each recording."""
    after = [str(report.verdict).upper() for report in fitted.after]
    after = after or [""] * len(fitted.before)
    return [
        (report.trace.source, str(report.verdict).upper(), f"-> {new}" if new else "")
        for report, new in zip(fitted.before, after, strict=True)
    ]


def _moves(moves: tuple[Move, ...]) -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = [
        (m.name, m.old or "(none)", f"-> {m.new}", m.place) for m in moves[:MOST]
    ]
    more = len(moves) - MOST
    return [*rows, (f"and {more} more", "", "", "")] if more > 0 else rows


def _table_of_moves(fitted: Fitted) -> str:
    """What is moved, or would be; of several ways, each shows its own."""
    if not fitted.moves or (fitted.ways and not fitted.diff):
        return ""
    return section("moves" if fitted.diff else "would move", [table(_moves(fitted.moves), "  ")])


def _way(way: Weighed, place: int) -> str:
    """An explanation that is as good as others, with its edits and the verdicts with them."""
    verdicts = listed(list(dict.fromkeys(str(each.verdict).upper() for each in way.after)))
    first = "either (--anyway takes this)" if place == 0 else "or"
    rows = table(_moves(way.moves), INDENT)
    return section(first, [wrapped(f"{way.explanation.claim} -> {verdicts}"), rows])


def _telling(fitted: Fitted) -> tuple[str, ...]:
    return tuple(dict.fromkeys(way.explanation.telling for way in fitted.ways))


def _not_passed(fitted: Fitted) -> tuple[str, ...]:
    """Why the edited spec does not pass, where it does not."""
    return tuple(
        f"{report.trace.source} is {str(report.verdict).upper()}: {report.reasons[0]}"
        for report in (fitted.after if fitted.diff else ())
        if report.verdict is not Verdict.PASS and report.reasons
    )


def _reasons(fitted: Fitted) -> tuple[str, ...]:
    if fitted.outcome is Outcome.NOTHING_TO_MOVE:
        return ("the recordings show no difference that a number of the spec would mend",)
    if fitted.outcome is Outcome.NOTHING_MENDS_IT:
        failed = [report for report in fitted.before if report.verdict is Verdict.FAIL]
        return tuple(f"{report.trace.source}: {report.reasons[0]}" for report in failed)
    if fitted.ways and not fitted.diff:
        return fitted.choices
    said = dict.fromkeys(move.sentence for move in fitted.moves)
    is_open = fitted.outcome is Outcome.CANNOT_TELL
    return (*fitted.choices, *said) if is_open else (*said, *fitted.choices)


def _open(fitted: Fitted) -> tuple[str, ...]:
    return (*fitted.beyond, *fitted.left, *fitted.stays)

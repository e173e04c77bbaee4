"""A fit as text for people, and as a record for programs."""

from typing import Final

from specc.fitting.fitted import Fitted, Outcome
from specc.fitting.moves import Move
from verifier.report.layout import section, table, wrapped
from verifier.report.report import Report, Verdict

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
        section("moves" if fitted.diff else "would move", [table(_moves(fitted.moves), "  ")])
        if fitted.moves
        else "",
        section("why", [wrapped(reason) for reason in _reasons(fitted)]),
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
        "moves": [
            {
                "name": move.name,
                "place": move.place,
                "path": move.path,
                "old": move.old or None,
                "new": move.new,
                "sentence": move.sentence,
            }
            for move in fitted.moves
        ],
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


def _verdict(report: Report) -> dict[str, object]:
    return {"trace": report.trace.source, "verdict": str(report.verdict)}


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


def _reasons(fitted: Fitted) -> tuple[str, ...]:
    if fitted.outcome is Outcome.NOTHING_TO_MOVE:
        return ("the recordings show no difference that a number of the spec would mend",)
    if fitted.outcome is Outcome.NOTHING_MENDS_IT:
        failed = [report for report in fitted.before if report.verdict is Verdict.FAIL]
        return tuple(f"{report.trace.source}: {report.reasons[0]}" for report in failed)
    said = dict.fromkeys(move.sentence for move in fitted.moves)
    return (*said, *fitted.choices)


def _open(fitted: Fitted) -> tuple[str, ...]:
    return (*fitted.beyond, *fitted.left, *fitted.stays)

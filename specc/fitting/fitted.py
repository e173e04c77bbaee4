"""What a fit comes to: the moves, the text before and after, and the verdicts on both."""

import difflib
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import final

from spec_schema.source import Source
from specc.files import write_over
from specc.fitting.moves import Move
from specc.fitting.weighing import Weighed
from verifier.report.report import Report


@final
class Outcome(StrEnum):
    """How a fit ended. Only MOVED has another text than before.

    NOTHING_MENDS_IT: a recording fails, and no number of the spec was found that explains it.
    BY_HAND: a number that does stands within an expression, where none is moved.
    """

    MOVED = "moved"
    NOTHING_TO_MOVE = "nothing to move"
    NOTHING_MENDS_IT = "nothing mends it"
    BY_HAND = "to be edited by hand"
    STRUCTURE_DIFFERS = "the structure differs"
    CANNOT_TELL = "cannot tell"


@final
@dataclass(frozen=True, eq=False, slots=True)
class Fitted:
    """A spec, fitted to recordings; nothing is written but by `write`.

    how: which spec it is, and why. moves: what was moved, or would be. beyond: what departs and is
    no number of the spec. left: what the moves would leave open. choices: what the recordings
    can't tell. stays: what stays as it is since nothing tells it. before, after: the reports on
    each recording; none after where no edit was tried. ways: explanations that are as good as one
    another, with the edits that each would mean. instead: why explanations that leave the same
    trace were not taken.
    """

    outcome: Outcome
    how: str
    source: Source
    edited: Source
    moves: tuple[Move, ...]
    beyond: tuple[str, ...]
    left: tuple[str, ...]
    choices: tuple[str, ...]
    stays: tuple[str, ...]
    before: tuple[Report, ...]
    after: tuple[Report, ...]
    ways: tuple[Weighed, ...] = ()
    instead: tuple[str, ...] = ()

    @property
    def path(self) -> Path:
        """The spec's file."""
        return Path(self.source.name)

    @property
    def diff(self) -> str:
        """The change as a unified diff with one line of context; empty where there is none."""
        old, new = (text.splitlines(keepends=True) for text in (self.source.text, self.edited.text))
        name = self.source.name
        lines = difflib.unified_diff(old, new, name, name, n=1)
        return "".join(
            line if line.endswith(("\n", "\r")) else f"{line}\n\\ No newline at end of file\n"
            for line in lines
        )

    def write(self) -> None:
        """Replace the spec's file by the edited text, whole or not at all.

        Raises:
            SpecError: it was changed in the meantime (V374), or can't be written (V347).
        """
        write_over(self.path, self.source.text, self.edited.text, "it was fitted")


def joined(first: Fitted, last: Fitted) -> Fitted:
    """An edit and what a further round found with it; a round that edits nothing says why."""
    if last.outcome is not Outcome.MOVED:
        open_ = (*last.beyond, *last.left, *last.choices)
        claims = tuple(way.explanation.claim for way in last.ways)
        return replace(first, stays=tuple(dict.fromkeys((*first.stays, *open_, *claims))))
    found = {move.path: move for move in first.moves}
    for move in last.moves:
        old = found.get(move.path, move)
        found[move.path] = replace(move, old=old.old, place=old.place)
    return replace(
        first,
        edited=last.edited,
        moves=tuple(found.values()),
        stays=(*first.stays, *last.stays),
        after=last.after,
        instead=(*first.instead, *last.instead),
    )

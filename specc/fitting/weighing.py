"""Explanations weighed: each one's edits are made and judged by the same recordings."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, final

from spec_schema.diagnostics import SpecError
from spec_schema.load import Loaded
from specc.fitting.cases import Case, Logs, Tell
from specc.fitting.compiling import compiled
from specc.fitting.explanations import Explanation
from specc.fitting.moves import Move, moved, moves_of
from verifier.diagnosis.selection import CLOSE
from verifier.report.report import Report, Verdict
from verifier.report.wording import listed

MOST: Final = 8
"""So many explanations are weighed."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Weighed:
    """An explanation, its edits and the reports with them. left: what would still depart."""

    explanation: Explanation
    moves: tuple[Move, ...]
    after: tuple[Report, ...]
    left: tuple[str, ...]

    @property
    def is_passed(self) -> bool:
        """Whether every recording passes with it."""
        return all(each.verdict is Verdict.PASS for each in self.after)


def weighed(
    loaded: Loaded,
    cases: Sequence[Case],
    logs: Logs,
    explanations: Sequence[Explanation],
    departures: Callable[[Case], tuple[str, ...]],
    tell: Tell,
) -> tuple[Weighed, ...]:
    """Those whose edits make a spec, each judged with them."""
    found = []
    for each in explanations[:MOST]:
        moves = moves_of(loaded, each.aims)
        if not moves:
            continue
        try:
            _, program = compiled(moved(loaded.source, moves))
        except SpecError:  # its number is none that the spec can have
            continue
        again = logs.judged_again(cases, program, tell)
        left = tuple(dict.fromkeys(said for case in again for said in departures(case)))
        found.append(Weighed(each, moves, tuple(case.report for case in again), left))
    return tuple(found)


def as_good(found: Sequence[Weighed]) -> tuple[Weighed, ...]:
    """The best, and what is no worse; values that the spec declares for the log come last.

    Of those that leave nothing, passing ones with the fewest edits: one cause that explains three
    shifts is better than three. Among these, held-out windows decide; and the behavior's own
    numbers go before those of the log, which say the same in other words.
    """
    whole = [each for each in found if not each.left]
    if not whole:
        return ()
    best = min(_cost(each) for each in whole)
    few = [each for each in whole if _cost(each) == best]
    top = max(each.explanation.gain for each in few)
    near = [each for each in few if each.explanation.gain > top - CLOSE]
    own = [each for each in near if all(aim.path[0] != "trace" for aim in each.explanation.aims)]
    return tuple(sorted(own or near, key=lambda each: each.explanation.is_declared))


def passed_over(found: Sequence[Weighed], best: Weighed) -> tuple[str, ...]:
    """Why the others were not taken, though they leave the same trace in the windows."""
    return tuple(
        f"not that {each.explanation.claim}: {_why_not(each, best)}"
        for each in found
        if each is not best and not each.explanation.label.endswith(" with the rest")
    )


def _why_not(other: Weighed, best: Weighed) -> str:
    if other.left:
        return f"with it {'; '.join(other.left)}"
    if best.is_passed and not other.is_passed:
        return "with it the verdict would not be PASS"
    if len(other.moves) > len(best.moves):
        names = listed([move.name for move in other.moves])
        return f"it takes {len(other.moves)} edits ({names}) for what this explains with fewer"
    if any(aim.path[0] == "trace" for aim in other.explanation.aims):
        return "it says the same by a number of the log; the behavior's own go first"
    return "it predicts windows that it was not fitted to less well"


def _cost(found: Weighed) -> tuple[bool, int]:
    return not found.is_passed, len(found.moves)

"""Requirements on a run: signal temporal logic over named quantities (Maler, Nickovic 2004)."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Final, final

from runtime.code import Code

ROUNDING: Final = 1e-9
"""In SI: where a run is judged, a margin that is so little below 0 is 0."""
TIE: Final = 2 * ROUNDING
"""In SI: what the margin at equality is: above 0 of `>=` and `<=`, below 0 of `>` and `<`."""


@final
class Operator(StrEnum):
    """What stands at a node of a formula."""

    PREDICATE = "predicate"
    NOT = "not"
    AND = "and"
    OR = "or"
    IMPLIES = "implies"
    ALWAYS = "always"
    EVENTUALLY = "eventually"
    UNTIL = "until"

    @property
    def operands(self) -> int:
        """How many parts before it are its own."""
        match self:
            case Operator.PREDICATE:
                return 0
            case Operator.NOT | Operator.ALWAYS | Operator.EVENTUALLY:
                return 1
            case Operator.AND | Operator.OR | Operator.IMPLIES | Operator.UNTIL:
                return 2


@final
@dataclass(frozen=True, slots=True)
class Formula:
    """A formula in postfix order: each part says how many parts before it are its own.

    margin: of a PREDICATE, code whose value is its robustness: 0 or more where it holds, moved by
    `TIE` so that it is clear on which side equality is, also of what stands behind a `not`.
    first, last: the window of a temporal operator, in seconds from now; last is infinite (None)
    for the rest of the run.
    """

    operator: Operator
    margin: Code | None
    first: float
    last: float | None


@final
@dataclass(frozen=True, slots=True)
class Requirement:
    """A sentence that a run must satisfy from its beginning.

    text: as its author wrote it. formula: its parts in postfix order. quantities: the names that
    predicates read, the register of their code. unit, scale: how robustness is shown, where all
    predicates have one dimension; else an empty unit and 1.
    """

    text: str
    formula: tuple[Formula, ...]
    quantities: tuple[str, ...]
    unit: str
    scale: float
    origin: str

"""Requirements on a run: signal temporal logic over named quantities (Maler, Nickovic 2004)."""

from dataclasses import dataclass
from enum import StrEnum
from typing import final

from runtime.code import Code


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

    margin: of a PREDICATE, code whose value is its robustness: 0 or more where it holds, and below
    it by a few nanounits where `>` or `<` meets equality.
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

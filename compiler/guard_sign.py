"""A condition as a number that is zero or more where it holds, so that its opening can be located.

`a >= b` becomes a - b, `and` the least, `or` the greatest of both sides. What equality decides has
no side to cross, unless it is the value of a discrete variable, which is +1 or -1. So is what else
compares discrete variables only: `contacts > 0` does not hold at 0, where a difference would be 0.
"""

from collections.abc import Collection
from typing import Final

from spec_schema.expressions.tree import Apply, Expr, Name, Number, walk

OPPOSITE: Final = {"ge": "lt", "gt": "le", "le": "gt", "lt": "ge", "eq": "ne", "ne": "eq"}
DUAL: Final = {"and": "or", "or": "and"}
EXTREME: Final = {"and": "min", "or": "max"}


def signed(condition: Expr, discrete: Collection[str], tie: float = 0.0) -> Expr | None:
    """The signed form of a condition; None where it is not made of comparisons.

    tie: what is taken off where equality does not hold, and added where it does, so that the sign
    at a tie is sure, and the opposite of that of the opposite condition.

    >>> from spec_schema.expressions.parse import parse
    >>> from spec_schema.expressions.printers.text import to_text
    >>> found = signed(parse("x >= 1 and not v > 0"), ())
    >>> found and to_text(found)
    'min(x - 1, 0 - v)'
    """
    match condition:
        case Apply(op=op, operands=operands) if _is_stepped(op, operands, discrete):
            return Apply("where", (condition, Number(1.0), Number(-1.0)))
        case Apply(op="ge" | "gt" as op, operands=(a, b)):
            return _told_apart(Apply("sub", (a, b)), tie, holds=op == "ge")
        case Apply(op="le" | "lt" as op, operands=(a, b)):
            return _told_apart(Apply("sub", (b, a)), tie, holds=op == "le")
        case Apply(op="and" | "or" as op, operands=(a, b)):
            left, right = signed(a, discrete, tie), signed(b, discrete, tie)
            return None if left is None or right is None else Apply(EXTREME[op], (left, right))
        case Apply(op="not", operands=(inner,)):
            opposite = _negated(inner)
            return None if opposite is None else signed(opposite, discrete, tie)
    return None


def _told_apart(difference: Expr, tie: float, *, holds: bool) -> Expr:
    """The difference, moved by the tie to the side on which equality is."""
    return Apply("add" if holds else "sub", (difference, Number(tie))) if tie else difference


def _is_stepped(op: str, operands: tuple[Expr, ...], discrete: Collection[str]) -> bool:
    """Whether what is compared moves in steps: an equal value, or nothing but discrete ones."""
    if op in {"eq", "ne"}:
        return any(isinstance(part, Name) and part.name in discrete for part in operands)
    names = {part.name for each in operands for part in walk(each) if isinstance(part, Name)}
    return op in OPPOSITE and bool(names) and names <= {*discrete}


def _negated(condition: Expr) -> Expr | None:
    """The condition that holds where this one does not."""
    match condition:
        case Apply(op="not", operands=(inner,)):
            return inner
        case Apply(op="and" | "or" as op, operands=(a, b)):
            return Apply(DUAL[op], (Apply("not", (a,)), Apply("not", (b,))))
        case Apply(op=op, operands=operands) if op in OPPOSITE:
            return Apply(OPPOSITE[op], operands)
    return None

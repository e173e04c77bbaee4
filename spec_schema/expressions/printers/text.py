"""The language itself: text that `parse` reads back as the same tree."""

import math

from spec_schema.expressions.printers.numerals import numeral
from spec_schema.expressions.printers.piece import (
    AND,
    COMPARISON,
    NOT,
    OR,
    POWER,
    SIGN,
    SUM,
    TERM,
    Piece,
    call,
    joined,
)
from spec_schema.expressions.tree import COMPARISONS, Apply, Expr, Name, Number, Text, fold

GROUPED: dict[str, tuple[str, int]] = {
    "or": (" or ", OR),
    "and": (" and ", AND),
    "add": (" + ", SUM),
    "sub": (" - ", SUM),
    "mul": ("*", TERM),
    "div": ("/", TERM),
    "mod": (" % ", TERM),
}


def to_text(expr: Expr) -> str:
    """The expression as people write it, with no more brackets than it needs.

    It reads back as an equal tree, provided that no literal is negated by `neg` (`parse` and
    `simplify` make one negative literal of it).

    >>> from spec_schema.expressions.parse import parse
    >>> to_text(parse("((a)+(b*c))**(-2)"))
    '(a + b*c)**-2'
    """
    return fold(expr, _piece).text


def _piece(node: Expr, operands: tuple[Piece, ...]) -> Piece:
    match node:
        case Number(value=value):
            text = (
                numeral(value).replace(repr(math.pi), "pi")
                if abs(value) == math.pi
                else numeral(value)
            )
            return Piece(text, SIGN) if text.startswith("-") else Piece(text)
        case Name(name=name):
            return Piece(name)
        case Text(text=text):
            return Piece(f"'{text}'" if "'" not in text else f'"{text}"')
        case Apply(op=op):
            return _operation(op, operands)


def _operation(op: str, operands: tuple[Piece, ...]) -> Piece:
    first, last = operands[0], operands[-1]
    if op in GROUPED:
        return joined(*GROUPED[op], first, last)
    if op in COMPARISONS:
        # A chain means `and`, so a comparison of comparisons has brackets on both sides.
        sides = (part.inside(COMPARISON + 1) for part in operands)
        return Piece(f" {COMPARISONS[op]} ".join(sides), COMPARISON)
    if op == "not":
        return Piece(f"not {first.inside(NOT)}", NOT)
    if op == "neg":
        return Piece(f"-{first.inside(SIGN + 1)}", SIGN)
    if op == "pow":
        return Piece(f"{first.inside(POWER + 1)}**{last.inside(SIGN)}", POWER)
    return call(op, operands)

"""Postfix code: the tokens that the machine runs, `x v * 2 pow` written as `x v mul 2 pow`."""

from spec_schema.expressions.printers.numerals import numeral
from spec_schema.expressions.tree import Apply, Expr, Name, Number, fold


def to_postfix(expr: Expr) -> str:
    """The expression as postfix tokens with single spaces between; exact.

    Texts have no number of their own: replace them first (`rewrite.resolve_texts`).

    >>> from spec_schema.expressions.parse import parse
    >>> to_postfix(parse("(x*v)**2"))
    'x v mul 2 pow'
    """
    return fold(expr, _token)


def _token(node: Expr, operands: tuple[str, ...]) -> str:
    match node:
        case Number(value=value):
            return numeral(value)
        case Name(name=name):
            return name
        case Apply(op=op):
            return " ".join((*operands, op))
    raise AssertionError("texts are resolved before code is written")

"""Arithmetic on the expressions of a sketch: sums, products, places between places."""

from collections.abc import Mapping

from compiler.sketch.drawing import Pair
from spec_schema.expressions.rewrite import simplify, substitute
from spec_schema.expressions.tree import Apply, Expr, Number


def plus(left: Expr, right: Expr) -> Expr:
    """The sum, simplified."""
    return simplify(Apply("add", (left, right)))


def minus(left: Expr, right: Expr) -> Expr:
    """The difference, simplified."""
    return simplify(Apply("sub", (left, right)))


def times(left: Expr, right: Expr) -> Expr:
    """The product, simplified."""
    return simplify(Apply("mul", (left, right)))


def over(left: Expr, right: Expr) -> Expr:
    """The quotient, simplified."""
    return simplify(Apply("div", (left, right)))


def scaled(factor: float, expr: Expr) -> Expr:
    """A number times an expression."""
    return times(Number(factor), expr)


def between(first: Pair, second: Pair, share: float) -> Pair:
    """The place at `share` of the way from the first to the second; beyond it above 1."""
    one, two = (
        plus(scaled(1.0 - share, a), scaled(share, b)) for a, b in zip(first, second, strict=True)
    )
    return one, two


def split(expr: Expr) -> tuple[float, Expr]:
    """The expression as a number times an expression without one in front."""
    match expr:
        case Number(value=value):
            return value, Number(1.0)
        case Apply("neg", (inner,)):
            factor, rest = split(inner)
            return -factor, rest
        case Apply("mul", (left, right)):
            a, first = split(left)
            b, second = split(right)
            return a * b, times(first, second)
        case Apply("div", (left, Number(value=value))) if value != 0.0:
            factor, rest = split(left)
            return factor / value, rest
    return 1.0, expr


def with_constants(expr: Expr, constants: Mapping[str, Expr]) -> Expr:
    """The expression with numbers in the constants' places."""
    return simplify(substitute(expr, constants))

"""Derivatives: sympy agrees exactly, differences agree for every operation in every operand."""

from itertools import pairwise

import pytest
import sympy

from spec_schema.expressions.derivative import derivative
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.parse import parse
from spec_schema.expressions.printers.text import to_text
from spec_schema.expressions.tree import ARITY, Apply, Name


@pytest.mark.parametrize(
    "text",
    [
        "x**5 - 3*x**2 + 7",
        "x**-3",
        "x**y",
        "y**x",
        "x**x",
        "(x + y)/(x - y)",
        "mu*(1 - x**2)*v - x",
        "-k*sin(x) - d*v",
        "sin(x)*cos(x)*tan(x)",
        "exp(-x**2/2)/sqrt(2*pi)",
        "log(x**2 + 1)",
        "sqrt(x**3 + y)",
        "asin(x/y) + acos(x*y) + atan(x**2)",
        "sinh(x)*cosh(y*x)*tanh(x/2)",
        "atan2(x**2, y)",
        "atan2(y, x)",
        "exp(sin(log(x)))",
        "1/(1 + exp(-y*(x - 1)))",
    ],
)
def test_sympy_finds_exactly_the_same(text: str) -> None:
    symbols = {name: sympy.Symbol(name, positive=True) for name in ("x", "y", "v", "mu", "k", "d")}
    ours = sympy.sympify(to_text(derivative(parse(text), "x")), locals=symbols, rational=True)
    theirs = sympy.diff(sympy.sympify(text, locals=symbols, rational=True), symbols["x"])

    assert sympy.simplify(ours - theirs) == 0


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("3", "0"),
        ("y", "0"),
        ("x", "1"),
        ("x**2", "2*x"),
        ("abs(x)", "sign(x)"),
        ("min(x, y)", "where(x < y, 1, 0)"),
        ("max(x, 2*x)", "where(x > 2*x, 1, 2)"),
        ("where(x > y, x**2, y)", "where(x > y, 2*x, 0)"),
        ("floor(x) + sign(x) + (x > y) + (x and not x)", "0"),
        ("wrap(3*x)", "3"),
        ("x % 2", "1"),
    ],
)
def test_a_piece_has_the_derivative_of_its_piece(text: str, expected: str) -> None:
    assert to_text(derivative(parse(text), "x")) == expected


@pytest.mark.parametrize("op", ARITY)
@pytest.mark.parametrize("place", [0, 1, 2])
def test_differences_agree_for_each_operation_in_each_operand(op: str, place: int) -> None:
    """On both sides of the corners of `min`, `clip` and `where`."""
    moving = parse("0.6*x - 0.15")
    for rest in ([Name("y"), Name("z")], [Name("z"), Name("y")]):
        operands = [*rest[:place], moving, *rest[place:]]
        expr = Apply(op, tuple(operands[: ARITY[op]]))
        for x in (0.3, 0.7, 1.37):
            slope, rate = _slope(expr, x), evaluate(derivative(expr, "x"), _at(x))
            assert slope == pytest.approx(rate, rel=1e-6, abs=1e-6)


def _at(x: float) -> dict[str, float]:
    return {"x": x, "y": 0.23, "z": 0.61}


def _slope(expr: Apply, x: float) -> float:
    step = 1e-5
    return (evaluate(expr, _at(x + step)) - evaluate(expr, _at(x - step))) / (2 * step)


def test_a_deep_expression_has_a_derivative() -> None:
    text = "sin(" * 45 + "x" + ")" * 45 + "*x" * 100
    assert evaluate(derivative(parse(text), "x"), {"x": 0.0}) == 0.0


def test_the_derivative_of_a_long_product_grows_with_the_square_of_its_length() -> None:
    lengths = [len(to_text(derivative(parse("*".join(["x"] * n + ["y"])), "x"))) for n in (40, 80)]
    for short, long in pairwise(lengths):
        assert long < 6 * short

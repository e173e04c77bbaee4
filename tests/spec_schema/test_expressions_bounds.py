"""Bounds hold for every operation and operand, and are sharp where the operands are independent."""

import math
import random

import mpmath
import pytest

from spec_schema.expressions.bounds import bounds
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.parse import parse
from spec_schema.expressions.tree import ARITY, Apply, Expr, Name, Number

NAMES = ("x", "y", "z")
ENDS = (-1e9, -50.0, -4.0, -math.pi, -1.5, -1.0, -0.3, 0.0, 1e-9, 0.3, 1.0, 2.0, math.pi, 7.0, 1e9)


def assert_bounded(expr: Expr) -> None:
    """On boxes between awkward ends, at corners and inside."""
    rng = random.Random(0)  # noqa: S311  # the same boxes for every expression
    for _ in range(150):
        box = {name: tuple(sorted((rng.choice(ENDS), rng.choice(ENDS)))) for name in NAMES}
        low, high = bounds(expr, {name: (a, b) for name, (a, b) in box.items()})
        for _ in range(8):
            point = {
                name: min(b, max(a, rng.choice((a, b, 0.0, rng.uniform(a, b)))))
                for name, (a, b) in box.items()
            }
            value = evaluate(expr, point)
            assert math.isnan(value) or low <= value <= high, (box, point)


@pytest.mark.parametrize("op", ARITY)
def test_each_operation_is_bounded(op: str) -> None:
    names = tuple(Name(name) for name in NAMES)
    # Operands that may be nan, whole, zero or infinite.
    awkward = (Apply("sqrt", names[:1]), Apply("floor", names[1:2]), Apply("exp", names[2:]))
    for operands in (names, awkward, awkward[::-1]):
        assert_bounded(Apply(op, operands[: ARITY[op]]))


@pytest.mark.parametrize("n", [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 7.0, -0.5, 0.5, 1.5])
def test_each_power_is_bounded(n: float) -> None:
    assert_bounded(Apply("pow", (Name("x"), Number(n))))
    assert_bounded(Apply("pow", (Apply("log", (Name("x"),)), Number(n))))


SERIES = ("exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "sqrt")


@pytest.mark.parametrize("op", SERIES)
def test_the_true_value_of_a_function_lies_in_its_bounds(op: str) -> None:
    """At 40 digits, which a double's rounding can't reach."""
    rng = random.Random(1)  # noqa: S311  # the same points each time
    with mpmath.workdps(40):
        for x in [rng.uniform(0, 1) for _ in range(100)]:
            low, high = bounds(Apply(op, (Name("x"),)), {"x": (x, x)})
            assert low <= getattr(mpmath, op)(mpmath.mpf(x)) <= high
            assert high - low < 1e-14 * (1 + abs(high))


INF = math.inf


@pytest.mark.parametrize(
    ("text", "low", "high"),
    [
        ("x**2", 0, 4),
        ("x*x", 0, 4),
        ("x**3", -1, 8),
        ("x**-1", -INF, INF),
        ("x**-2", 0, INF),
        ("x**0.5", 0, math.sqrt(2)),
        ("x**0", 1, 1),
        ("2**x", 0.5, 4),
        ("1/x", -INF, INF),
        ("1/(x + 2)", 0.25, 1),
        ("sqrt(x)", 0, math.sqrt(2)),
        ("log(x)", -INF, math.log(2)),
        ("asin(x)", -math.pi / 2, math.pi / 2),
        ("abs(x)", 0, 2),
        ("sign(x)", -1, 1),
        ("floor(x - 0.5)", -2, 1),
        ("sin(x)", -math.sin(1), 1),
        ("cos(x)", math.cos(2), 1),
        ("sin(100*x)", -1, 1),
        ("cos(3 + x/10)", -1, math.cos(2.9)),
        ("tan(x/2)", math.tan(-0.5), math.tan(1)),
        ("tan(x)", -INF, INF),
        ("cosh(x)", 1, math.cosh(2)),
        ("wrap(x)", -1, 2),
        ("wrap(x + 2*pi)", -1, 2),
        ("wrap(2*x)", -math.pi, math.pi),
        ("x % 5", 0, 5),
        ("abs(x) % 5", 0, 2),
        ("x % -3", -3, 0),
        ("atan2(x, 1)", math.atan2(-1, 1), math.atan2(2, 1)),
        ("atan2(1, x)", math.atan2(1, 2), math.atan2(1, -1)),
        ("atan2(x, -1)", -math.pi, math.pi),
        ("min(x, 1)", -1, 1),
        ("clip(x, 0, 1)", 0, 1),
        ("hypot(x, 3)", 3, math.hypot(2, 3)),
        ("x > 3", 0, 0),
        ("x < 3", 1, 1),
        ("x < 1", 0, 1),
        ("x == 5", 0, 0),
        ("where(x < 3, 1, 2)", 1, 1),
        ("where(x < 1, 1, 2)", 1, 2),
        ("x > 3 or x < 3", 1, 1),
        ("not x", 0, 1),
        ("exp(1000*x)", 0, INF),
    ],
)
def test_bounds_over_an_interval_are_the_range(text: str, low: float, high: float) -> None:
    found = bounds(parse(text), {"x": (-1.0, 2.0)})
    assert found == pytest.approx((low, high), rel=1e-12, abs=1e-12)
    assert found[0] <= low
    assert high <= found[1]


def test_a_value_that_may_be_nan_leaves_a_comparison_open() -> None:
    """sqrt(x) is at least 0 where it is a number; elsewhere no comparison but != holds."""
    assert bounds(parse("sqrt(x) >= 0"), {"x": (-1.0, 1.0)}) == (0.0, 1.0)
    assert bounds(parse("sqrt(x) >= 0"), {"x": (0.5, 1.0)}) == (1.0, 1.0)
    assert bounds(parse("where(sqrt(x), 1, 2)"), {"x": (-2.0, -1.0)}) == (1.0, 1.0)


@pytest.mark.parametrize("text", ["sqrt(x - 9)", "log(-x - 9)", "1 + asin(x + 9)", "(x - 9)**0.5"])
def test_what_is_a_number_nowhere_has_no_bounds(text: str) -> None:
    low, high = bounds(parse(text), {"x": (-1.0, 2.0)})
    assert math.isnan(low)
    assert math.isnan(high)

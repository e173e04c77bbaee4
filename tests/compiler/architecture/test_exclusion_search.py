"""Is there a point where a formula holds? Against all of finitely many, and known answers."""

import itertools
import math

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from compiler.architecture.exclusion.formula import both, denied, holds, truth
from compiler.architecture.exclusion.search import (
    Found,
    Nowhere,
    Open,
    Variable,
    round_between,
    solve,
)
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.parse import parse
from spec_schema.expressions.tree import Apply, Expr, Name, Number

WIDE = {"c": Variable(0.0, 2.0), "near": Variable(0.1, 1.0)}
UNIT_CUBE = {name: Variable(0.0, 1.0) for name in ("a", "b", "d", "e", "f", "g")}
PLANE = {"x": Variable(-3.0, 3.0), "y": Variable(-3.0, 3.0)}

EMPTY = [
    ("c < near", "c >= near", WIDE),
    ("c < near and near < 0.5", "c > 0.5", WIDE),
    ("a <= b and b < d", "d <= a", UNIT_CUBE),
    ("a < b and b <= d", "d <= a", UNIT_CUBE),
    ("c <= near", "c > near + 0.1", WIDE),
    ("c - near > 0", "c <= near", WIDE),
    ("not (c >= near or near >= 0.9)", "c >= near", WIDE),
    ("c < 0.3", "-c <= -0.3", WIDE),
    ("x**2 + y**2 < 1", "x + y > 1.5", PLANE),
    ("sin(x) > 0.5", "cos(x) > 0.9", PLANE),
    ("sqrt(x - 1) < 2", "x < 0.9", PLANE),
    ("x == 2 * y and y == 0.25", "x != 0.5", PLANE),
    ("a + b + d < 1", "a + b + d > 1.1 + e", UNIT_CUBE),
    ("a + b + d + e + f + g < 1", "a + 2 * b + d > 1.1 + e + f + b", UNIT_CUBE),
    ("where(x > 0, y, -y) < 0", "x > 0 and y > 0", PLANE),
    ("clip(c, 0.2, 1.5) < near", "min(c, 3) >= near", WIDE),
    ("abs(x) < y", "x > y", PLANE),
]
FULL = [
    ("c <= near", "c >= near", WIDE),
    ("c <= 0.3", "-c <= -0.3", WIDE),
    ("x**2 + y**2 < 1", "x + y > 1.4", PLANE),
    ("not sqrt(x - 1) < 2", "x < 0.9", PLANE),
    ("x == 2 * y + 1", "y == 0.25", PLANE),
    ("x >= 3", "y >= x", PLANE),
    ("c * 3 < 0.9", "c >= 0.3", WIDE),  # 3 * 0.3 is below 0.9, as doubles are multiplied
]


@pytest.mark.parametrize(("first", "second", "ranges"), EMPTY)
def test_conditions_that_exclude_each_other_are_proved_to(
    first: str, second: str, ranges: dict[str, Variable]
) -> None:
    assert isinstance(solve(both((truth(parse(first)), truth(parse(second)))), ranges), Nowhere)


@pytest.mark.parametrize(("first", "second", "ranges"), FULL)
def test_conditions_that_touch_or_overlap_are_refuted_with_a_point(
    first: str, second: str, ranges: dict[str, Variable]
) -> None:
    found = solve(both((truth(parse(first)), truth(parse(second)))), ranges)

    assert isinstance(found, Found)
    assert evaluate(parse(first), found.values) != 0.0
    assert evaluate(parse(second), found.values) != 0.0
    assert all(v.low <= found.values[name] <= v.high for name, v in ranges.items())


def test_what_the_budget_does_not_settle_is_left_open_with_a_box() -> None:
    formula = truth(parse("x*y < 1 and x*y*y > y - 1e-9 and x > 0.5 and y > 0.5 and x*x*y > x"))

    found = solve(formula, PLANE, 100)

    assert isinstance(found, Open)
    assert found.box.keys() == PLANE.keys()


names = st.sampled_from(["x", "y", "z"]).map(Name)
numbers = st.sampled_from([-1.0, 0.0, 0.5, 1.0, 3.0]).map(Number)
OPS = ("add", "sub", "mul", "div", "min", "max", "pow", "mod")
arithmetic = st.recursive(
    names | numbers,
    lambda inner: (
        st.builds(lambda op, a, b: Apply(op, (a, b)), st.sampled_from(OPS), inner, inner)
        | st.builds(lambda op, a: Apply(op, (a,)), st.sampled_from(("neg", "abs", "sqrt")), inner)
        | st.builds(lambda a, b, c: Apply("clip", (a, b, c)), inner, inner, inner)
    ),
    max_leaves=4,
)
COMPARED = ("lt", "le", "gt", "ge", "eq", "ne")
compared = st.builds(
    lambda op, a, b: Apply(op, (a, b)), st.sampled_from(COMPARED), arithmetic, arithmetic
)
logic = st.recursive(
    compared,
    lambda inner: (
        st.builds(lambda op, a, b: Apply(op, (a, b)), st.sampled_from(("and", "or")), inner, inner)
        | inner.map(lambda a: Apply("not", (a,)))
        | st.builds(lambda a, b, c: Apply("where", (a, b, c)), inner, inner, inner)
    ),
    max_leaves=5,
)
OPTIONS = (-2.0, 0.0, 0.5, 1.0)


ENOUGH = 100_000
"""Boxes, so that the search comes to its end: what clips clips takes more than the usual 2,000."""
NO_NUMBER = Apply("sqrt", (Number(-1.0),))


@settings(max_examples=80)
@given(logic)
@example(Apply("lt", (Name("x"), Apply("pow", (NO_NUMBER, Name("x"))))))  # nan**0 is 1
def test_over_finite_ranges_the_search_agrees_with_trying_every_point(expr: Expr) -> None:
    ranges = {name: Variable(OPTIONS[0], OPTIONS[-1], OPTIONS) for name in "xyz"}
    points = (dict(zip("xyz", at, strict=True)) for at in itertools.product(OPTIONS, repeat=3))
    exists = any(evaluate(expr, point) != 0.0 for point in points)

    found = solve(truth(expr), ranges, ENOUGH)

    assert isinstance(found, Found if exists else Nowhere)


@settings(max_examples=100)
@given(logic, st.tuples(*[st.floats(-3.0, 3.0)] * 3))
def test_a_formula_and_its_opposite_are_the_condition_and_its_opposite(
    expr: Expr, at: tuple[float, float, float]
) -> None:
    point = dict(zip("xyz", at, strict=True))
    is_true = evaluate(expr, point) != 0.0

    assert holds(truth(expr), point) == is_true
    assert holds(denied(truth(expr)), point) != is_true


@settings(max_examples=100)
@given(logic, st.lists(st.tuples(*[st.floats(-3.0, 3.0)] * 3), min_size=5, max_size=5))
def test_where_nothing_is_found_no_point_holds(
    expr: Expr, points: list[tuple[float, float, float]]
) -> None:
    ranges = {name: Variable(-3.0, 3.0) for name in "xyz"}
    found = solve(truth(expr), ranges, 200)

    if isinstance(found, Nowhere):
        for at in points:
            assert evaluate(expr, dict(zip("xyz", at, strict=True))) == 0.0
    if isinstance(found, Found):
        assert evaluate(expr, found.values) != 0.0


@example(low=4.3588004004246754e-308, size=0.0, unit=1.0)  # half of it is no double
@given(st.floats(-1e9, 1e9), st.floats(0.0, 1e9), st.sampled_from([1.0, 0.01, math.pi / 180.0]))
def test_a_round_number_lies_between(low: float, size: float, unit: float) -> None:
    assert low <= round_between(low, low + size, unit) <= low + size

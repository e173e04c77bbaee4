"""A formula split into c(controls) * t(states) is still the same formula."""

import math

import hypothesis.strategies as st
import pytest
from hypothesis import given

from compiler.terms import summands
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.parse import parse
from spec_schema.expressions.rewrite import names_in
from spec_schema.expressions.tree import Expr

CONTINUOUS = frozenset({"x", "y"})
LEAVES = st.sampled_from(["x", "y", "a", "b", "2", "0.5", "mode"])
FORMULAS = st.recursive(
    LEAVES,
    lambda inner: st.one_of(
        st.builds("({} + {})".format, inner, inner),
        st.builds("({} - {})".format, inner, inner),
        st.builds("({} * {})".format, inner, inner),
        st.builds("(-{})".format, inner),
        st.builds("sin({})".format, inner),
        st.builds("({})**2".format, inner),
        st.builds("({} / (2 + cos({})))".format, inner, inner),
    ),
    max_leaves=8,
)
NUMBERS = st.floats(-2.0, 2.0)


def total(expr: Expr, values: dict[str, float]) -> float:
    parts = summands(expr, CONTINUOUS, {"mode": 3})
    return sum(evaluate(s.coefficient, values) * evaluate(s.part, values) for s in parts)


@given(FORMULAS, NUMBERS, NUMBERS, NUMBERS, NUMBERS, st.integers(0, 2))
def test_the_summands_add_up_to_the_formula(
    text: str, x: float, y: float, a: float, b: float, mode: int
) -> None:
    expr = parse(text)
    values = {"x": x, "y": y, "a": a, "b": b, "mode": float(mode)}

    # Products may be summed in another order; terms of some 1e3 cancel to rounding of those.
    assert math.isclose(total(expr, values), evaluate(expr, values), rel_tol=1e-9, abs_tol=1e-8)


@given(FORMULAS)
def test_coefficients_read_no_continuous_state_and_parts_no_discrete_one(text: str) -> None:
    for summand in summands(parse(text), CONTINUOUS, {"mode": 3}):
        assert not names_in(summand.coefficient) & CONTINUOUS
        assert "mode" not in names_in(summand.part)


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("a * (1 - x**2) * y - x", {frozenset({"x", "y"}), frozenset({"x"})}),
        ("-a * (x - b) - b * y", {frozenset({"x"}), frozenset({"y"}), frozenset()}),
        ("sin(x - a)", {frozenset({"x", "a"})}),
        ("a * b", {frozenset()}),
        ("x + sin(x * y)", {frozenset({"x", "y"})}),
    ],
)
def test_controls_that_stand_in_factors_become_no_axes(
    text: str, parts: set[frozenset[str]]
) -> None:
    found = {names_in(s.part) for s in summands(parse(text), CONTINUOUS, {})}

    assert found == parts

"""Metres are not added to metres per second, and the fault stands at the operator."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from spec_schema.expressions.dimensions import dimension_of
from spec_schema.expressions.parse import parse
from spec_schema.units import DIMENSIONLESS, Dimension, describe, parse_unit

UNITS = {"x": "m", "y": "m", "v": "m/s", "a": "m/s^2", "k": "1/s", "q": "1", "theta": "deg"}
NAMES: dict[str, Dimension] = {name: parse_unit(unit).dimension for name, unit in UNITS.items()}


@pytest.mark.parametrize(
    ("text", "unit"),
    [
        ("v + k*x", "m/s"),
        ("v/x - k", "1/s"),
        ("x*x", "m^2"),
        ("x**2/v", "m*s"),
        ("x**-1", "1/m"),
        ("x**0.5*y**(1/2)", "m"),
        ("x**(2/3)", "m^(2/3)"),
        ("x**(3 - 1)", "m^2"),
        ("x**-(1)", "1/m"),
        ("sqrt(x*a)", "m/s"),
        ("hypot(x, y)", "m"),
        ("atan2(x, y)", "1"),
        ("sin(theta) + cos(k*x/v)", "1"),
        ("sign(v)*x", "m"),
        ("abs(-x)", "m"),
        ("x % y", "m"),
        ("x > 0 and v < 0", "1"),
        ("where(x > y, v, 0)", "m/s"),
        ("min(x, y, 0)", "m"),
        ("clip(v, 0, k*x)", "m/s"),
        ("q**q", "1"),
        ("2**q", "1"),
        ("0*x + v", "m/s"),
        ("unheard + x", "m"),
        ("wrap(theta + pi)", "1"),
    ],
)
def test_an_expression_has_this_unit(text: str, unit: str) -> None:
    dimension, faults = dimension_of(parse(text), NAMES)
    assert not faults
    assert dimension is not None
    assert describe(dimension) == unit


@pytest.mark.parametrize("text", ["0", "-0", "0*x", "where(x > y, 0, 0)", "unheard"])
def test_a_zero_and_the_unknown_fit_any_dimension(text: str) -> None:
    assert dimension_of(parse(text), NAMES) == (None, [])


@pytest.mark.parametrize(
    ("text", "at", "message", "advice"),
    [
        ("x + v", "+", "can't add m and m/s", "they differ by a factor in s"),
        ("v - x", "-", "can't subtract m from m/s", "they differ by a factor in 1/s"),
        ("x + 1", "+", "can't add m and a plain number",
         "a literal has no unit: name it under constants, with unit m"),
        ("1 < v", "<", "can't compare a plain number with m/s",
         "a literal has no unit: name it under constants, with unit m/s"),
        ("x == v", "==", "can't compare m with m/s", "they differ by a factor in s"),
        ("x % v", "%", "can't divide m by m/s and keep the rest", "they differ by a factor in s"),
        ("min(x, y, v)", "min", "min needs quantities of one unit, got m and m/s",
         "they differ by a factor in s"),
        ("atan2(x, v)", "atan2", "atan2 needs quantities of one unit, got m and m/s",
         "they differ by a factor in s"),
        ("where(q, x, v)", "where", "where needs two values of one unit, got m and m/s",
         "they differ by a factor in s"),
        ("where(x, 1, 2)", "where", "where needs a condition, got m",
         "divide it by a quantity in m"),
        ("sin(x)", "sin", "sin needs a number without unit, got m", "divide it by a quantity in m"),
        ("exp(k)", "exp", "exp needs a number without unit, got 1/s",
         "divide it by a quantity in 1/s"),
        ("x and q", "and", "a condition has no unit, got m", "divide it by a quantity in m"),
        ("2**x", "**", "an exponent has no unit, got m", "divide it by a quantity in m"),
        ("x**q", "**", "the exponent of a quantity in m must be a number",
         "divide the base by a quantity in m first"),
    ],
)  # fmt: skip
def test_a_fault_stands_at_its_operator(text: str, at: str, message: str, advice: str) -> None:
    dimension, (fault,) = dimension_of(parse(text), NAMES)
    assert dimension is None
    assert (text[fault.start : fault.end], fault.message, fault.help) == (at, message, advice)


@pytest.mark.parametrize(
    ("text", "places"),
    [
        ("(x + v)*(v + a)", [3, 11]),
        ("sin(x) + cos(v)", [0, 9]),
        ("x < v < a", [2, 6]),
        ("(x + v) + k", [3]),
        ("sin(x + v)", [6]),
        ("(x + v)**(y + v)", [3, 12]),
    ],
)
def test_each_mistake_is_told_once(text: str, places: list[int]) -> None:
    _, faults = dimension_of(parse(text), NAMES)
    assert [fault.start for fault in faults] == places


EXPONENTS = st.fractions(-3, 3, max_denominator=4)
DIMENSIONS = st.tuples(*[EXPONENTS] * 7)


@given(DIMENSIONS, DIMENSIONS, st.integers(-3, 3))
def test_dimensions_multiply_as_quantities_do(a: Dimension, b: Dimension, n: int) -> None:
    names = {"a": a, "b": b}
    product, _ = dimension_of(parse("a*b"), names)
    assert product is not None
    assert dimension_of(parse("a*b/b"), names)[0] == a
    assert dimension_of(parse("b*a"), names)[0] == product
    assert dimension_of(parse(f"(a*b)**{n}"), names) == dimension_of(parse(f"a**{n}*b**{n}"), names)
    assert dimension_of(parse("sqrt(a*a)"), names)[0] == a


def test_no_dimension_is_seven_zeros() -> None:
    assert (Fraction(0),) * 7 == DIMENSIONLESS

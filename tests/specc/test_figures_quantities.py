"""Numbers as people read them."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.program import Unit
from specc.figures.quantities import (
    axis_label,
    multiple_of_pi,
    number,
    percent,
    quantity,
    rate_of,
    seconds,
)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (2.0, "2"),
        (-0.5, "−0.5"),
        (1234.5678, "1235"),
        (0.0123456, "0.0123"),
        (-0.000123456, "−1.23×10⁻⁴"),
        (1e7, "1×10⁷"),
        (0.99999, "1"),
        (math.inf, "∞"),
        (-math.inf, "−∞"),
        (math.nan, "–"),
    ],
)
def test_numbers_have_three_digits(value: float, text: str) -> None:
    assert number(value) == text


@given(st.floats(-1e12, 1e12))
def test_a_number_reads_back_to_three_digits(value: float) -> None:
    superscripts = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹−", "-0123456789-")
    plain = number(value).replace("×10", "e").translate(superscripts)

    assert float(plain) == pytest.approx(value, rel=6e-3)


def test_quantities_are_in_the_users_unit() -> None:
    assert quantity(0.05, Unit("cm", 0.01)) == "5 cm"
    assert quantity(0.5, Unit("1", 1.0)) == "0.5"
    assert quantity(math.pi / 6.0, Unit("deg", math.pi / 180.0)) == "30 deg"


def test_labels_say_the_unit_where_there_is_one() -> None:
    assert axis_label("x", Unit("m", 1.0)) == "x [m]"
    assert axis_label("mu", Unit("1", 1.0)) == "mu"
    assert rate_of("x") == "dx/dt"
    assert rate_of("speed") == "d speed/dt"


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0, "0"), (math.pi, "π"), (-math.pi / 2.0, "−π/2"), (0.75 * math.pi, "3π/4")],
)
def test_angles_are_multiples_of_pi(value: float, text: str) -> None:
    assert multiple_of_pi(value) == text


def test_durations_and_shares_are_short() -> None:
    assert seconds(0.4) == "0.4 s"
    assert seconds(125.0) == "2 min 5 s"
    assert percent(0.999) == "99 %"
    assert percent(1.0) == "100 %"

"""First crossings and passages against closed forms and known periods."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.code import Code
from runtime.flow import flow_of
from tests.runtime.behaviors import formula_program, state, van_der_pol
from tests.runtime.crossings import first_crossing, first_passage
from tests.runtime.hybrids import GRAVITY, bouncing_ball, patrol

PERIOD = 6.66328686
"""Of van der Pol's oscillator at mu = 1, to 9 digits."""
OSCILLATOR = formula_program(
    (state("x", -9.0, 9.0), state("y", -9.0, 9.0)), {"x": "y neg", "y": "x"}
)
NONE = np.zeros(0)


@given(st.floats(0.01, 8.9), st.floats(0.001, 2.0 * math.pi - 0.001))
@settings(max_examples=40, deadline=None)
def test_a_circle_crosses_its_section_when_the_angle_says_so(radius: float, phase: float) -> None:
    x0 = np.array([[radius * math.cos(phase), radius * math.sin(phase)]])
    up = first_crossing(flow_of(OSCILLATOR), x0, NONE, Code("y"), 10.0)
    down = first_crossing(flow_of(OSCILLATOR), x0, NONE, Code("y"), 10.0, rising=False)
    back = first_crossing(flow_of(OSCILLATOR), x0, NONE, Code("y"), -10.0, rising=False)

    assert up.times[0] == pytest.approx(2.0 * math.pi - phase, abs=1e-8)
    np.testing.assert_allclose(up.states[0], [radius, 0.0], atol=1e-8 * radius + 1e-11)
    assert up.states[0, 1] >= 0.0
    assert down.times[0] == pytest.approx((math.pi - phase) % (2.0 * math.pi), abs=1e-8)
    assert back.times[0] == pytest.approx(-phase, abs=1e-8)


def test_a_return_map_finds_the_period_of_van_der_pol() -> None:
    flow, x = flow_of(van_der_pol()), np.array([[2.0, 0.0]])
    for _ in range(8):
        found = first_crossing(flow, x, np.ones(1), Code("v neg"), 20.0, after=0.01)
        x = found.states

    assert found.times[0] == pytest.approx(PERIOD, abs=2e-8)
    back = first_crossing(flow, x, np.ones(1), Code("v"), -20.0, after=-0.01)
    # Backwards the cycle repels, by exp(7) a turn.
    assert back.times[0] == pytest.approx(-PERIOD, abs=1e-5)


def test_where_nothing_is_crossed_there_is_no_number() -> None:
    flow = flow_of(OSCILLATOR)
    x0 = np.array([[1.0, -1.0], [8.0, 8.0], [np.nan, 0.0], [1.0, 0.0]])

    found = first_crossing(flow, x0, NONE, Code("y 1.2 sub"), 6.0)

    # The first crosses; the second leaves its domain; the last stays below 1.
    assert np.isfinite(found.times).tolist() == [True, False, False, False]
    assert np.isnan(found.states[1:]).all()
    with pytest.raises(ValueError, match="boom"):
        first_crossing(flow, x0, NONE, Code("boom"), 6.0)


def test_a_section_is_crossed_in_later_modes_too_and_before_a_guard_of_the_same_place() -> None:
    flow, x0 = flow_of(patrol()), np.array([[0.0, 0.5, 0.0]])
    u = np.array([1.0, -1.0, 0.5, 0.25])

    home = first_crossing(flow, x0, u, Code("x neg"), 50.0, after=1.0)
    turn = first_crossing(flow, x0, u, Code("x x1 sub"), 50.0)

    assert home.times[0] == pytest.approx(2.0 + 4.0, rel=1e-11)
    np.testing.assert_allclose(home.states[0], [0.0, -0.25, 1.0], atol=1e-12)
    np.testing.assert_allclose(turn.states[0], [1.0, 0.5, 0.0], rtol=1e-12)


def test_a_passage_ends_after_its_jump() -> None:
    flow, x0 = flow_of(patrol()), np.array([[0.0, 0.5, 0.0], [0.5, 0.5, 0.0]])
    u = np.array([1.0, -1.0, 0.5, 0.25])

    there = first_passage(flow, x0, u, 0, 50.0)
    home = first_passage(flow, x0, u, 1, 50.0)

    np.testing.assert_allclose(there.times, [2.0, 1.0], rtol=1e-11)
    np.testing.assert_allclose(there.states, [[1.0, -0.25, 1.0]] * 2, rtol=1e-12)
    np.testing.assert_allclose(home.times, [10.0, 9.0], rtol=1e-11)
    again = first_passage(flow, home.states, u, 1, 50.0)
    np.testing.assert_allclose(again.times, 12.0, rtol=1e-11)


def test_the_speed_of_a_ball_shrinks_by_e_from_bounce_to_bounce() -> None:
    flow, e = flow_of(bouncing_ball()), np.array([0.7])
    x = np.array([[5.0, 0.0, 0.0]])
    speeds = []
    for _ in range(5):
        x = first_passage(flow, x, e, 0, 50.0).states
        speeds.append(x[0, 1])

    first = 0.7 * math.sqrt(2.0 * GRAVITY * 5.0)
    np.testing.assert_allclose(speeds, first * 0.7 ** np.arange(5.0), rtol=1e-9)

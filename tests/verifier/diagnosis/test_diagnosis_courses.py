"""Inputs as functions of time."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from verifier.diagnosis.courses import Course, means

TIMES = np.array([0.0, 1.0, 2.5, 4.0])
VALUES = np.array([1.0, -2.0, 0.5, 3.0])


def held(times: np.ndarray) -> np.ndarray:
    return VALUES[np.clip(np.searchsorted(TIMES, times, side="right") - 1, 0, None)]


@settings(deadline=None)
@given(st.lists(st.floats(-2.0, 7.0), min_size=2, max_size=6, unique=True), st.floats(-1.5, 1.5))
def test_a_mean_is_the_integral_of_the_held_values(knots: list[float], shift: float) -> None:
    times = np.sort(knots)
    fine = np.linspace(0.0, 1.0, 4001)[:-1] + 0.5 / 4000.0

    found = means(Course(TIMES, VALUES, shift), times)

    for low, high, mean in zip(times[:-1], times[1:], found, strict=True):
        at = low + (high - low) * fine - shift
        wanted = np.mean(held(at))
        # A jump falls within one of 4000 pieces: at most 5 / 4000 for each of 3 jumps.
        assert mean == pytest.approx(wanted, abs=4e-3) or high - low < 1e-9


def test_a_step_of_no_length_has_a_finite_mean() -> None:
    assert np.isfinite(means(Course(TIMES, VALUES), np.array([1.0, 1.0, 2.0]))).all()


def test_a_lag_answers_a_step_as_an_exponential() -> None:
    times = np.arange(0.0, 10.0, 0.05)
    step = Course(times, (times >= 2.0 - 1e-9).astype(float), lag=0.8)
    knots = np.array([4.0, 4.001])

    found = means(step, knots)

    assert found[0] == pytest.approx(1.0 - np.exp(-2.0 / 0.8), abs=2e-3)


def test_an_endless_constant_stays_itself_through_delay_and_lag() -> None:
    course = Course(TIMES, np.full(4, 0.7), shift=0.3, lag=0.4)

    assert means(course, np.linspace(-1.0, 6.0, 9)) == pytest.approx(np.full(8, 0.7))

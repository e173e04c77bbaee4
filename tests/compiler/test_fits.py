"""Curve fitting over arrows: exact where it can be, else an average, or refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from compiler.compile import Compiled, compile_loaded
from compiler.dump import dump
from compiler.fitted import least_squares
from compiler.scattered import SketchError
from runtime.flow import flow_of, rates
from spec_schema.diagnostics import SpecError
from spec_schema.load import load_source
from spec_schema.source import Source

LOW, HIGH = np.array([-1.0, -2.0]), np.array([1.0, 2.0])
FLAT = (False, False)
HEAD = """specc: 1
kind: behavior
name: fitted
state:
  x: {unit: cm, domain: [-200, 200], role: both, relates: {agent: base, environment: room}}
  y: {unit: m, domain: [-2, 2], role: both, relates: {agent: base, environment: room}}
field:
  arrows:
    over: [x, y]
    fill: least_squares
"""


def compiled(rest: str) -> Compiled:
    return compile_loaded(load_source(Source("spec.yaml", HEAD + rest)), lambda *_: None)


@given(st.lists(st.floats(-2, 2), min_size=6, max_size=6), st.integers(0, 1_000))
@settings(max_examples=40, deadline=None)
def test_a_quadratic_field_comes_back_exactly(numbers: list[float], seed: int) -> None:
    at = np.random.default_rng(seed).uniform(LOW, HIGH, (30, 2))

    def field(p: np.ndarray) -> np.ndarray:
        x, y = p.T
        a, b, c, d, e, f = numbers
        return np.stack([a + b * x + c * y, d * x * y + e * y**2 + f * x**2], axis=-1)

    fit = least_squares(at, field(at), np.ones(30), LOW, HIGH, FLAT, 2)

    corners = np.array([[-1.0, -2.0], [1.0, 2.0], [0.3, -1.7]])
    np.testing.assert_allclose(fit(corners), field(corners), atol=1e-9)


def test_a_straight_line_is_that_of_the_closed_formula() -> None:
    rng = np.random.default_rng(3)
    x, w = rng.uniform(-1, 1, 20), rng.uniform(0.5, 4, 20)
    y = 2.0 - 0.7 * x + rng.normal(0, 0.2, 20)
    mean_x, mean_y = np.average(x, weights=w), np.average(y, weights=w)
    slope = np.sum(w * (x - mean_x) * (y - mean_y)) / np.sum(w * (x - mean_x) ** 2)

    fit = least_squares(x[:, None], y[:, None], w, LOW[:1], HIGH[:1], (False,), 1)

    found = fit(np.array([[-1.0], [1.0]]))[:, 0]
    assert found == pytest.approx([mean_y + slope * (end - mean_x) for end in (-1, 1)], abs=1e-12)


def test_noise_is_averaged_away() -> None:
    rng = np.random.default_rng(5)
    at = rng.uniform(LOW, HIGH, (900, 2))
    go = at @ np.array([[-1.0], [0.5]]) + rng.normal(0, 0.3, (900, 1))

    fit = least_squares(at, go, np.ones(900), LOW, HIGH, FLAT, 1)

    middle = np.array([[0.0, 0.0], [0.5, 1.0]])
    assert np.abs(fit(middle)[:, 0] - middle @ [-1.0, 0.5]).max() < 4 * 0.3 * np.sqrt(3 / 900)


def test_the_misfit_is_square_to_every_function_of_the_fit() -> None:
    rng = np.random.default_rng(8)
    at, go, w = rng.uniform(LOW, HIGH, (25, 2)), rng.normal(size=(25, 1)), rng.uniform(1, 3, 25)

    misfit = go - least_squares(at, go, w, LOW, HIGH, FLAT, 2)(at)

    x, y = at.T
    for function in (1 + 0 * x, x, y, x * x, x * y, y * y):
        assert np.sum(w * function * misfit[:, 0]) == pytest.approx(0.0, abs=1e-10)


def test_along_an_angle_a_wave_comes_back_and_meets_itself() -> None:
    low, high = np.array([-np.pi, 0.0]), np.array([np.pi, 1.0])
    at = np.random.default_rng(2).uniform(low, high, (40, 2))
    go = np.sin(2 * at[:, :1] + 0.4) + at[:, 1:]

    fit = least_squares(at, go, np.ones(40), low, high, (True, False), 2)

    ends = fit(np.array([[-np.pi, 0.3], [np.pi, 0.3]]))[:, 0]
    assert ends == pytest.approx([np.sin(0.4) + 0.3] * 2, abs=1e-10)


def test_the_degree_is_the_highest_that_the_arrows_determine_well() -> None:
    rng = np.random.default_rng(4)
    for count, degree in ((3, 1), (11, 1), (12, 2), (19, 2), (20, 3), (200, 3)):
        at = rng.uniform(LOW, HIGH, (count, 2))
        fit = least_squares(at, at, np.ones(count), LOW, HIGH, FLAT, None)
        assert fit.degree == degree


@pytest.mark.parametrize(
    ("at", "degree"),
    [
        ([[-1.0, 0.0], [1.0, 1.0]], None),
        ([[-1.0, -1.0], [0.0, 0.0], [1.0, 1.0], [0.5, 0.5]], 1),
        ([[-1.0, 0.0], [-1.0, 1.0], [1.0, 0.0], [1.0, 1.0], [1.0, 2.0], [-1.0, 2.0]], 2),
    ],
)
def test_arrows_that_leave_the_surface_open_are_refused(
    at: list[list[float]], degree: int | None
) -> None:
    places = np.array(at)

    with pytest.raises(SketchError, match="surface of degree"):
        least_squares(places, places, np.ones(len(at)), LOW, HIGH, FLAT, degree)


def test_a_fit_is_compiled_and_says_how_far_off_it_is_and_where() -> None:
    made = compiled(
        "    degree: 1\n"
        "    sketch:\n"
        "      - {at: [-200, -2], go: [40, 0]}\n"
        "      - {at: [200, -2], go: [-40, 0]}\n"
        "      - {at: [-200, 2], go: [40, 0.1]}\n"
        "      - {at: [200, 2], go: [-40, 0.1]}\n"
        "      - {at: [0, 0], go: [5, 0.05]}\n"
    )

    found = rates(flow_of(made.program), np.array([[1.0, 1.0]]), np.zeros((1, 0)))[0]

    assert found == pytest.approx([-0.2 + 0.01, 0.075], abs=1e-6)  # the mean of the five is 1 cm/s
    assert "3 numbers for each rate" in made.notes[0]
    assert "at most 4 at the arrow in spec.yaml:17" in made.notes[1]
    assert "2 cm/s on average" in made.notes[1]
    assert dump(made.program, made.notes).splitlines()[-3:] == [f"  {n}" for n in made.notes]


def test_what_the_arrows_cannot_tell_is_refused_with_the_degree_that_they_can() -> None:
    arrows = "".join(
        f"      - {{at: [{x}, {y}], go: [1, 1]}}\n" for x in (-9, 3, 9) for y in (-2, 0, 2)
    )

    with pytest.raises(SpecError, match="S234") as raised:
        compiled(f"    degree: 5\n    sketch:\n{arrows}")

    assert "at least 21 arrows, or write 'degree: 2'" in str(raised.value)

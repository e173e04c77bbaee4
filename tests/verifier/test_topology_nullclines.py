"""Nullclines with every branch, against curves known in closed form."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from runtime.arrays import Array
from runtime.program import Program
from tests.verifier.topology_scenes import plane, tabulated
from verifier.topology.features import Grid
from verifier.topology.lines.nullclines import find_nullclines
from verifier.topology.slices import cut, rates_at


def lines(program: Program, count: int = 129) -> tuple[Array, ...]:
    """The branches on which x does not move."""
    view = cut(program, None, {})
    nodes = tuple(np.linspace(axis.low, axis.high, count) for axis in view.axes)
    rates = rates_at(view, np.stack(np.meshgrid(*nodes, indexing="ij"), axis=-1))
    return next((n.lines for n in find_nullclines(view, Grid(nodes, rates)) if n.of == "x"), ())


def length(line: Array) -> float:
    return float(np.linalg.norm(np.diff(line, axis=0), axis=-1).sum())


def test_branches_that_cross_go_straight_through_one_another() -> None:
    found = lines(plane("x y mul", "y neg"))

    assert [length(line) for line in found] == pytest.approx([4.0, 4.0])
    for line in found:
        assert np.abs(line).min(axis=1) == pytest.approx(np.zeros(len(line)), abs=1e-9)
        assert np.hypot(*line.T).min() == pytest.approx(0.0, abs=1e-9)


@given(
    a=st.floats(-1.5, 1.5),
    b=st.floats(-1.5, 1.5),
    turn=st.floats(0.0, math.pi),
    k=st.floats(0.4, 2.5),
)
@example(a=0.0, b=-1.304850494604815, turn=1.0, k=1.0)  # 1e-5 beside an edge of the grid
@settings(max_examples=25, deadline=None)
def test_two_lines_that_cross_anywhere_meet_there(
    a: float, b: float, turn: float, k: float
) -> None:
    # The product of two lines through (a, b), at directions `turn` and `turn + k`.
    factors = [
        f"x {a!r} sub {-math.sin(way)!r} mul y {b!r} sub {math.cos(way)!r} mul add"
        for way in (turn, turn + k)
    ]
    found = lines(plane(f"{factors[0]} {factors[1]} mul", "y neg"))

    nearest = min(float(np.hypot(*(line - [a, b]).T).min()) for line in found)
    assert nearest < 1e-6
    total = sum(length(line) for line in found)
    expected = sum(chord(a, b, way) for way in (turn, turn + k))
    assert total == pytest.approx(expected, abs=0.05)


def chord(a: float, b: float, way: float) -> float:
    """How long the line through (a, b) in this direction is within [-2, 2]²."""
    ends = []
    for sign in (1.0, -1.0):
        steps = []
        for at, part in ((a, sign * math.cos(way)), (b, sign * math.sin(way))):
            if abs(part) > 1e-12:
                steps.append(((2.0 if part > 0 else -2.0) - at) / part)
        ends.append(min(steps))
    return sum(ends)


def test_a_circle_that_the_rate_only_touches_is_one_closed_line() -> None:
    (circle,) = lines(plane("x x mul y y mul add 1 sub 2 pow", "y neg"))

    assert np.hypot(*circle.T) == pytest.approx(np.ones(len(circle)), abs=1e-7)
    assert length(circle) == pytest.approx(2.0 * math.pi, rel=1e-3)
    assert circle[0] == pytest.approx(circle[-1])


@pytest.mark.parametrize("power", [2, 3, 4])
def test_a_line_of_any_order_is_one_line(power: int) -> None:
    (line,) = lines(plane(f"x 0.3 sub {power} pow", "y neg"))

    assert line[:, 0] == pytest.approx(np.full(len(line), 0.3), abs=1e-3)
    assert length(line) == pytest.approx(4.0, abs=1e-3)


def test_one_branch_touches_where_another_crosses() -> None:
    found = lines(plane("x x mul y mul", "y neg"))

    assert sorted(length(line) for line in found) == pytest.approx([4.0, 4.0])


def test_an_area_of_zeros_is_shown_by_its_border() -> None:
    left, right = lines(plane("x abs 0.5 sub 0 max x sign mul", "y neg"))

    assert left[:, 0] == pytest.approx(np.full(len(left), -0.5))
    assert right[:, 0] == pytest.approx(np.full(len(right), 0.5))


def test_a_kink_that_comes_down_to_zero_is_a_line() -> None:
    (line,) = lines(plane("x y 0.37 mul sub abs", "y neg"))

    assert line[:, 0] == pytest.approx(0.37 * line[:, 1], abs=1e-9)


def test_a_line_on_the_border_of_the_domain_is_seen() -> None:
    (line,) = lines(plane("x 2 add", "y neg"))

    assert line[:, 0] == pytest.approx(np.full(len(line), -2.0))
    assert length(line) == pytest.approx(4.0)


def test_the_lemniscate_goes_through_its_crossing() -> None:
    # (x² + y²)² = 2 (x² - y²): its length is 5.2441 times sqrt(2) (Bernoulli).
    found = lines(plane("x x mul y y mul add 2 pow 2 x x mul y y mul sub mul sub", "y neg"), 257)

    assert sum(map(length, found)) == pytest.approx(5.24411510858424 * math.sqrt(2.0), abs=0.02)


def test_what_comes_near_zero_is_no_line() -> None:
    for gap in ("1e-3", "1e-5", "1e-7"):
        assert lines(plane(f"x x mul {gap} add", "y neg")) == ()


def test_a_table_shows_a_touching_line_within_its_error() -> None:
    found = lines(tabulated(plane("x y y mul sub 2 pow", "y neg"), 65, 1e-4))

    points = np.concatenate(found)
    assert points[:, 0] == pytest.approx(points[:, 1] ** 2, abs=5e-3)
    assert np.ptp(points[:, 1]) > 2.5


@pytest.mark.parametrize(
    ("rate", "at"), [("20 x mul sinh 1 sub", math.asinh(1.0) / 20.0), ("x 700 mul exp 1 sub", 0.0)]
)
def test_a_nullcline_is_where_it_is_although_the_rate_is_huge_elsewhere(
    rate: str, at: float
) -> None:
    [line] = lines(plane(rate, "y neg"))

    assert line[:, 0] == pytest.approx(at, abs=1e-5)

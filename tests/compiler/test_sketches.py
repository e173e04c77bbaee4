"""Fields from arrows and arrays: they pass through what was given, and end where it ends."""

import numpy as np
import pytest
from scipy.interpolate import RectBivariateSpline

from compiler.lattice import between_nodes, closed, is_even
from compiler.scattered import SketchError, piecewise_linear, reaches_beyond, thin_plate
from runtime.table import Method

LOW, HIGH = np.array([-1.0, -2.0]), np.array([1.0, 2.0])
RNG = np.random.default_rng(7)
AT = RNG.uniform(LOW, HIGH, (14, 2))
GO = RNG.normal(size=(14, 2))


@pytest.mark.parametrize(
    "fill", [thin_plate(AT, GO, LOW, HIGH, (False, False)), piecewise_linear(AT, GO)]
)
def test_a_fill_passes_through_every_arrow(fill: object) -> None:
    np.testing.assert_allclose(fill(AT), GO, atol=1e-9)  # type: ignore[operator]


@pytest.mark.parametrize("fill", ["plate", "linear"])
def test_a_linear_field_is_reproduced_between_the_arrows(fill: str) -> None:
    slope = np.array([[1.0, -2.0], [0.5, 3.0]])
    go = AT @ slope + 1.0
    sample = (
        thin_plate(AT, go, LOW, HIGH, (False, False))
        if fill == "plate"
        else piecewise_linear(AT, go)
    )
    inside = AT[:5] * 0.3 + AT[5:10] * 0.7

    np.testing.assert_allclose(sample(inside), inside @ slope + 1.0, atol=1e-9)


def test_beyond_the_hull_a_linear_fill_keeps_the_value_on_the_hull() -> None:
    at = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
    sample = piecewise_linear(at, at)

    np.testing.assert_allclose(sample(np.array([[0.9, 0.0]])), [[0.5, 0.0]], atol=1e-9)


def test_a_sketch_that_ends_before_the_domain_is_told() -> None:
    corners = np.array([[-1.0, -2.0], [1.0, -2.0], [1.0, 2.0], [-1.0, 2.0], [0.0, 0.0]])

    assert reaches_beyond(corners, LOW, HIGH) is None
    assert reaches_beyond(corners * [0.5, 1.0], LOW, HIGH) == 0
    assert reaches_beyond(corners[1:], LOW, HIGH) == 0


@pytest.mark.parametrize(
    "at", [[[0.0, 0.0], [1.0, 1.0]], [[0.0, 0.0], [0.5, 0.5], [1.0, 1.0]], [[0.0, 0.0]] * 3]
)
def test_too_few_arrows_on_a_line_or_twice_at_a_point_are_refused(at: list[list[float]]) -> None:
    places = np.array(at)

    with pytest.raises(SketchError):
        thin_plate(places, np.ones((len(places), 1)), LOW, HIGH, (False, False))


def test_an_array_with_uneven_nodes_agrees_with_an_independent_spline() -> None:
    x, y = np.array([0.0, 0.2, 0.5, 0.9, 1.0]), np.array([-1.0, -0.3, 0.1, 0.6, 1.0])
    values = RNG.normal(size=(5, 5, 1))
    peer = RectBivariateSpline(x, y, values[..., 0], kx=3, ky=3, s=0)
    points = RNG.uniform([0.0, -1.0], [1.0, 1.0], (50, 2))

    found = between_nodes((x, y), values, Method.CUBIC, (False, False))(points)

    np.testing.assert_allclose(
        found[:, 0], peer(points[:, 0], points[:, 1], grid=False), atol=1e-10
    )


def test_even_nodes_are_told_from_uneven_ones() -> None:
    assert is_even(np.linspace(-1.0, 1.0, 9), -1.0, 1.0, periodic=False)
    assert not is_even(np.array([-1.0, 0.1, 1.0]), -1.0, 1.0, periodic=False)
    assert is_even(np.linspace(-1.0, 1.0, 8, endpoint=False), -1.0, 1.0, periodic=True)


def test_a_sketch_over_an_angle_meets_itself() -> None:
    low, high = np.array([-np.pi, 0.0]), np.array([np.pi, 1.0])
    at = RNG.uniform(low, high, (12, 2))
    sample = thin_plate(at, RNG.normal(size=(12, 1)), low, high, (True, False))
    ends = np.array([[-np.pi, 0.4], [np.pi, 0.4]])

    lower, upper = sample(ends)[:, 0]

    assert upper == pytest.approx(lower, abs=1e-9)


def test_uneven_nodes_on_an_angle_give_a_periodic_field() -> None:
    at = np.array([0.0, 0.5, 1.7, 3.0, 4.4, 5.5])
    values = np.sin(at)[:, None]
    nodes, closed_values = closed((at,), values, (True,), (2.0 * np.pi,))
    sample = between_nodes(nodes, closed_values, Method.CUBIC, (True,))

    np.testing.assert_allclose(sample(at[:, None]), values, atol=1e-12)
    step = 1e-6
    edges = sample(np.array([[0.0], [step], [2.0 * np.pi - step], [2.0 * np.pi]]))[:, 0]
    assert edges[1] - edges[0] == pytest.approx(edges[3] - edges[2], rel=1e-3)

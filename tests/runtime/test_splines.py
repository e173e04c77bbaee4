"""Spline coefficients held against scipy's: another method, another author."""

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.interpolate import CubicSpline, NdBSpline, RegularGridInterpolator, make_interp_spline

from runtime import splines
from runtime.arrays import Array
from runtime.interpolation import lookup, lookup_jacobian, tabulate
from runtime.table import Axis, Method


def random_walk(n: int, m: int) -> Array:
    return np.random.default_rng(n).normal(size=(n, m)).cumsum(axis=0)


@pytest.mark.parametrize("n", [4, 5, 6, 7, 20, 301])
def test_the_ends_are_not_a_knot(n: int) -> None:
    axis = Axis("x", -2.0, 3.0, n, periodic=False)
    values = random_walk(n, 3)
    nodes = np.linspace(-2.0, 3.0, n)
    x = np.linspace(-2.0, 3.0, 1001)
    table = tabulate(values, (axis,), Method.CUBIC)

    for reference in (
        CubicSpline(nodes, values, bc_type="not-a-knot"),
        make_interp_spline(nodes, values, k=3),
    ):
        scale = np.abs(values).max()
        assert lookup(table, x[:, None]) == pytest.approx(reference(x), abs=1e-12 * scale)
        slopes = lookup_jacobian(table, x[:, None])[..., 0]
        assert slopes == pytest.approx(reference(x, 1), abs=1e-11 * scale / axis.step)


@pytest.mark.parametrize("n", [4, 5, 6, 7, 20, 301])
def test_a_periodic_axis_has_a_periodic_spline(n: int) -> None:
    axis = Axis("x", -2.0, 3.0, n, periodic=True)
    values = random_walk(n, 3)
    nodes = np.linspace(-2.0, 3.0, n + 1)
    x = np.linspace(-2.0, 3.0, 1001)
    table = tabulate(values, (axis,), Method.CUBIC)
    closed = np.concatenate([values, values[:1]])
    reference = CubicSpline(nodes, closed, bc_type="periodic")

    scale = np.abs(values).max()
    assert lookup(table, x[:, None]) == pytest.approx(reference(x), abs=1e-12 * scale)
    slopes = lookup_jacobian(table, x[:, None])[..., 0]
    assert slopes == pytest.approx(reference(x, 1), abs=1e-11 * scale / axis.step)


@pytest.mark.parametrize("d", [1, 2, 3, 4, 5])
def test_a_tensor_spline_is_scipys(d: int) -> None:
    rng = np.random.default_rng(d)
    counts = (9, 8, 7, 6, 5)[:d]
    axes = tuple(Axis(f"x{i}", 0.0, 1.0 + i, n, periodic=False) for i, n in enumerate(counts))
    nodes = [np.linspace(axis.low, axis.high, axis.count) for axis in axes]
    values = rng.normal(size=(*counts, 2))
    points = rng.uniform(size=(200, d)) * [axis.high for axis in axes]
    knots, coefficients = [], values
    for i, line in enumerate(nodes):
        spline = make_interp_spline(line, np.moveaxis(coefficients, i, 0), k=3)
        coefficients = np.moveaxis(spline.c, 0, i)
        knots.append(spline.t)
    reference = NdBSpline(tuple(knots), coefficients, 3)
    table = tabulate(values, axes, Method.CUBIC)

    assert lookup(table, points) == pytest.approx(reference(points), abs=1e-12)
    for i in range(d):
        slopes = lookup_jacobian(table, points)[..., i]
        expected = reference(points, nu=[int(i == a) for a in range(d)])
        assert slopes == pytest.approx(expected, abs=1e-10)


@pytest.mark.parametrize("d", [1, 2, 3, 4, 5])
def test_the_linear_is_scipys(d: int) -> None:
    rng = np.random.default_rng(d)
    counts = (9, 8, 7, 6, 2)[:d]
    axes = tuple(Axis(f"x{i}", 0.0, 1.0 + i, n, periodic=False) for i, n in enumerate(counts))
    nodes = [np.linspace(axis.low, axis.high, axis.count) for axis in axes]
    values = rng.normal(size=(*counts, 3))
    points = rng.uniform(size=(200, d)) * [axis.high for axis in axes]
    reference = RegularGridInterpolator(nodes, values)

    found = lookup(tabulate(values, axes, Method.LINEAR), points)
    assert found == pytest.approx(reference(points), abs=1e-13)


@pytest.mark.parametrize("n", [4, 5, 9])
def test_coefficients_of_a_cubic_have_no_fourth_difference(n: int) -> None:
    cubic = Polynomial([1.0, -2.0, 0.5, 3.0])

    coefficients = splines.not_a_knot(cubic(np.arange(float(n)))[:, None])

    # to rounding of the largest coefficient, some 3 n**3
    assert np.diff(coefficients, 4, axis=0) == pytest.approx(0.0, abs=1e-15 * 48 * n**3)


def test_the_error_of_a_smooth_function_falls_with_the_fourth_power_up_to_the_edge() -> None:
    errors = []
    for n in (33, 65):
        axis = Axis("x", 0.0, 1.0, n, periodic=False)
        nodes = np.linspace(0.0, 1.0, n)
        x = np.linspace(0.0, 1.0, 5001)[:, None]
        found = lookup(tabulate(np.exp(2.0 * nodes)[:, None], (axis,), Method.CUBIC), x)
        errors.append(np.abs(found - np.exp(2.0 * x)).max())

    assert 14.0 < errors[0] / errors[1] < 18.0

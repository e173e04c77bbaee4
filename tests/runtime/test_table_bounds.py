"""Bounds of tables against exact rational arithmetic, and against the table's own look-ups."""

from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from runtime.arrays import Array
from runtime.interpolation import lookup, lookup_jacobian, tabulate
from runtime.intervals import Interval, exactly
from runtime.jets import SURE, Jet
from runtime.table import Axis, Method, Table
from runtime.table_bounds import column_jets, columns_of, combined, held_at

METHODS = [Method.LINEAR, Method.CUBIC]


def random_table(rng: np.random.Generator, axes: tuple[Axis, ...], method: Method) -> Table:
    shape = tuple(axis.count for axis in axes)
    return tabulate(rng.standard_normal((*shape, 2)), axes, method)


def random_axes(rng: np.random.Generator, d: int) -> tuple[Axis, ...]:
    return tuple(
        Axis(f"a{i}", float(rng.uniform(-3, 0)), float(rng.uniform(0.5, 2)), 4 + i, bool(i % 2))
        for i in range(d)
    )


def box_jets(low: Array, high: Array) -> list[Jet]:
    """Jets of the coordinates of boxes low to high (N, d)."""
    n, d = low.shape
    return [
        Jet(
            Interval(low[:, j], high[:, j]),
            exactly(np.repeat(np.eye(d)[:, j : j + 1], n, axis=1)),
            SURE,
        )
        for j in range(d)
    ]


def exact_basis(method: Method, t: Fraction) -> list[Fraction]:
    s = 1 - t
    if method is Method.LINEAR:
        return [s, t]
    inner = [Fraction(2, 3) - v * v + v * v * v / 2 for v in (t, s)]
    return [s**3 / 6, *inner, t**3 / 6]


def exact_value(table: Table, point: Array, column: int) -> Fraction:
    """The table in rational arithmetic: no rounding at all."""
    weights, cells = [], []
    for axis, at in zip(table.axes, point, strict=True):
        count = axis.count if axis.periodic else axis.count - 1
        low, high = Fraction(axis.low), Fraction(axis.high)
        u = (Fraction(float(at)) - low) * count / (high - low)
        if axis.periodic:
            u %= count
        cell = min(max(u.__floor__(), 0), count - 1)
        weights.append(exact_basis(table.method, u - cell))
        cells.append(cell)
    total = Fraction(0)
    for taps in product(*(range(len(w)) for w in weights)):
        place = tuple(c + k for c, k in zip(cells, taps, strict=True))
        part = Fraction(float(table.coefficients[(*place, column)]))
        for w, k in zip(weights, taps, strict=True):
            part *= w[k]
        total += part
    return total


@pytest.mark.parametrize("method", METHODS)
@given(
    seed=st.integers(0, 10**6), d=st.integers(1, 3), size=st.sampled_from([0.0, 1e-15, 1e-9, 0.3])
)
@example(seed=2646, d=1, size=0.3)  # it ends 1.1 cells beyond the table, of which nothing is said
@settings(max_examples=40, deadline=None)
def test_the_exact_value_lies_in_the_bounds_of_every_box_around_it(
    method: Method, seed: int, d: int, size: float
) -> None:
    rng = np.random.default_rng(seed)
    table = random_table(rng, random_axes(rng, d), method)
    low = np.array([rng.uniform(axis.low, axis.high) for axis in table.axes])
    nodes = np.array([axis.low + axis.step for axis in table.axes])
    corner = np.where(rng.random(d) < 0.4, nodes, low)
    high = corner + size

    jets = column_jets(columns_of(table), box_jets(corner[None], high[None]), 1, coarse=False)

    for column, jet in enumerate(jets):
        ends = float(jet.value.low[0]), float(jet.value.high[0])
        assert np.all(np.isfinite(ends)) == np.all(jet.sure)
        for point in (corner, np.minimum(high, [axis.high for axis in table.axes])):
            value = exact_value(table, np.maximum(point, corner), column)
            assert ends[0] <= value <= ends[1]


@pytest.mark.parametrize("coarse", [False, True])
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("d", [1, 2, 3, 4])
def test_values_and_slopes_between_points_lie_in_the_bounds(
    d: int,
    method: Method,
    coarse: bool,  # noqa: FBT001 - a case
) -> None:
    rng = np.random.default_rng(d)
    table = random_table(rng, random_axes(rng, d), method)
    span = np.array([axis.high - axis.low for axis in table.axes])
    base = np.array([axis.low for axis in table.axes])
    low = base + span * rng.random((60, d)) * 0.9
    high = low + span * rng.choice([1e-6, 0.02, 0.1, 0.9], (60, d))
    high = np.where([a.periodic for a in table.axes], high, np.minimum(high, base + span))
    jets = column_jets(columns_of(table), box_jets(low, high), 60, coarse=coarse)

    for _ in range(20):
        points = low + rng.random((60, d)) * (high - low)
        values, slopes = lookup(table, points), lookup_jacobian(table, points)
        for column, jet in enumerate(jets):
            assert np.all(jet.value.low <= values[:, column] + 1e-12)
            assert np.all(jet.value.high >= values[:, column] - 1e-12)
            assert jet.slopes is not None
            assert np.all(slopes[:, column] + 1e-10 >= jet.slopes.low.T)
            assert np.all(slopes[:, column] - 1e-10 <= jet.slopes.high.T)


def test_bounds_close_in_on_the_value_with_the_square_of_the_box() -> None:
    rng = np.random.default_rng(5)
    table = random_table(rng, random_axes(rng, 2), Method.CUBIC)
    at = np.array([[0.11, 0.23]])
    gaps = []
    for size in (1e-2, 1e-3):
        points = at + size * rng.random((4000, 2))
        values = lookup(table, points)[:, 0]
        (jet, _) = column_jets(columns_of(table), box_jets(at, at + size), 1, coarse=False)
        gaps.append(float(jet.value.high[0] - jet.value.low[0] - np.ptp(values)) / size)

    assert 0.0 <= gaps[1] < 0.3 * gaps[0] + 0.05


def test_a_box_over_more_than_a_turn_sees_the_whole_axis() -> None:
    axis = Axis("angle", 0.0, 4.0, 4, periodic=True)
    table = tabulate(np.array([[0.0], [5.0], [0.0], [-3.0]]), (axis,), Method.LINEAR)

    (jet,) = column_jets(
        columns_of(table), box_jets(np.array([[3.25]]), np.array([[7.9]])), 1, coarse=False
    )

    assert jet.value.low[0] <= -3.0
    assert jet.value.high[0] >= 5.0


@pytest.mark.parametrize("method", METHODS)
def test_a_still_axis_is_contracted_with_its_rounding(method: Method) -> None:
    rng = np.random.default_rng(9)
    table = random_table(rng, random_axes(rng, 3), method)
    point = np.array([0.1, -0.7, 0.2])

    flat = held_at(held_at(columns_of(table), 2, 0.2), 0, 0.1)
    (jet, _) = column_jets(flat, box_jets(point[None, 1:2], point[None, 1:2]), 1, coarse=False)

    value = exact_value(table, point, 0)
    assert Fraction(float(jet.value.low[0])) <= value <= Fraction(float(jet.value.high[0]))
    assert jet.value.high[0] - jet.value.low[0] < 1e-13 * np.abs(table.coefficients).max()


def test_sums_of_columns_are_bounded_as_sums() -> None:
    # Each column is large, their difference is small: bounds of the parts would not show it.
    axis = Axis("x", 0.0, 1.0, 9, periodic=False)
    nodes = np.linspace(0.0, 1.0, 9)
    table = tabulate(np.stack([1e3 * nodes, 1e3 * nodes + 1e-3], axis=-1), (axis,), Method.CUBIC)

    difference = combined(columns_of(table), exactly(np.array([[-1.0, 1.0]])))
    (jet,) = column_jets(difference, box_jets(np.zeros((1, 1)), np.ones((1, 1))), 1, coarse=False)

    assert jet.value.low[0] == pytest.approx(1e-3, abs=1e-9)
    assert jet.value.high[0] == pytest.approx(1e-3, abs=1e-9)


def test_far_outside_its_axes_nothing_is_said_of_a_table() -> None:
    axis = Axis("x", 0.0, 1.0, 9, periodic=False)
    table = tabulate(np.ones((9, 1)), (axis,), Method.CUBIC)

    (jet,) = column_jets(
        columns_of(table), box_jets(np.full((1, 1), 2.0), np.full((1, 1), 3.0)), 1, coarse=False
    )

    assert not np.all(jet.sure)
    assert (jet.value.low[0], jet.value.high[0]) == (-np.inf, np.inf)

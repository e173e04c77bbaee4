"""Tables against the functions they stand for, on points that nobody chose nodes by."""

import numpy as np
import pytest

from compiler.ranges import Range
from compiler.tabulate import TableError, Wanted, tabulate_function
from runtime.arrays import Array
from runtime.interpolation import lookup
from runtime.table import Method

LINE = Range("x", -1.0, 1.0, periodic=False)
SQUARE = (LINE, Range("y", 0.0, 3.0, periodic=False))


def wanted(function: object, ranges: tuple[Range, ...], tolerance: float, **more: object) -> Wanted:
    method = more.get("method", Method.CUBIC)
    budget = more.get("budget", 2**26)
    return Wanted(function, ranges, np.array([tolerance]), method, budget)  # type: ignore[arg-type]  # tests vary them


def ripple(points: Array) -> Array:
    return np.sin(3.0 * points[:, :1]) * np.exp(-points[:, 1:2])


@pytest.mark.parametrize("method", list(Method))
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
def test_the_measured_bound_holds_on_a_denser_independent_sample(
    method: Method, tolerance: float
) -> None:
    made = tabulate_function(wanted(ripple, SQUARE, tolerance, method=method))
    count = 10 * made.table.coefficients.size
    points = np.random.default_rng(1).uniform([-1.0, 0.0], [1.0, 3.0], (count, 2))

    error = np.abs(lookup(made.table, points) - ripple(points)).max()

    assert error <= made.error[0] <= tolerance


def test_a_polynomial_of_degree_three_needs_few_nodes_and_is_exact() -> None:
    def cubic(points: Array) -> Array:
        return points[:, :1] ** 3 - 2.0 * points[:, :1]

    made = tabulate_function(wanted(cubic, (LINE,), 1e-9))

    assert made.table.axes[0].count == 5
    assert made.error[0] < 1e-14


def test_the_same_function_gives_the_same_bytes() -> None:
    first, second = (tabulate_function(wanted(ripple, SQUARE, 1e-3)).table for _ in range(2))

    assert first.coefficients.tobytes() == second.coefficients.tobytes()


def test_only_the_axis_that_needs_nodes_gets_them() -> None:
    def along_x(points: Array) -> Array:
        return np.sin(20.0 * points[:, :1]) + points[:, 1:2]

    axes = tabulate_function(wanted(along_x, SQUARE, 1e-4)).table.axes

    assert axes[0].count > 50
    assert axes[1].count == 5


@pytest.mark.parametrize(
    ("function", "code", "axis"),
    [
        (lambda p: np.sign(p[:, :1] - 0.31), "S242", "x"),
        (lambda p: np.sqrt(p[:, :1]), "S243", None),
        (lambda p: np.sin(3000.0 * p[:, :1]), "S241", "x"),
    ],
)
def test_what_cannot_be_tabulated_is_refused_with_the_axis(
    function: object, code: str, axis: str | None
) -> None:
    with np.errstate(invalid="ignore"), pytest.raises(TableError) as caught:
        tabulate_function(wanted(function, (LINE,), 1e-6, budget=2**14))

    assert (caught.value.code, caught.value.axis) == (code, axis)

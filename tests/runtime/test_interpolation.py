"""Laws of tables: what they reproduce, where they end, and that batches do not matter."""
# ruff: noqa: FBT001 - parameters of tests

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.arrays import Array
from runtime.interpolation import grid_of, lookup, lookup_into, lookup_jacobian, tabulate
from runtime.kernels.interpolate import block_address, lookup_lanes, lookup_points
from runtime.table import Axis, Method, Table

COUNTS = (6, 5, 7, 4, 5)


def axes_of(d: int, periodic: tuple[bool, ...] = (False,) * 5) -> tuple[Axis, ...]:
    return tuple(
        Axis(f"x{i}", -1.0 - i, 2.0 + 0.5 * i, COUNTS[i], periodic=periodic[i]) for i in range(d)
    )


def nodes_of(axes: tuple[Axis, ...]) -> Array:
    lines = [axis.low + axis.step * np.arange(axis.count) for axis in axes]
    return np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1)


def points_of(axes: tuple[Axis, ...], count: int, rng: np.random.Generator) -> Array:
    return np.stack([rng.uniform(axis.low, axis.high, count) for axis in axes], axis=-1)


def random_table(d: int, m: int, method: Method, seed: int = 0) -> Table:
    """Random values; every second axis is periodic."""
    axes = axes_of(d, (False, True, False, True, False))
    shape = (*(axis.count for axis in axes), m)
    return tabulate(np.random.default_rng(seed).normal(size=shape), axes, method)


every_size = pytest.mark.parametrize(("d", "m"), list(product(range(1, 6), (1, 2, 3, 4, 5, 7))))
every_method = pytest.mark.parametrize("method", list(Method))


@every_method
@every_size
def test_a_table_takes_its_values_at_the_nodes(d: int, m: int, method: Method) -> None:
    axes = axes_of(d, (True, False, True, False, True))
    nodes = nodes_of(axes)
    values = np.random.default_rng(m).normal(size=(*nodes.shape[:-1], m))

    assert lookup(tabulate(values, axes, method), nodes) == pytest.approx(values, abs=1e-13)


@given(st.integers(1, 5), st.integers(1, 5), st.integers(0, 2**32 - 1))
@settings(max_examples=40, deadline=None)
def test_the_cubic_reproduces_polynomials_of_degree_three_per_axis(
    d: int, m: int, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    axes = axes_of(d)
    factors = rng.uniform(-1, 1, size=(m, d, 4))
    table = tabulate(polynomial(factors, nodes_of(axes)), axes, Method.CUBIC)
    points = points_of(axes, 50, rng)
    expected = polynomial(factors, points)

    assert lookup(table, points) == pytest.approx(expected, abs=1e-13 * np.abs(expected).max() * 8)


@given(st.integers(1, 5), st.integers(1, 5), st.integers(0, 2**32 - 1))
@settings(max_examples=40, deadline=None)
def test_the_linear_reproduces_multilinear_functions(d: int, m: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    axes = axes_of(d)
    factors = rng.uniform(-1, 1, size=(m, d, 2))
    table = tabulate(polynomial(factors, nodes_of(axes)), axes, Method.LINEAR)
    points = points_of(axes, 50, rng)

    expected = polynomial(factors, points)
    assert lookup(table, points) == pytest.approx(expected, abs=1e-14 * np.abs(expected).max() * 8)


def polynomial(factors: Array, x: Array) -> Array:
    """Products (..., m) over the axes of polynomials with coefficients (m, d, degree + 1)."""
    powers = x[..., None] ** np.arange(factors.shape[-1])
    return np.einsum("...dp,mdp->...dm", powers, factors).prod(axis=-2)


@every_method
@every_size
def test_a_point_has_the_same_bits_alone_and_in_any_batch(d: int, m: int, method: Method) -> None:
    rng = np.random.default_rng(d)
    table = random_table(d, m, method)
    points = points_of(table.axes, 301, rng)
    order = rng.permutation(len(points))

    together = lookup(table, points)

    alone = np.concatenate([lookup(table, point)[None] for point in points])
    assert np.array_equal(together, alone)
    assert np.array_equal(together[order], lookup(table, points[order]))
    assert np.array_equal(together[7:], lookup(table, points[7:]))


@every_method
@pytest.mark.parametrize("d", range(1, 6))
def test_a_column_has_the_same_bits_whatever_stands_beside_it(d: int, method: Method) -> None:
    axes = axes_of(d)
    values = np.random.default_rng(3).normal(size=(*(axis.count for axis in axes), 7))
    points = points_of(axes, 100, np.random.default_rng(4))
    alone = lookup(tabulate(values[..., 3:4], axes, method), points)[:, 0]

    for first, after in product(range(4), range(4, 8)):
        beside = lookup(tabulate(values[..., first:after], axes, method), points)
        assert np.array_equal(beside[:, 3 - first], alone)


def lookup_in_lanes(table: Table, points: Array, lanes: int, offset: int) -> Array:
    """(m, lanes) by the lookup that integrators use; -1 in lanes that are not used."""
    (used, d), m = points.shape, table.coefficients.shape[-1]
    grid = grid_of(table.axes, table.method)
    flat = np.concatenate([np.full(offset, np.nan), table.coefficients.reshape(-1)])
    flat.setflags(write=False)
    across = np.zeros((d, lanes))
    across[:, :used] = points.T
    out = np.full((m, lanes), -1.0)
    arrays = grid.counts, grid.lows, grid.inverse_steps, grid.periodic, flat
    cubic = table.method is Method.CUBIC
    lookup_lanes(block_address(), cubic, d, m, *arrays, offset, across, used, out)
    return out


@every_method
@every_size
def test_lanes_have_the_bits_of_the_lookup(d: int, m: int, method: Method) -> None:
    table = random_table(d, m, method)
    points = points_of(table.axes, 77, np.random.default_rng(2))

    out = lookup_in_lanes(table, points, lanes=80, offset=5)

    assert np.array_equal(out[:, :77].T, lookup(table, points))
    assert (out[:, 77:] == -1.0).all()


@pytest.mark.parametrize("d", range(1, 6))
def test_in_lanes_the_polynomials_of_the_edge_go_on_outside(d: int) -> None:
    rng = np.random.default_rng(d)
    axes = axes_of(d)
    factors = rng.uniform(-1, 1, size=(2, d, 4))
    table = tabulate(polynomial(factors, nodes_of(axes)), axes, Method.CUBIC)
    widths = np.array([axis.high - axis.low for axis in axes])
    points = points_of(axes, 70, rng) + widths * rng.integers(-1, 2, size=(70, d))

    expected = polynomial(factors, points)

    found = lookup_in_lanes(table, points, lanes=70, offset=0).T
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-12 * np.abs(expected).max())


@every_method
@pytest.mark.parametrize("d", range(1, 6))
def test_the_edge_is_inside_and_the_next_number_is_not(d: int, method: Method) -> None:
    axes = axes_of(d)
    table = tabulate(nodes_of(axes).sum(axis=-1, keepdims=True), axes, method)
    middle = np.array([0.5 * (axis.low + axis.high) for axis in axes])
    for i, axis in enumerate(axes):
        for edge, beyond in ((axis.low, -np.inf), (axis.high, np.inf)):
            point = middle.copy()
            point[i] = edge
            assert lookup(table, point) == pytest.approx([point.sum()], abs=1e-13)
            point[i] = np.nextafter(edge, beyond)
            assert np.isnan(lookup(table, point)).all()
            assert np.isnan(lookup_jacobian(table, point)).all()


@every_method
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("d", range(1, 6))
def test_what_is_not_finite_gives_nan_on_every_axis(d: int, method: Method, bad: float) -> None:
    table = random_table(d, 3, method)
    for i in range(d):
        points = points_of(table.axes, 9, np.random.default_rng(0))
        points[4, i] = bad

        values, slopes = lookup(table, points), lookup_jacobian(table, points)

        assert np.isnan(values[4]).all()
        assert np.isnan(slopes[4]).all()
        assert np.isfinite(np.delete(values, 4, axis=0)).all()
        assert np.isfinite(np.delete(slopes, 4, axis=0)).all()


@every_method
@given(turns=st.integers(-1000, 1000), at=st.floats(-np.pi, np.pi))
@settings(max_examples=50, deadline=None)
def test_a_periodic_axis_wraps(method: Method, turns: int, at: float) -> None:
    axis = Axis("angle", -np.pi, np.pi, 24, periodic=True)
    angles = axis.low + axis.step * np.arange(axis.count)
    table = tabulate(np.sin(angles)[:, None], (axis,), method)

    assert lookup(table, [at + turns * 2 * np.pi]) == pytest.approx(lookup(table, [at]), abs=4e-12)


@every_method
@pytest.mark.parametrize("far", [1e15, -1e17, 1e300, -1.7e308, np.nextafter(0.0, -1.0), -1e-17])
def test_a_periodic_axis_wraps_any_finite_number(method: Method, far: float) -> None:
    table = tabulate([[1.0], [3.0], [2.0], [0.0]], (Axis("a", 0.0, 1.0, 4, periodic=True),), method)
    expected = lookup(table, [np.fmod(far, 1.0)])

    assert lookup(table, [far]) == pytest.approx(expected, abs=1e-12)


@every_method
def test_a_periodic_table_meets_itself_at_the_ends(method: Method) -> None:
    table = random_table(2, 2, method)
    axis = table.axes[1]

    low, high = lookup(table, [[0.3, axis.low], [0.3, axis.high]])

    assert low == pytest.approx(high, abs=1e-13)


def test_the_cubic_has_two_continuous_derivatives() -> None:
    table = random_table(2, 2, Method.CUBIC)
    step = 1e-5
    node = table.axes[0].low + 2 * table.axes[0].step
    slopes = lookup_jacobian(table, [[node + k * step, 0.1] for k in (-2, -1, 0, 1, 2)])[..., 0]

    second = np.diff(slopes, axis=0) / step
    assert second[0] == pytest.approx(second[-1], abs=1e-3)  # a jump would be of order one
    assert slopes[1] == pytest.approx(slopes[3], abs=1e-3)


@every_method
@every_size
def test_the_jacobian_is_the_slope_of_the_lookup(d: int, m: int, method: Method) -> None:
    table = random_table(d, m, method)
    rng = np.random.default_rng(5)
    # linear: within a cell; the difference over 1e-4 of a cubic piece has an error below 1e-6
    inside = np.array([axis.low + axis.step * 1.5 for axis in table.axes])
    width = np.array([axis.step * 0.4 for axis in table.axes])
    points = inside + width * rng.uniform(-1, 1, size=(20, d))
    step = 1e-4 * np.eye(d)

    forward = lookup(table, points[:, None, :] + step)
    backward = lookup(table, points[:, None, :] - step)

    differences = np.swapaxes(forward - backward, -1, -2) / 2e-4
    assert lookup_jacobian(table, points) == pytest.approx(differences, abs=2e-7)


@pytest.mark.parametrize("shape", [(), (0,), (3,), (2, 0, 3), (2, 3)])
def test_leading_shapes_are_kept(shape: tuple[int, ...]) -> None:
    table = random_table(3, 2, Method.CUBIC)
    points = np.zeros((*shape, 3))

    assert lookup(table, points).shape == (*shape, 2)
    assert lookup_jacobian(table, points).shape == (*shape, 2, 3)


def test_a_mapped_table_needs_no_second_compilation(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    table = random_table(2, 2, Method.CUBIC)
    path = tmp_path_factory.mktemp("table") / "coefficients.npy"
    np.save(path, table.coefficients)
    mapped = Table(table.axes, table.method, np.load(path, mmap_mode="r"))
    points = points_of(table.axes, 10, np.random.default_rng(0))
    points.setflags(write=False)

    assert np.array_equal(lookup(mapped, points), lookup(table, points.copy()))
    assert len(lookup_points.signatures) == 1


def test_coefficients_lie_in_memory_as_kernels_read_them() -> None:
    coefficients = random_table(3, 2, Method.CUBIC).coefficients

    assert coefficients.flags.c_contiguous
    assert not coefficients.flags.writeable


def test_a_result_can_go_where_there_is_memory() -> None:
    table = random_table(2, 3, Method.CUBIC)
    points = points_of(table.axes, 20, np.random.default_rng(0))
    out = np.empty((4, 5, 3))

    lookup_into(table, points, out)

    assert np.array_equal(out.reshape(20, 3), lookup(table, points))
    for unfit in (np.empty((20, 2)), np.empty((19, 3)), np.empty((3, 20)).T, np.empty(60)):
        with pytest.raises(ValueError, match="needs 3 contiguous numbers for each of 20 points"):
            lookup_into(table, points, unfit)


def test_a_table_is_a_copy() -> None:
    values = np.zeros((4, 1))
    table = tabulate(values, (Axis("x", 0.0, 1.0, 4, periodic=False),), Method.LINEAR)
    values[:] = 1.0

    assert lookup(table, [0.5]) == 0.0


@pytest.mark.parametrize(
    ("counts", "periodic", "method", "message"),
    [
        ((3,), False, Method.CUBIC, "a cubic table needs at least 4 nodes along 'x0' .got 3."),
        ((3,), True, Method.CUBIC, "a cubic table needs at least 4 nodes along 'x0' .got 3."),
        ((1,), False, Method.LINEAR, "a linear table needs at least 2 nodes along 'x0' .got 1."),
        ((1,), True, Method.LINEAR, "a linear table needs at least 2 nodes along 'x0' .got 1."),
        ((2,) * 6, False, Method.LINEAR, "a table has 1 to 5 axes .got 6."),
        ((), False, Method.LINEAR, "a table has 1 to 5 axes .got 0."),
    ],
)
def test_what_cannot_be_a_table_is_refused(
    counts: tuple[int, ...], periodic: bool, method: Method, message: str
) -> None:
    axes = tuple(Axis(f"x{i}", 0.0, 1.0, n, periodic=periodic) for i, n in enumerate(counts))

    with pytest.raises(ValueError, match=message):
        tabulate(np.zeros((*counts, 1)), axes, method)


def test_values_must_fit_their_axes_and_be_finite() -> None:
    axes = (Axis("x", 0.0, 1.0, 4, periodic=False),)

    with pytest.raises(ValueError, match="must have the shape"):
        tabulate(np.zeros((5, 1)), axes, Method.LINEAR)
    with pytest.raises(ValueError, match="must be finite"):
        tabulate([[0.0], [1.0], [np.nan], [2.0]], axes, Method.LINEAR)
    with pytest.raises(ValueError, match="points need 1 coordinates each"):
        lookup(tabulate(np.zeros((4, 1)), axes, Method.LINEAR), np.zeros((3, 2)))

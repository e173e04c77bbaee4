"""Tables: a vector-valued function tabulated over a regular grid, and read between its nodes.

Linear, or C² cubic B-splines with not-a-knot ends (a periodic axis has a periodic spline). Outside
its domain a table has no value: NaN, never an extrapolation. A point on the edge is inside. A
periodic axis has no outside; it wraps. d: axes, 1 to 5; m: columns, the components of the value.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from runtime import splines
from runtime.arrays import Array, Booleans, Integers, frozen
from runtime.kernels.interpolate import block_address, jacobian_points, lookup_points
from runtime.table import Axis, Method, Table

MAXIMUM_AXES = 5


class Grid(NamedTuple):
    """The axes of a table as the kernels read them; arrays (d,).

    counts: coefficients per axis; periodic axes have no meaningful high.
    """

    counts: Integers
    lows: Array
    highs: Array
    inverse_steps: Array
    periodic: Booleans


def tabulate(values: npt.ArrayLike, axes: tuple[Axis, ...], method: Method) -> Table:
    """The table that takes `values` (n1, ..., nd, m) at the nodes of the axes.

    Raises:
        ValueError: the axes, their counts or the values cannot make a table.
    """
    nodes = np.asarray(values, dtype=np.float64)
    _require_axes(axes, method)
    counts = tuple(axis.count for axis in axes)
    if nodes.ndim != len(axes) + 1 or nodes.shape[:-1] != counts or nodes.shape[-1] < 1:
        raise ValueError(
            f"values must have the shape {(*counts, 'columns')} of the axes (got {nodes.shape})"
        )
    if not np.isfinite(nodes).all():
        raise ValueError("values of a table must be finite")
    for position, axis in enumerate(axes):
        first = np.moveaxis(nodes, position, 0)
        nodes = np.moveaxis(_coefficients(first, axis, method), 0, position)
    return Table(axes, method, frozen(np.ascontiguousarray(nodes)))


def lookup(table: Table, points: npt.ArrayLike) -> Array:
    """The table's value (..., m) at points (..., d); NaN outside the domain or at a NaN.

    A point has the same bits whatever the other points are.
    """
    flat, leading = _flat(table, points)
    out = np.empty((*leading, table.coefficients.shape[-1]))
    lookup_into(table, flat, out)
    return out


def lookup_into(table: Table, points: npt.ArrayLike, out: Array) -> None:
    """Write what `lookup` gives to `out`, contiguous, so that a loop need not ask for memory.

    Raises:
        ValueError: `out` has not the right size, or is not contiguous.
    """
    flat, _ = _flat(table, points)
    m = table.coefficients.shape[-1]
    if out.size != len(flat) * m or out.shape[-1] != m or not out.flags.c_contiguous:
        raise ValueError(
            f"the result needs {m} contiguous numbers for each of {len(flat)} points "
            f"(got the shape {out.shape})"
        )
    lookup_points(
        block_address(),
        table.method is Method.CUBIC,
        *grid_of(table.axes, table.method),
        _read_only(table.coefficients.reshape(-1)),
        flat,
        out.reshape(-1, m),
    )


def lookup_jacobian(table: Table, points: npt.ArrayLike) -> Array:
    """The derivatives (..., m, d) of the value by the coordinates; NaN where `lookup` is.

    At a node of a linear table it is the derivative in the cell to the right (at the last node, to
    the left).
    """
    flat, leading = _flat(table, points)
    m = table.coefficients.shape[-1]
    out = np.empty((len(flat), m, len(table.axes)))
    jacobian_points(
        block_address(),
        table.method is Method.CUBIC,
        *grid_of(table.axes, table.method),
        _read_only(table.coefficients.reshape(-1)),
        flat,
        out,
    )
    return out.reshape(*leading, m, len(table.axes))


@lru_cache(maxsize=256)
def grid_of(axes: tuple[Axis, ...], method: Method) -> Grid:
    """The axes of a table as the kernels read them."""
    extra = {Method.LINEAR: (0, 1), Method.CUBIC: (2, 3)}[method]
    counts = np.array([axis.count + extra[axis.periodic] for axis in axes], dtype=np.int64)
    grid = Grid(
        counts,
        np.array([axis.low for axis in axes]),
        np.array([axis.high for axis in axes]),
        np.array([1.0 / axis.step for axis in axes]),
        np.array([axis.periodic for axis in axes]),
    )
    for array in grid:
        array.setflags(write=False)
    return grid


def _coefficients(values: Array, axis: Axis, method: Method) -> Array:
    """Coefficients along the first axis."""
    match method, axis.periodic:
        case Method.LINEAR, False:
            return values
        case Method.LINEAR, True:
            return np.concatenate([values, values[:1]])
        case _, False:
            return splines.not_a_knot(values)
        case _:
            return splines.periodic(values)


def _require_axes(axes: tuple[Axis, ...], method: Method) -> None:
    if not 1 <= len(axes) <= MAXIMUM_AXES:
        raise ValueError(f"a table has 1 to {MAXIMUM_AXES} axes (got {len(axes)})")
    least = splines.MINIMUM_NODES if method is Method.CUBIC else 2
    for axis in axes:
        if axis.count < least:
            raise ValueError(
                f"a {method} table needs at least {least} nodes along '{axis.name}' "
                f"(got {axis.count})"
            )
        if not (np.isfinite(axis.low) and np.isfinite(axis.high) and axis.low < axis.high):
            raise ValueError(
                f"the domain of '{axis.name}' must be finite and not empty "
                f"(got {axis.low} to {axis.high})"
            )


def _flat(table: Table, points: npt.ArrayLike) -> tuple[Array, tuple[int, ...]]:
    """Points as kernels read them, (N, d), and their leading shape."""
    at = np.asarray(points, dtype=np.float64, order="C")
    d = len(table.axes)
    if at.ndim == 0 or at.shape[-1] != d:
        raise ValueError(f"points need {d} coordinates each (got the shape {at.shape})")
    return _read_only(at.reshape(-1, d)), at.shape[:-1]


def _read_only(view: Array) -> Array:
    """The same numbers, not writeable, as mapped ones are: kernels are compiled for these alone."""
    same = np.asarray(view).view()
    same.setflags(write=False)
    return same

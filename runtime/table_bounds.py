"""Bounds of a table's columns and of their derivatives over boxes.

What is proved is proved of the *real* table: the B-splines with the stored coefficients, worked out
without rounding. Axes that stand still are contracted once; what that rounds away is kept as an
`error` of every coefficient, and added outward. N: boxes; d: axes; k: columns.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.intervals import Interval, add, chosen, exactly, multiply, outward, whole
from runtime.jets import Jet, constant
from runtime.kernels.cells import EPSILON, ROUNDINGS, enclose_cells
from runtime.table import Axis, Method, Table
from runtime.tape import read_only_integers, read_only_view

CELL: Final = 4.0 * EPSILON
"""Relative error of a coordinate in cells: five roundings (Axis.step, its inverse, this)."""

FARTHEST: Final = 1.0
"""Cells beyond a table's edge to which its end cells are continued; farther out nothing is said."""

LONGEST: Final = 2.0**30
"""Cells from the seam up to which a coordinate of a periodic axis has a meaning."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Columns:
    """Some columns over the axes of a table that move: coefficients (k1, ..., kd, k).

    error: (k,) what each coefficient may be off by.
    """

    axes: tuple[Axis, ...]
    method: Method
    coefficients: Array
    error: Array


def columns_of(table: Table) -> Columns:
    """All columns of a table, as they are stored."""
    return Columns(
        table.axes, table.method, table.coefficients, np.zeros(table.coefficients.shape[-1])
    )


def held_at(columns: Columns, axis: int, value: float) -> Columns:
    """The columns where one axis stands still at `value`."""
    along = columns.axes[axis]
    u = (value - along.low) / along.step
    taps = 4 if columns.method is Method.CUBIC else 2
    cells = columns.coefficients.shape[axis] - taps + 1
    if along.periodic:
        u -= np.floor(u / cells) * cells
    cell = int(np.clip(np.floor(u), 0, cells - 1))
    weights = _weights(columns.method, u - cell)
    taken = np.moveaxis(columns.coefficients, axis, 0)[cell : cell + taps]
    largest = _per_column(np.abs(taken))
    rise = _per_column(np.abs(np.diff(taken, axis=0)))
    off = 2.0 * CELL * (abs(u) + 1.0)
    grown = float(np.sum(np.abs(weights)))
    error = columns.error * grown * (1.0 + CELL) + 2.0 * off * rise
    error += ROUNDINGS * EPSILON * grown * largest
    return Columns(
        tuple(a for i, a in enumerate(columns.axes) if i != axis),
        columns.method,
        np.tensordot(weights, taken, axes=1),
        error,
    )


def combined(columns: Columns, factors: Interval) -> Columns:
    """Sums of columns, one per row of `factors` (rows, k); what they vary by goes into `spread`."""
    middle = 0.5 * (factors.low + factors.high)
    size = np.abs(middle)
    largest = _per_column(np.abs(columns.coefficients))
    terms = size.shape[1] + 2.0
    return replace(
        columns,
        coefficients=np.ascontiguousarray(columns.coefficients @ middle.T),
        error=(size @ (columns.error + terms * EPSILON * largest)) * (1.0 + terms * EPSILON),
    )


def column_jets(
    columns: Columns, arguments: Sequence[Jet], boxes: int, *, coarse: bool
) -> list[Jet]:
    """The columns where the axes have the jets `arguments`."""
    if not columns.axes:
        return [_still(c, e) for c, e in zip(columns.coefficients, columns.error, strict=True)]
    with np.errstate(all="ignore"):
        low, high, outside = _in_cells(columns, [a.value for a in arguments], boxes)
        moves = any(a.slopes is not None for a in arguments)
        value, slopes = _bounds(columns, low, high, moves=moves, coarse=coarse)
        value = chosen(outside[:, None], whole(()), value)
        sure = ~outside & np.logical_and.reduce([np.broadcast_to(a.sure, boxes) for a in arguments])
        return [
            Jet(
                Interval(value.low[:, k], value.high[:, k]),
                _chained(columns, arguments, slopes, k, outside) if moves else None,
                np.asarray(sure),
            )
            for k in range(len(columns.error))
        ]


def _still(value: float, error: float) -> Jet:
    return constant(outward(np.asarray(value - error), np.asarray(value + error)))


def _per_column(sizes: Array) -> Array:
    flat = sizes.reshape(-1, sizes.shape[-1])
    return np.asarray(flat.max(axis=0)) if len(flat) else np.zeros(sizes.shape[-1])


def _weights(method: Method, t: float) -> Array:
    s = 1.0 - t
    if method is Method.LINEAR:
        return np.array([s, t])
    inner = (0.5 * t - 1.0) * t * t + 2.0 / 3.0, (0.5 * s - 1.0) * s * s + 2.0 / 3.0
    return np.array([s * s * s / 6.0, *inner, t * t * t / 6.0])


def _in_cells(
    columns: Columns, arguments: list[Interval], boxes: int
) -> tuple[Array, Array, Booleans]:
    """Arguments in cells (N, d), rounded outward, and where the table says nothing."""
    taps = 4 if columns.method is Method.CUBIC else 2
    low, high = (np.empty((boxes, len(columns.axes))) for _ in range(2))
    outside = np.zeros(boxes, dtype=np.bool_)
    for a, (axis, argument) in enumerate(zip(columns.axes, arguments, strict=True)):
        cells = columns.coefficients.shape[a] - taps + 1
        u, v = ((end - axis.low) / axis.step for end in (argument.low, argument.high))
        u, v = u - CELL * np.abs(u), v + CELL * np.abs(v)
        first, last = (-LONGEST, LONGEST) if axis.periodic else (-FARTHEST, cells + FARTHEST)
        outside |= ~((u >= first) & (v <= last))
        low[:, a], high[:, a] = (np.clip(np.nan_to_num(end), first, last) for end in (u, v))
    return low, high, outside


def _bounds(
    columns: Columns, low: Array, high: Array, *, moves: bool, coarse: bool
) -> tuple[Interval, Interval]:
    """Values (N, k), and derivatives (N, k, d) by the coordinates in cells."""
    d, k = len(columns.axes), len(columns.error)
    lower, upper = (np.empty((len(low), k, 1 + (d if moves else 0))) for _ in range(2))
    enclose_cells(
        columns.method is Method.CUBIC,
        coarse,
        d if moves else 0,
        read_only_integers(columns.coefficients.shape[:-1]),
        np.array([axis.periodic for axis in columns.axes]),
        read_only_view(columns.coefficients).reshape(-1),
        float(np.abs(columns.coefficients).max()),
        low,
        high,
        lower,
        upper,
    )
    if np.any(columns.error):
        error = _spilled(columns, low, high)
        lower, upper = (
            np.nextafter(end + side * error, side * np.inf)
            for end, side in ((lower, -1.0), (upper, 1.0))
        )
    return Interval(lower[..., 0], upper[..., 0]), Interval(lower[..., 1:], upper[..., 1:])


def _spilled(columns: Columns, low: Array, high: Array) -> Array:
    """What the error of the coefficients does to values and slopes, (N, k, 1) twice that.

    Weights sum to 1 in size, for a derivative to 2; by b cells beyond the edge, each of up to
    three steps of de Boor's recursion makes that 1 + 2 b times as much.
    """
    taps = 4 if columns.method is Method.CUBIC else 2
    cells = np.array(columns.coefficients.shape[:-1]) - taps + 1
    bounded = ~np.array([axis.periodic for axis in columns.axes])
    beyond = np.maximum(np.maximum(-low, high - cells), 0.0) * bounded
    grown = (1.0 + 2.0 * beyond.max(axis=-1)) ** (3 * len(cells))
    spilled: Array = 2.0 * (1.0 + 2.0**-40) * grown[:, None, None] * columns.error[:, None]
    return spilled


def _chained(
    columns: Columns, arguments: Sequence[Jet], slopes: Interval, k: int, outside: Booleans
) -> Interval:
    """Derivatives (m, N) of column k by the axes of the boxes."""
    total: Interval | None = None
    for a, (axis, argument) in enumerate(zip(columns.axes, arguments, strict=True)):
        if argument.slopes is None:
            continue
        per_cell = Interval(slopes.low[:, k, a], slopes.high[:, k, a])
        scale = exactly(1.0 / axis.step)
        scale = Interval(scale.low * (1.0 - CELL), scale.high * (1.0 + CELL))
        part = multiply(multiply(per_cell, scale), argument.slopes)
        total = part if total is None else add(total, part)
    assert total is not None, "an argument moves"
    return chosen(outside, whole(()), total)

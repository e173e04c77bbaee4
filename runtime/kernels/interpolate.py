"""Table lookup, compiled.

Points are taken in blocks. First the cell and the weights of each axis are worked out for all
points of the block, then the weighted sum over the taps is taken point by point; index and weights
are shared by all columns. d: axes; m: columns; u: coordinate in cells; t: position in a cell.
"""
# ruff: noqa: FBT001 - kernels take arguments by place

from functools import cache
from typing import Any

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.kernels.cache import compiled_for_c, inlined, kernel
from runtime.kernels.vectors import (
    BLOCK,
    LAST,
    OUTER,
    PLANE,
    call,
    carray,
    contract,
    fma,
    stack_memory,
    types,
)

MOST_AXES = 5
PRODUCTS = 64
"""Products of the outer axes' taps: 4 ** (MOST_AXES - 2)."""
ROWS = OUTER + PRODUCTS + 4
SPARE = OUTER + PRODUCTS
"""Row of the weights that are about to be multiplied into the products."""
MEMORY = ROWS * BLOCK
HUGE = 2.0**52
"""Beyond it numbers have no fraction."""
SIXTH = 1.0 / 6.0
TWO_THIRDS = 2.0 / 3.0


@inlined
def _locate(
    cells: float,
    origin: float,
    low: float,
    high: float,
    inverse_step: float,
    periodic: bool,
    x: Array,
    lanes: int,
    u: Array,
) -> None:
    """Coordinates in units of cells; wrapped where the axis is periodic, else NaN outside."""
    for i in range(lanes):
        u[i] = x[i]
    if periodic:
        far = False
        for i in range(lanes):
            u[i] = (u[i] - origin) * inverse_step
            far |= not abs(u[i]) < HUGE
        if far:
            for i in range(lanes):
                if not abs(u[i]) < HUGE:
                    u[i] = np.fmod(x[i] - origin, cells / inverse_step) * inverse_step
        for i in range(lanes):
            u[i] = fma(-np.floor(u[i] / cells), cells, u[i])
    else:
        for i in range(lanes):
            inside = np.nan if (u[i] < low) | (u[i] > high) else u[i]
            u[i] = (inside - origin) * inverse_step


@inlined
def _split(cells: float, stride: float, u: Array, lanes: int, bases: Array) -> None:
    """Add the place of each cell to `bases`, and leave the position within the cell in u.

    Outside, the end cells go on. The comparisons send a NaN to cell 0.
    """
    top = cells - 1.0
    for i in range(lanes):
        cell = np.floor(u[i])
        cell = cell if cell > 0.0 else 0.0  # noqa: FURB136 - max() would let a NaN pass
        cell = cell if cell < top else top  # noqa: FURB136 - as above
        bases[i] += cell * stride
        u[i] -= cell


@inlined
def _weigh(cubic: bool, u: Array, lanes: int, w: Array) -> None:
    """Weights of the taps, (taps, lanes): the B-splines at position u in the cell."""
    if cubic:
        for i in range(lanes):
            t = u[i]
            s = 1.0 - t
            w[0, i] = s * s * s * SIXTH
            w[1, i] = fma(t * t, fma(0.5, t, -1.0), TWO_THIRDS)
            w[2, i] = fma(s * s, fma(0.5, s, -1.0), TWO_THIRDS)
            w[3, i] = t * t * t * SIXTH
    else:
        for i in range(lanes):
            w[0, i] = 1.0 - u[i]
            w[1, i] = u[i]


@inlined
def _weigh_slopes(cubic: bool, inverse_step: float, u: Array, lanes: int, w: Array) -> None:
    """Derivatives of the weights by the coordinate; NaN where u is."""
    if cubic:
        for i in range(lanes):
            t = u[i]
            s = 1.0 - t
            w[0, i] = -0.5 * s * s * inverse_step
            w[1, i] = fma(1.5, t, -2.0) * t * inverse_step
            w[2, i] = fma(1.5, s, -2.0) * -s * inverse_step
            w[3, i] = 0.5 * t * t * inverse_step
    else:
        for i in range(lanes):
            slope = inverse_step + (u[i] - u[i])
            w[0, i] = -slope
            w[1, i] = slope


@inlined
def _multiply(taps: int, stride: int, outer: int, shifts: Array, lanes: int, w: Array) -> None:
    """Multiply the spare weights into the `outer` products that there are."""
    for tap in range(taps - 1, -1, -1):
        for j in range(outer):
            into = tap * outer + j
            shifts[into] = shifts[j] + float(tap * stride)
            for i in range(lanes):
                w[OUTER + into, i] = w[OUTER + j, i] * w[SPARE + tap, i]


@inlined
def _weigh_axes(
    cubic: bool,
    m: int,
    slope: int,
    counts: Integers,
    lows: Array,
    highs: Array,
    inverse_steps: Array,
    periodic: Booleans,
    bounded: bool,
    x: Array,
    x_start: int,
    axis_stride: int,
    point_stride: int,
    lanes: int,
    bases: Array,
    shifts: Array,
    w: Array,
) -> tuple[int, int, int]:
    """Fill bases, shifts and weights of a block; the row stride, how many products, the size."""
    u = carray(stack_memory(BLOCK), BLOCK)
    taps = 4 if cubic else 2
    d, stride, row_stride, outer = len(counts), m, 0, 1
    for back in range(d):
        a = d - 1 - back
        at = x_start + a * axis_stride
        along = x[at : at + lanes * point_stride : point_stride]
        low, high = (lows[a], highs[a]) if bounded else (-np.inf, np.inf)
        cells = float(counts[a] - taps + 1)
        _locate(cells, lows[a], low, high, inverse_steps[a], periodic[a] != 0, along, lanes, u)
        _split(cells, float(stride), u, lanes, bases)
        row = (LAST, PLANE, OUTER, SPARE, SPARE)[back]
        if a == slope:
            _weigh_slopes(cubic, inverse_steps[a], u, lanes, w[row : row + 4])
        else:
            _weigh(cubic, u, lanes, w[row : row + 4])
        if back == 1:
            row_stride = stride
        elif back == 2:
            outer = taps
            for tap in range(taps):
                shifts[tap] = float(tap * stride)
        elif back > 2:
            _multiply(taps, stride, outer, shifts, lanes, w)
            outer *= taps
        stride *= counts[a]
    return row_stride, outer, stride


def _look_up(
    cubic: int,
    d: int,
    m: int,
    slope: int,
    bounded: int,
    counts: Any,
    lows: Any,
    highs: Any,
    inverse_steps: Any,
    periodic: Any,
    coefficients: Any,
    offset: int,
    x: Any,
    x_start: int,
    axis_stride: int,
    point_stride: int,
    lanes: int,
    out: Any,
    start: int,
    column_stride: int,
    lane_stride: int,
) -> None:
    """Look up `lanes` <= BLOCK points, or the derivative by axis `slope` if that is not negative.

    Arrays come as pointers. bounded: whether points outside [low, high] give NaN; else the cells
    at the edge go on. Coordinate a of lane i is x[x_start + a axis_stride + i point_stride];
    column k of lane i goes to out[start + k column_stride + i lane_stride].
    """
    w = carray(stack_memory(MEMORY), (ROWS, BLOCK))
    bases = carray(stack_memory(BLOCK), BLOCK)
    shifts = carray(stack_memory(PRODUCTS), PRODUCTS)
    bases[:lanes] = offset
    if d == 1:  # the last axis but one is made up: the same row, once
        w[PLANE, :lanes] = 1.0
        w[PLANE + 1 : PLANE + 4, :lanes] = 0.0
    row_stride, outer, size = _weigh_axes(
        cubic != 0,
        m,
        slope,
        carray(counts, d),
        carray(lows, d),
        carray(highs, d),
        carray(inverse_steps, d),
        carray(periodic, d),
        bounded != 0,
        carray(x, x_start + d * axis_stride + lanes * point_stride),
        x_start,
        axis_stride,
        point_stride,
        lanes,
        bases,
        shifts,
        w,
    )
    table = m, carray(coefficients, offset + size), bases, w, row_stride, outer, shifts
    into = carray(out, start + m * column_stride + lanes * lane_stride)
    contract(cubic != 0, d, (*table, lanes, into, start, column_stride, lane_stride))


@cache
def block_address() -> int:
    """Where the machine code of a block's lookup is; compiled on the first call."""
    numbers, integers = types.CPointer(types.float64), types.CPointer(types.int64)
    flags, i = types.CPointer(types.uint8), types.int64
    table = integers, numbers, numbers, numbers, flags, numbers, i
    signature = types.void(i, i, i, i, i, *table, numbers, i, i, i, i, numbers, i, i, i)
    return compiled_for_c(_look_up, signature)


@kernel
def lookup_lanes(
    address: int,
    cubic: bool,
    d: int,
    m: int,
    counts: Integers,
    lows: Array,
    inverse_steps: Array,
    periodic: Booleans,
    coefficients: Array,
    offset: int,
    points: Array,
    lanes: int,
    out: Array,
) -> None:
    """Interpolate at `lanes` points (d, >= lanes) into out (m, >= lanes).

    counts: coefficients along each axis; those of this table begin at `offset`. Outside its domain
    the table goes on with the polynomials of the cells at its edge.
    """
    across, along = points.shape[1], out.shape[1]
    for at in range(0, lanes, BLOCK):
        part = min(BLOCK, lanes - at)
        table = counts, lows, lows, inverse_steps, periodic, coefficients, offset
        call(address, (cubic, d, m, -1, 0, *table, points, at, across, 1, part, out, at, along, 1))


@kernel
def lookup_points(
    address: int,
    cubic: bool,
    counts: Integers,
    lows: Array,
    highs: Array,
    inverse_steps: Array,
    periodic: Booleans,
    coefficients: Array,
    points: Array,
    out: Array,
) -> None:
    """Interpolate at points (N, d) into out (N, m); NaN outside the domain."""
    (n, d), m = points.shape, out.shape[1]
    table = counts, lows, highs, inverse_steps, periodic, coefficients, 0
    for at in range(0, n, BLOCK):
        lanes = min(BLOCK, n - at)
        call(address, (cubic, d, m, -1, 1, *table, points, at * d, 1, d, lanes, out, at * m, 1, m))


@kernel
def jacobian_points(
    address: int,
    cubic: bool,
    counts: Integers,
    lows: Array,
    highs: Array,
    inverse_steps: Array,
    periodic: Booleans,
    coefficients: Array,
    points: Array,
    out: Array,
) -> None:
    """Derivatives at points (N, d) into out (N, m, d); NaN outside the domain."""
    (n, d), m = points.shape, out.shape[1]
    table = counts, lows, highs, inverse_steps, periodic, coefficients, 0
    for at in range(0, n, BLOCK):
        where = at * d, 1, d, min(BLOCK, n - at)
        for a in range(d):
            to = at * m * d + a, d, m * d
            call(address, (cubic, d, m, a, 1, *table, points, *where, out, *to))

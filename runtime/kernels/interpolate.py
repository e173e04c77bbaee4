"""Table lookup, compiled.

Points are taken in blocks. First the cell and the weights of each axis are worked out for all
points of the block, then the weighted sum over the taps is taken point by point; index and weights
are shared by all columns. d: axes; m: columns; u: coordinate in cells; t: position in a cell.
"""
# ruff: noqa: PLR0917, FBT001 - kernels take arguments by place

from functools import cache
from typing import Any

import numpy as np
from numba import carray, types

from runtime.arrays import Array, Booleans, Integers
from runtime.kernels.cache import compiled_for_c, inlined, kernel
from runtime.kernels.vectors import BLOCK, LAST, OUTER, PLANE, call, contract, fma, stack_memory

MOST_AXES = 5
PRODUCTS = 64
"""Products of the outer axes' taps: 4 ** (MOST_AXES - 2)."""
ROWS = OUTER + PRODUCTS + 4
SPARE = OUTER + PRODUCTS
"""Row of the weights that are about to be multiplied into the products."""
MEMORY = ROWS * BLOCK
POINTS = MOST_AXES * BLOCK
HUGE = 2.0**52
"""Beyond it numbers have no fraction."""
SIXTH = 1.0 / 6.0
TWO_THIRDS = 2.0 / 3.0


@inlined
def _locate(
    cells: float, low: float, inverse_step: float, periodic: bool, x: Array, lanes: int, u: Array
) -> None:
    """Coordinates in units of cells, wrapped where the axis is periodic."""
    for i in range(lanes):
        u[i] = (x[i] - low) * inverse_step
    if periodic:
        for i in range(lanes):
            if not abs(u[i]) < HUGE:
                u[i] = np.fmod(u[i], cells)
        for i in range(lanes):
            u[i] = fma(-np.floor(u[i] / cells), cells, u[i])


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


def _block(
    cubic: int,
    d: int,
    m: int,
    slope: int,
    counts_: Any,
    lows_: Any,
    inverse_steps_: Any,
    periodic_: Any,
    coefficients_: Any,
    offset: int,
    x_: Any,
    x_start: int,
    x_stride: int,
    lanes: int,
    out_: Any,
    start: int,
    column_stride: int,
    lane_stride: int,
) -> None:
    """Look up `lanes` <= BLOCK points, or the derivative by axis `slope` if that is not negative.

    x: coordinate a of lane i is at x_start + a x_stride + i. out: column k of lane i goes to
    start + k column_stride + i lane_stride.
    """
    counts, periodic = carray(counts_, d), carray(periodic_, d)
    lows, inverse_steps = carray(lows_, d), carray(inverse_steps_, d)
    x = carray(x_, x_start + d * x_stride)
    w = carray(stack_memory(MEMORY), (ROWS, BLOCK))
    u = carray(stack_memory(BLOCK), BLOCK)
    bases = carray(stack_memory(BLOCK), BLOCK)
    shifts = carray(stack_memory(PRODUCTS), PRODUCTS)
    taps = 4 if cubic else 2
    stride, row_stride, outer = m, 0, 1
    for i in range(lanes):
        bases[i] = offset
        w[PLANE, i], w[PLANE + 1, i], w[PLANE + 2, i], w[PLANE + 3, i] = 1.0, 0.0, 0.0, 0.0
    for back in range(d):
        a = d - 1 - back
        at = x_start + a * x_stride
        cells = float(counts[a] - taps + 1)
        _locate(cells, lows[a], inverse_steps[a], periodic[a] != 0, x[at : at + lanes], lanes, u)
        _split(cells, float(stride), u, lanes, bases)
        row = (LAST, PLANE, OUTER, SPARE, SPARE)[back]
        if a == slope:
            _weigh_slopes(cubic != 0, inverse_steps[a], u, lanes, w[row : row + 4])
        else:
            _weigh(cubic != 0, u, lanes, w[row : row + 4])
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
    coefficients, out = carray(coefficients_, stride), carray(out_, start + lanes)
    block = (
        m,
        coefficients,
        bases,
        w,
        row_stride,
        outer,
        shifts,
        lanes,
        out,
        start,
        column_stride,
        lane_stride,
    )
    contract(cubic != 0, d, block)


@cache
def block_address() -> int:
    """Where the machine code of a block's lookup is; compiled on the first call."""
    numbers, integers = types.CPointer(types.float64), types.CPointer(types.int64)
    flags, i = types.CPointer(types.uint8), types.int64
    signature = types.void(
        i, i, i, i, integers, numbers, numbers, flags, numbers, i, numbers, i, i, i, numbers, i, i, i
    )
    return compiled_for_c(_block, signature)


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
        table = counts, lows, inverse_steps, periodic, coefficients, offset
        call(
            address,
            (cubic, d, m, -1, *table, points, at, across, min(BLOCK, lanes - at), out, at, along, 1),
        )


@inlined
def _gather(
    points: Array, start: int, lanes: int, lows: Array, highs: Array, periodic: Booleans, x: Array
) -> None:
    """A block of points, axis by axis; NaN where they are outside."""
    for a in range(points.shape[1]):
        low = -np.inf if periodic[a] else lows[a]
        high = np.inf if periodic[a] else highs[a]
        for i in range(lanes):
            value = points[start + i, a]
            x[a * BLOCK + i] = value if low <= value <= high else np.nan


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
    x = carray(stack_memory(POINTS), POINTS)
    table = counts, lows, inverse_steps, periodic, coefficients, 0
    for at in range(0, n, BLOCK):
        lanes = min(BLOCK, n - at)
        _gather(points, at, lanes, lows, highs, periodic, x)
        call(address, (cubic, d, m, -1, *table, x, 0, BLOCK, lanes, out, at * m, 1, m))


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
    x = carray(stack_memory(POINTS), POINTS)
    table = counts, lows, inverse_steps, periodic, coefficients, 0
    for at in range(0, n, BLOCK):
        lanes = min(BLOCK, n - at)
        _gather(points, at, lanes, lows, highs, periodic, x)
        for a in range(d):
            to = at * m * d + a
            call(address, (cubic, d, m, a, *table, x, 0, BLOCK, lanes, out, to, d, m * d))

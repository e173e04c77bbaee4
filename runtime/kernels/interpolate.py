"""Table lookup, compiled.

Points are taken in blocks. First the cell and the weights of each axis are worked out for all
points of the block, then the weighted sum over the taps is taken point by point.
"""

import numpy as np
from numba import carray

from runtime.arrays import Array, Booleans, Integers
from runtime.kernels.cache import inlined, kernel
from runtime.kernels.vectors import BLOCK, LAST, OUTER, PLANE, contract, fma, stack_memory

ROWS = OUTER + 64
HUGE = 2.0**52
SIXTH = 1.0 / 6.0


@inlined
def _locate(cells: float, low: float, inverse_step: float, periodic: bool, x: Array, lanes: int, u: Array) -> None:
    """Coordinates x in units of cells, wrapped where the axis is periodic."""
    for i in range(lanes):
        u[i] = (x[i] - low) * inverse_step
    if periodic:
        for i in range(lanes):
            if not abs(u[i]) < HUGE:
                u[i] = np.fmod(u[i], cells)
        for i in range(lanes):
            u[i] = fma(-np.floor(u[i] / cells), cells, u[i])


@inlined
def _split(cells: float, stride: float, u: Array, lanes: int, base: Array) -> None:
    """Add the cell of each u to `base`, and leave the position within the cell in u.

    Comparisons are written so that a NaN goes to cell 0.
    """
    top = cells - 1.0
    for i in range(lanes):
        f = np.floor(u[i])
        f = f if f > 0.0 else 0.0
        f = f if f < top else top
        base[i] += f * stride
        u[i] -= f


@inlined
def _weigh(cubic: bool, u: Array, lanes: int, w: Array) -> None:
    """Weights of the taps (taps, lanes) at position u within the cell."""
    if cubic:
        for i in range(lanes):
            t = u[i]
            s = 1.0 - t
            w[0, i] = s * s * s * SIXTH
            w[1, i] = fma(t * t, fma(0.5, t, -1.0), 2.0 / 3.0)
            w[2, i] = fma(s * s, fma(0.5, s, -1.0), 2.0 / 3.0)
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


@kernel
def lookup_block(cubic, d, m, slope, counts, lows, inverse_steps, periodic, coefficients, offset, x, x_stride, lanes, out, start, column_stride, lane_stride):
    """At most BLOCK points."""
    taps = 4 if cubic else 2
    w = carray(stack_memory(72 * 32), (ROWS, BLOCK))
    v = carray(stack_memory(32 * 4), (4, BLOCK))
    u = carray(stack_memory(32), BLOCK)
    base = carray(stack_memory(32), BLOCK)
    offsets = carray(stack_memory(64), 64)
    for i in range(lanes):
        base[i] = offset
    stride = m
    row_stride = m
    outer = 1
    for back in range(d):
        a = d - 1 - back
        cells = float(counts[a] - taps + 1)
        _locate(cells, lows[a], inverse_steps[a], periodic[a], x[a * x_stride:a * x_stride + lanes], lanes, u)
        _split(cells, float(stride), u, lanes, base)
        into = w[LAST:LAST+4] if back == 0 else (w[PLANE:PLANE+4] if back == 1 else (w[OUTER:OUTER+4] if back == 2 else v))
        if a == slope:
            _weigh_slopes(cubic, inverse_steps[a], u, lanes, into)
        else:
            _weigh(cubic, u, lanes, into)
        if back == 1:
            row_stride = stride
        elif back == 2:
            outer = taps
            for t in range(taps):
                offsets[t] = float(t * stride)
        elif back > 2:
            for k in range(taps - 1, -1, -1):
                for j in range(outer):
                    offsets[k * outer + j] = offsets[j] + float(k * stride)
                    for i in range(lanes):
                        w[OUTER + k * outer + j, i] = w[OUTER + j, i] * v[k, i]
            outer *= taps
        stride *= counts[a]
    contract(cubic, m, d, coefficients, base, row_stride, outer, offsets, w, lanes, out, start, column_stride, lane_stride)


@kernel
def lookup_lanes(
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
    """Interpolate at `lanes` points (d, >= lanes) into out (m, >= lanes)."""
    x = points.reshape(-1)
    flat = out.reshape(-1)
    for start in range(0, lanes, BLOCK):
        lookup_block(cubic, d, m, -1, counts, lows, inverse_steps, periodic, coefficients, offset, x[start:], points.shape[1], min(BLOCK, lanes - start), flat, start, out.shape[1], 1)


@inlined
def _gather(points, start, lanes, lows, highs, periodic, x):
    """A block of points, axis by axis; NaN where they are outside."""
    for a in range(points.shape[1]):
        low, high = lows[a], highs[a]
        if periodic[a]:
            low, high = -np.inf, np.inf
        for i in range(lanes):
            v = points[start + i, a]
            x[a * BLOCK + i] = v if v >= low and v <= high else np.nan


@kernel
def lookup_points(cubic: bool, counts: Integers, lows: Array, highs: Array, inverse_steps: Array, periodic: Booleans, coefficients: Array, points: Array, out: Array) -> None:
    """Interpolate at points (N, d) into out (N, m)."""
    n, d = points.shape
    m = out.shape[1]
    x = carray(stack_memory(5 * 32), 5 * BLOCK)
    flat = out.reshape(-1)
    for start in range(0, n, BLOCK):
        lanes = min(BLOCK, n - start)
        _gather(points, start, lanes, lows, highs, periodic, x)
        lookup_block(cubic, d, m, -1, counts, lows, inverse_steps, periodic, coefficients, 0, x, BLOCK, lanes, flat, start * m, 1, m)


@kernel
def jacobian_points(cubic: bool, counts: Integers, lows: Array, highs: Array, inverse_steps: Array, periodic: Booleans, coefficients: Array, points: Array, out: Array) -> None:
    """Derivatives at points (N, d) into out (N, m, d)."""
    n, d = points.shape
    m = out.shape[1]
    x = carray(stack_memory(5 * 32), 5 * BLOCK)
    flat = out.reshape(-1)
    for start in range(0, n, BLOCK):
        lanes = min(BLOCK, n - start)
        _gather(points, start, lanes, lows, highs, periodic, x)
        for a in range(d):
            lookup_block(cubic, d, m, a, counts, lows, inverse_steps, periodic, coefficients, 0, x, BLOCK, lanes, flat, start * m * d + a, d, m * d)

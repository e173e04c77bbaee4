"""Table lookup, compiled: first version."""

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.kernels.cache import inlined, kernel


@inlined
def _cell(x: float, low: float, inverse_step: float, cells: int, periodic: bool) -> tuple[float, float]:
    """Cell index (as a number) and position within the cell."""
    u = (x - low) * inverse_step
    if periodic:
        if not abs(u) < 4503599627370496.0:
            u = np.fmod(u, cells)
        u -= np.floor(u / cells) * cells
    f = np.floor(u)
    f = f if f > 0.0 else 0.0
    f = f if f < cells - 1.0 else cells - 1.0
    return f, u - f


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
    taps = 4 if cubic else 2
    w = np.empty((5, 4))
    at = np.zeros(5, np.int64)
    strides = np.empty(5, np.int64)
    stride = m
    for a in range(d - 1, -1, -1):
        strides[a] = stride
        stride *= counts[a]
    for lane in range(lanes):
        base = offset
        for a in range(d):
            f, t = _cell(points[a, lane], lows[a], inverse_steps[a], counts[a] - taps + 1, periodic[a])
            base += int(f) * strides[a]
            s = 1.0 - t
            if cubic:
                w[a, 0] = s * s * s / 6.0
                w[a, 1] = 2.0 / 3.0 - t * t * (1.0 - 0.5 * t)
                w[a, 2] = 2.0 / 3.0 - s * s * (1.0 - 0.5 * s)
                w[a, 3] = t * t * t / 6.0
            else:
                w[a, 0] = s
                w[a, 1] = t
        for k in range(m):
            out[k, lane] = 0.0
        at[:] = 0
        for _ in range(taps**d):
            weight = 1.0
            position = base
            for a in range(d):
                weight *= w[a, at[a]]
                position += at[a] * strides[a]
            for k in range(m):
                out[k, lane] += weight * coefficients[position + k]
            for a in range(d - 1, -1, -1):
                at[a] += 1
                if at[a] < taps:
                    break
                at[a] = 0

"""Bounds of a table over boxes, compiled.

A box is cut at the cells that it touches. On each, the B-spline coefficients are turned into the
Bernstein coefficients of the sub-box by the blossom (Ramshaw 1989), and the polynomial lies between
the smallest and the largest of them. d: axes; m: columns; u: coordinate in cells; t: position in a
cell.

Rounding. Every weight is a sum of products of at most three factors that are not negative while
0 <= t <= 1; each factor is computed to 2 roundings, so the weights of one row are together off by
less than 16 eps/2 of their absolute sum, and a sum of four products adds 4 eps/2. After d axes the
error is below `d * ROUNDINGS * eps` times the product of the absolute row sums times the largest
coefficient of the cell; eps = 2**-52. It is added outward. Beyond the table's edge weights may be
negative; the absolute row sums then say how much an error grows.

Boxes mostly end at nodes, and rounding makes them touch the cells beyond. A cubic spline is twice
continuously differentiable, with jumps of the third derivative of at most 16 times the largest
coefficient, L: on a strip of h = 2**-30 cells beyond a node, the polynomial of the cell before is
off by less than 16 L h³ / 6 per axis, its slope by 16 L h² / 2 (twice that beside another axis'
difference). So a cell that is only touched is left out, and `MISSED` or `MISSED_SLOPE` times d L is
added. Linear tables have kinks, and get all cells.
"""
# ruff: noqa: FBT001 - kernels take arguments by place

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.kernels.cache import kernel, part

ROUNDINGS = 16.0
EPSILON = 2.0**-52
TOUCH = 2.0**-30
MISSED = 32.0 * TOUCH**3
MISSED_SLOPE = 64.0 * TOUCH**2
MANY = 16
"""A box that touches more cells than this for each axis is bounded by its coefficients."""


@part
def _blossom(t1: float, t2: float, w: Array) -> None:
    """Weights w (3,) of a quadratic piece's coefficients in its blossom at t1, t2."""
    a, b = 1.0 - t2, t2
    w[0] = a * (1.0 - t1) * 0.5
    w[1] = a * (t1 + 1.0) * 0.5 + b * (2.0 - t1) * 0.5
    w[2] = b * t1 * 0.5


@part
def _weigh(cubic: bool, slope: bool, t0: float, t1: float, w: Array) -> tuple[int, float]:
    """Rows of weights w (4, 4) from coefficients to Bernstein coefficients on [t0, t1].

    Returns how many rows, and their largest absolute sum.
    """
    if not cubic:
        if slope:
            w[0, 0], w[0, 1] = -1.0, 1.0
            return 1, 2.0
        w[0, 0], w[0, 1] = 1.0 - t0, t0
        w[1, 0], w[1, 1] = 1.0 - t1, t1
        return 2, max(abs(1.0 - t0) + abs(t0), abs(1.0 - t1) + abs(t1))
    inner = np.empty(3)
    rows = 3 if slope else 4
    largest = 0.0
    for row in range(rows):
        first = t1 if row > 0 else t0
        second = t1 if row > 1 else t0
        third = t1 if row > 2 else t0
        _blossom(first, second, inner)
        if slope:
            w[row, 0] = -inner[0]
            w[row, 1] = inner[0] - inner[1]
            w[row, 2] = inner[1] - inner[2]
            w[row, 3] = inner[2]
            size = 2.0 * (abs(inner[0]) + abs(inner[1]) + abs(inner[2]))
        else:
            w[row, 0] = inner[0] * (1.0 - third) / 3.0
            w[row, 1] = inner[0] * (third + 2.0) / 3.0 + inner[1] * (2.0 - third) / 3.0
            w[row, 2] = inner[1] * (third + 1.0) / 3.0 + inner[2] * (3.0 - third) / 3.0
            w[row, 3] = inner[2] * third / 3.0
            size = abs(w[row, 0]) + abs(w[row, 1]) + abs(w[row, 2]) + abs(w[row, 3])
        largest = max(largest, size)
    return rows, largest


@part
def _contract(
    cubic: bool, slope: int, d: int, m: int, t: Array, source: Array, work: Array, w: Array
) -> tuple[int, float, int]:
    """Weigh all axes of source (taps ** d * m); the result stands in a half of `work` (2, size).

    Returns which half, the growth of errors, and how many Bernstein coefficients a column has.
    """
    taps = 4 if cubic else 2
    half, before, growth = 0, 1, 1.0
    after = m
    for _ in range(d):
        after *= taps
    for i in range(after):
        work[0, i] = source[i]
    for a in range(d):
        after //= taps
        rows, size = _weigh(cubic, a == slope, t[a, 0], t[a, 1], w)
        growth *= size
        for o in range(before):
            for r in range(rows):
                into = (o * rows + r) * after
                taken = o * taps * after
                weight = w[r, 0]
                for i in range(after):
                    work[1 - half, into + i] = weight * work[half, taken + i]
                for k in range(1, taps):
                    weight, taken = w[r, k], taken + after
                    for i in range(after):
                        work[1 - half, into + i] += weight * work[half, taken + i]
        before *= rows
        half = 1 - half
    return half, growth, before


@part
def _span(cubic: bool, cells: int, wraps: bool, low: float, high: float) -> tuple[int, int, float]:
    """The first and the last cell that [low, high] sees, and how far it sticks out of them."""
    touch = TOUCH if cubic else 0.0
    first, last = int(np.floor(low + touch)), int(np.ceil(high - touch)) - 1
    last = max(first, last)
    if not wraps:
        first, last = min(max(first, 0), cells - 1), min(max(last, 0), cells - 1)
    return first, last, max(0.0, first - low, high - (last + 1))


@part
def _gather(
    taps: int,
    counts: Integers,
    wraps: Booleans,
    m: int,
    coefficients: Array,
    cell: Integers,
    out: Array,
) -> float:
    """Copy the coefficients of a cell to `out`; the largest of their sizes."""
    d = len(counts)
    total = 1
    for _ in range(d):
        total *= taps
    largest = 0.0
    for flat in range(total):
        rest, place, stride = flat, 0, m
        for back in range(d):
            a = d - 1 - back
            i = cell[a] % (counts[a] - taps + 1) if wraps[a] else cell[a]
            place += (i + rest % taps) * stride
            rest //= taps
            stride *= counts[a]
        for k in range(m):
            value = coefficients[place + k]
            out[flat * m + k] = value
            largest = max(largest, abs(value))
    return largest


@part
def _sub_box(cell: Integers, spans: Integers, low: Array, high: Array, t: Array) -> None:
    """The part of the box in one cell, t (d, 2); the first and the last go on to its ends."""
    for a in range(len(cell)):
        t0, t1 = 0.0, 1.0
        if cell[a] == spans[a, 0]:  # the difference may be rounded beside 0 or a seam
            t0 = low[a] - cell[a]
            t0 -= EPSILON * (1.0 + abs(t0))
        if cell[a] == spans[a, 1]:
            t1 = high[a] - cell[a]
            t1 += EPSILON * (1.0 + abs(t1))
        t[a, 0], t[a, 1] = t0, t1


@part
def _by_cells(
    cubic: bool,
    counts: Integers,
    wraps: Booleans,
    m: int,
    slopes: int,
    coefficients: Array,
    spans: Integers,
    low: Array,
    high: Array,
    taken: Array,
    work: Array,
    lower: Array,
    upper: Array,
) -> None:
    """Hull of the Bernstein coefficients of all cells; lower, upper (m, 1 + slopes)."""
    d, taps = len(counts), 4 if cubic else 2
    cell, t, w = spans[:, 0].copy(), np.empty((d, 2)), np.empty((4, 4))
    while True:
        largest = _gather(taps, counts, wraps, m, coefficients, cell, taken)
        _sub_box(cell, spans, low, high, t)
        for s in range(1 + slopes):
            half, growth, size = _contract(cubic, s - 1, d, m, t, taken, work, w)
            error = d * ROUNDINGS * EPSILON * growth * largest
            for k in range(m):
                for i in range(size):
                    value = work[half, i * m + k]
                    lower[k, s] = min(lower[k, s], value - error)
                    upper[k, s] = max(upper[k, s], value + error)
        a = d - 1
        while a >= 0 and cell[a] == spans[a, 1]:
            cell[a] = spans[a, 0]
            a -= 1
        if a < 0:
            return
        cell[a] += 1


@part
def _widen(d: int, beyond: float, lower: Array, upper: Array) -> None:
    """Widen hulls (m, columns) for a box that sticks out of the table by `beyond` cells.

    A step of de Boor's recursion then has weights of the absolute sum 1 + 2 beyond at most.
    """
    grown = (1.0 + 2.0 * beyond) ** (3 * d) * (1.0 + 64.0 * EPSILON)
    for k in range(lower.shape[0]):
        for s in range(lower.shape[1]):
            middle = 0.5 * (lower[k, s] + upper[k, s])
            radius = 0.5 * grown * (upper[k, s] - lower[k, s])
            radius += 4.0 * EPSILON * (abs(middle) + radius)
            lower[k, s], upper[k, s] = middle - radius, middle + radius


@part
def _by_coefficients(
    cubic: bool,
    counts: Integers,
    wraps: Booleans,
    m: int,
    slopes: int,
    coefficients: Array,
    spans: Integers,
    lower: Array,
    upper: Array,
) -> None:
    """Hull of the coefficients that the box sees: weights are not negative and sum to 1."""
    d, taps = len(counts), 4 if cubic else 2
    at = spans[:, 0].copy()
    place = np.empty(d, dtype=np.int64)
    while True:
        base = 0
        for a in range(d):
            place[a] = at[a] % (counts[a] - taps + 1) if wraps[a] else at[a]
            base = base * counts[a] + place[a]
        for k in range(m):
            value = coefficients[base * m + k]
            lower[k, 0] = min(lower[k, 0], value)
            upper[k, 0] = max(upper[k, 0], value)
            stride = m
            for back in range(slopes):
                a = d - 1 - back
                if at[a] < spans[a, 1] + taps - 1:
                    rise = coefficients[base * m + k + stride] - value
                    error = EPSILON * abs(rise)
                    lower[k, 1 + a] = min(lower[k, 1 + a], rise - error)
                    upper[k, 1 + a] = max(upper[k, 1 + a], rise + error)
                stride *= counts[a]
        a = d - 1
        while a >= 0 and at[a] == spans[a, 1] + taps - 1:
            at[a] = spans[a, 0]
            a -= 1
        if a < 0:
            return
        at[a] += 1


@kernel
def enclose_cells(
    cubic: bool,
    coarse: bool,
    slopes: int,
    counts: Integers,
    wraps: Booleans,
    coefficients: Array,
    largest: float,
    low: Array,
    high: Array,
    lower: Array,
    upper: Array,
) -> None:
    """Bounds of a table, and of its derivatives per cell, over boxes low to high (N, d) in cells.

    counts: coefficients along each axis; largest: their greatest size. slopes: d, or 0 for values
    alone. lower, upper: (N, m, 1 + slopes), the value first. coarse: by the coefficients alone,
    many times faster.
    """
    n, d = low.shape
    m = lower.shape[1]
    taps = 4 if cubic else 2
    size = m * taps**d
    taken, work = np.empty(size), np.empty((2, size))
    spans = np.empty((d, 2), dtype=np.int64)
    for b in range(n):
        lower[b], upper[b] = np.inf, -np.inf
        beyond, cells, around = 0.0, 1, False
        for a in range(d):
            count = counts[a] - taps + 1
            first, last, out = _span(cubic, count, wraps[a], low[b, a], high[b, a])
            if last - first >= count:  # more than a turn: each cell once, but all of it
                last, around = first + count - 1, True
            spans[a, 0], spans[a, 1] = first, last
            beyond = max(beyond, out)
            cells *= last - first + 1
        if coarse or around or cells > MANY * d:
            _by_coefficients(
                cubic, counts, wraps, m, slopes, coefficients, spans, lower[b], upper[b]
            )
            if beyond > 0.0:
                _widen(d, beyond, lower[b], upper[b])
        else:
            _by_cells(
                cubic,
                counts,
                wraps,
                m,
                slopes,
                coefficients,
                spans,
                low[b],
                high[b],
                taken,
                work,
                lower[b],
                upper[b],
            )
        if cubic:
            for k in range(m):
                for i in range(1 + slopes):
                    missed = d * largest * (MISSED_SLOPE if i > 0 else MISSED)
                    lower[b, k, i] -= missed
                    upper[b, k, i] += missed

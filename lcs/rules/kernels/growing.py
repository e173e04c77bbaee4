"""A box grown around one example: it takes in its own, and stops before others.

columns: examples (n, T). order (n, T): their indices in ascending order of each input. own (T,):
what one more example of the right level is worth; other (T,): what one of another level counts
against it.
"""

import numpy as np

from lcs.arrays import Array, Booleans, Integers
from lcs.compiled import kernel, part


@part
def add_out(
    column: Array, lower: float, upper: float, high: float, weight: int, out: Integers
) -> None:
    """Add a weight to out (T,) where an example lies outside of an interval."""
    if upper == high:
        for t in range(column.size):
            out[t] += weight * ((column[t] < lower) | (column[t] > upper))
    else:
        for t in range(column.size):
            out[t] += weight * ((column[t] < lower) | (column[t] >= upper))


@part
def walk(
    column: Array,
    order: Integers,
    inside: Booleans,
    gain: Array,
    start: int,
    step: int,
) -> float:
    """The first value to leave out, walking from index `start` of order; NaN: none.

    Only examples that are `inside` in all other inputs count; equal values go together, and those
    of the first are taken in whatever they are.
    """
    total = best = 0.0
    first = here = column[order[start]]
    leave = np.nan
    waits = False  # whether `leave` is still to be found
    k = start
    while 0 <= k < order.size:
        t = order[k]
        k += step
        if not inside[t]:
            continue
        if column[t] != here:
            if total >= best:
                best = total
                waits = True
            here = column[t]
            if waits:
                leave, waits = here, False
        if here != first:
            total += gain[t]
    return np.nan if total >= best else leave


@part
def set_interval(
    column: Array,
    order: Integers,
    gain: Array,
    i: int,
    seed: int,
    box: tuple[Array, Array, Array, Array],
    out: Integers,
    inside: Booleans,
) -> bool:
    """Choose the best interval of input i that holds the seed; whether it changed.

    box: lower, upper (n,), changed in place, and the known range, low and high (n,).
    """
    lower, upper, low, high = box
    add_out(column, lower[i], upper[i], high[i], -1, out)
    for t in range(column.size):
        inside[t] = out[t] == 0
    at = column[seed]
    sorted_column = column[order]
    last = np.searchsorted(sorted_column, at, "right") - 1
    leave_below = walk(column, order, inside, gain, last, -1)
    first = np.searchsorted(sorted_column, at)
    leave_above = walk(column, order, inside, gain, first, 1)
    before_lower, before_upper = lower[i], upper[i]
    lower[i], upper[i] = low[i], high[i]
    if not np.isnan(leave_below):
        lower[i] = np.nextafter(leave_below, np.inf)
    if not np.isnan(leave_above):
        upper[i] = leave_above
    add_out(column, lower[i], upper[i], high[i], 1, out)
    return bool(lower[i] != before_lower or upper[i] != before_upper)


@kernel
def grow(
    columns: Array,
    order: Integers,
    worth: tuple[Array, Array],
    seed: int,
    box: tuple[Array, Array, Array, Array],
    penalties: Array,
) -> None:
    """Change a box in place, interval by interval, until none changes at the last penalty.

    worth: own and other (T,). The box is lower, upper, low, high (n,). Of each penalty (K,) there
    is one sweep, of the last as many as need be.
    """
    own, other = worth
    n, count = columns.shape
    out, inside = np.zeros(count, np.int64), np.zeros(count, np.bool_)
    for i in range(n):
        add_out(columns[i], box[0][i], box[1][i], box[3][i], 1, out)
    for k in range(penalties.size):
        gain = own - penalties[k] * other
        for _ in range(1 if k + 1 < penalties.size else 3 * n):
            changed = False
            for i in range(n):
                changed |= set_interval(columns[i], order[i], gain, i, seed, box, out, inside)
            if not changed:
                break


@kernel
def gaps(
    columns: Array,
    is_told: Booleans,
    box: tuple[Array, Array, Array, Array],
    i: int,
    found: Array,
) -> None:
    """Fill found (4,): around both bounds of input i, between which values they may move.

    Below the lower bound, above it, below the upper, above it; -inf and inf where nobody is.
    Only examples that were told, and are inside in all other inputs, count. The box is lower,
    upper, low, high (n,).
    """
    lower, upper, low, high = box
    found[:] = (-np.inf, np.inf, -np.inf, np.inf)
    out = np.zeros(columns.shape[1], np.int64)
    for j in range(lower.size):
        add_out(
            columns[j],
            low[j] if j == i else lower[j],
            high[j] if j == i else upper[j],
            high[j],
            1,
            out,
        )
    for t in range(out.size):
        if out[t] > 0 or not is_told[t]:
            continue
        at = columns[i, t]
        if at < lower[i]:
            found[0] = max(found[0], at)
        elif at > upper[i] or (at == upper[i] and at != high[i]):
            found[3] = min(found[3], at)
        else:
            found[1] = min(found[1], at)
            found[2] = max(found[2], at)

"""Which rules hold where, and what they expect there (thesis 4.3.2).

Inputs come as columns (n, T), one input after the other, so that a box is held against many
examples at once.
"""

import numpy as np

from lcs.arrays import Array, Booleans, Integers
from lcs.compiled import kernel, part

BLOCK = 4096
"""Examples at once, so that they stay near the processor."""


@part
def hold_all(lower: Array, upper: Array, high: Array, columns: Array, held: Booleans) -> None:
    """Fill held (T,): whether a box holds an input.

    It is half open, but closed where the known range ends.
    """
    held[:] = True
    for i in range(lower.size):
        column, low, up = columns[i], lower[i], upper[i]
        if up == high[i]:
            for t in range(held.size):
                held[t] &= (column[t] >= low) & (column[t] <= up)
        else:
            for t in range(held.size):
                held[t] &= (column[t] >= low) & (column[t] < up)


@kernel
def match(lower: Array, upper: Array, high: Array, columns: Array, found: Booleans) -> None:
    """Fill found (R, T): whether a box (R, n) holds an input (n, T)."""
    for r in range(lower.shape[0]):
        hold_all(lower[r], upper[r], high, columns, found[r])


@kernel
def tally(
    boxes: tuple[Array, Array, Array],
    level: Integers,
    columns: Array,
    of: Integers,
    count: Integers,
    right: Integers,
    wrong: Integers,
) -> None:
    """Fill right and wrong (R,): how many inputs of its level, and of others, a box holds.

    boxes: lower and upper (R, n), and the end of the known range (n,). of, count (T,): the level
    of an input, and how many it stands for.
    """
    lower, upper, high = boxes
    held = np.zeros(of.size, np.bool_)
    for r in range(level.size):
        hold_all(lower[r], upper[r], high, columns, held)
        for t in range(of.size):
            if held[t]:
                if of[t] == level[r]:
                    right[r] += count[t]
                else:
                    wrong[r] += count[t]


@kernel
def decide(
    boxes: tuple[Array, Array, Array],
    action: Integers,
    prediction: Array,
    weight: Array,
    columns: Array,
    best: Integers,
    expected: Array,
    voters: Integers,
) -> None:
    """Fill best (T,), expected (T, A) and voters (T, A) for inputs (n, T)."""
    lower, upper, high = boxes
    actions = expected.shape[1]
    total = np.zeros(expected.shape)
    held = np.zeros(BLOCK, np.bool_)
    for first in range(0, best.size, BLOCK):
        some = np.ascontiguousarray(columns[:, first : first + BLOCK])
        for r in range(action.size):
            hold_all(lower[r], upper[r], high, some, held[: some.shape[1]])
            for k in range(some.shape[1]):
                if held[k]:
                    total[first + k, action[r]] += weight[r]
                    expected[first + k, action[r]] += weight[r] * prediction[r]
                    voters[first + k, action[r]] += 1
    for t in range(best.size):
        unknown = False
        for a in range(actions):
            unknown |= voters[t, a] == 0
            expected[t, a] = expected[t, a] / total[t, a] if voters[t, a] > 0 else np.nan
            if expected[t, a] > expected[t, best[t]]:
                best[t] = a
        if unknown:
            best[t] = -1

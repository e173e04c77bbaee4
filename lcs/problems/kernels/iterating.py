"""Value iteration over a grid of the square, compiled."""

import numpy as np

from lcs.arrays import Array
from lcs.compiled import kernel, part
from lcs.problems.kernels.plane import Square, moved, step


@part
def between(value: Array, x: Array) -> float:
    """The value at a place (2,), linear between the four grid points around it."""
    cells = len(value) - 1
    u, v = x[0] * cells, x[1] * cells
    i, j = min(int(u), cells - 1), min(int(v), cells - 1)
    u, v = u - i, v - j
    low = (1.0 - v) * value[i, j] + v * value[i, j + 1]
    high = (1.0 - v) * value[i + 1, j] + v * value[i + 1, j + 1]
    return float((1.0 - u) * low + u * high)


@part
def lead_to(
    square: Square, value: Array, x: Array, action: int, noises: Array, shares: Array, after: Array
) -> float:
    """The expected return of an action and what follows; noises (K,) occur with `shares` (K,)."""
    total = 0.0
    for k in range(noises.size):
        for m in range(noises.size):
            reward, ends = moved(square, x, action, noises[k], noises[m], after)
            total += shares[k] * shares[m] * (reward if ends else reward + between(value, after))
    return total


@kernel
def iterate(square: Square, value: Array, noises: Array, shares: Array, near: float) -> int:
    """Value iteration in place, value (G, G) for x and y, until no value changes by `near`.

    Sweeps begin at the goal's corner. How many there were.
    """
    cells = len(value) - 1
    x, after = np.empty(2), np.empty(2)
    sweeps, change = 0, np.inf
    while change > near:
        change = 0.0
        for i in range(cells, -1, -1):
            for j in range(cells, -1, -1):
                x[0], x[1] = i / cells, j / cells
                if x[0] + x[1] > square.goal:
                    continue
                best = -np.inf
                for action in range(len(square.moves)):
                    led = lead_to(square, value, x, action, noises, shares, after)
                    best = max(best, led)
                change = max(change, abs(best - value[i, j]))
                value[i, j] = best
        sweeps += 1
    return sweeps


@kernel
def follow(
    square: Square,
    value: Array,
    noises: Array,
    shares: Array,
    starts: Array,
    longest: int,
    told: Array,
    outside: np.random.Generator,
) -> None:
    """The actions that lead to most, from each start (E, 2); told (E, 2): steps and return."""
    x, after = np.empty(2), np.empty(2)
    for e in range(len(starts)):
        x[:] = starts[e]
        for _ in range(longest):
            best, taken = -np.inf, 0
            for action in range(len(square.moves)):
                led = lead_to(square, value, x, action, noises, shares, after)
                if led > best:
                    best, taken = led, action
            reward, ends = step(square, x, taken, outside, after)
            told[e, 0] += 1.0
            told[e, 1] += reward
            x[:] = after
            if ends:
                break

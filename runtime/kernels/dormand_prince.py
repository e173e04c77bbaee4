"""Dormand and Prince's pair of orders 5 and 4, with dense output of order 4: stages and errors.

w: the work space, its rows as in `blocks`. The rates of stage s stand from row k + s n on.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.kernels.blocks import LARGEST, STAGES, Places, begin_dense, is_finite
from runtime.kernels.cache import inlined, part

# J. R. Dormand, P. J. Prince, A family of embedded Runge-Kutta formulae, J. Comput. Appl. Math.
# 6 (1980) 19-26: RK5(4)7M. The last row is the solution of order 5.
TABLEAU: Final = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1 / 5, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3 / 40, 9 / 40, 0.0, 0.0, 0.0, 0.0],
        [44 / 45, -56 / 15, 32 / 9, 0.0, 0.0, 0.0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0.0, 0.0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0.0],
        [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
# The difference to the embedded solution of order 4.
ERROR: Final = np.array(
    [71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40]
)
# L. F. Shampine, Some practical Runge-Kutta formulas, Math. Comp. 46 (1986) 135-150; in the form
# of Hairer, Norsett, Wanner (program DOPRI5, array D).
DENSE: Final = np.array(
    [
        -12715105075 / 11282082432,
        0.0,
        87487479700 / 32700410799,
        -10690763975 / 1880347072,
        701980252875 / 199316789632,
        -1453857185 / 822651844,
        69997945 / 29380423,
    ]
)


EDGE: Final = 1e-9
"""Part of a domain's width that counts as its edge, where steps cannot cross it."""


@inlined
def set_stage(w: Array, at: Places, moving: Integers, stage: int, lanes: int) -> None:
    """Put the states at which a stage takes its rates into the register."""
    for j in range(moving.shape[0]):
        i = moving[j]
        for lane in range(lanes):
            w[i, lane] = 0.0
        for before in range(stage):
            weight = TABLEAU[stage, before]
            k = at.k + before * at.n + i
            for lane in range(lanes):
                w[i, lane] += weight * w[k, lane]
        for lane in range(lanes):
            w[i, lane] = w[at.x + i, lane] + w[at.h, lane] * w[i, lane]


@part
def step_error(
    w: Array, at: Places, moving: Integers, atol: Array, rtol: float, lane: int
) -> float:
    """The largest error of a state in units of its tolerance; NaN where it is not finite."""
    largest = 0.0
    for j in range(moving.shape[0]):
        i = moving[j]
        error = 0.0
        for stage in range(STAGES):
            error += ERROR[stage] * w[at.k + stage * at.n + i, lane]
        size = max(abs(w[at.x + i, lane]), abs(w[at.new + i, lane]))
        error = abs(error * w[at.h, lane]) / (atol[i] + rtol * size)
        if not error <= largest:
            largest = error
    return largest if is_finite(w, at.new, at.n, lane) else np.nan


@part
def set_dense(w: Array, at: Places, moving: Integers, lane: int) -> None:
    """The polynomial of order 4 through the step."""
    begin_dense(w, at, moving, lane, at.k + (STAGES - 1) * at.n)
    for j in range(moving.shape[0]):
        i = moving[j]
        total = 0.0
        for stage in range(STAGES):
            total += DENSE[stage] * w[at.k + stage * at.n + i, lane]
        w[at.dense + 5 * i + 4, lane] = w[at.h, lane] * total


@part
def may_leave(w: Array, at: Places, domain: Array, moving: Integers, lane: int) -> bool:
    """Whether a step with both ends inside is so near an edge that it could bulge out of it."""
    for j in range(moving.shape[0]):
        i = moving[j]
        x, new = w[at.x + i, lane], w[at.new + i, lane]
        last = at.k + (STAGES - 1) * at.n
        slopes = abs(w[at.k + i, lane]) + abs(w[last + i, lane])
        bulge = 0.5 * abs(w[at.h, lane]) * slopes
        if min(x, new) - bulge < domain[0, i] or max(x, new) + bulge > domain[1, i]:
            return True
    return False


@part
def first_step(
    w: Array, at: Places, moving: Integers, atol: Array, rtol: float, lane: int
) -> float:
    """A hundredth of the time in which the state would double (Hairer, Norsett, Wanner II.4)."""
    size = 0.0
    speed = 0.0
    for j in range(moving.shape[0]):
        i = moving[j]
        scale = atol[i] + rtol * abs(w[at.x + i, lane])
        size = max(size, abs(w[at.x + i, lane]) / scale)
        speed = max(speed, abs(w[at.k + i, lane]) / scale)
    return 0.01 * size / speed if size > 1e-5 and speed > 1e-5 else 1e-6


@part
def edge_ahead(w: Array, at: Places, domain: Array, moving: Integers, lane: int) -> int:
    """The first state that is at an edge of its domain, on its way out; else -1."""
    for j in range(moving.shape[0]):
        i = int(moving[j])
        low, high, x = domain[0, i], domain[1, i], w[at.x + i, lane]
        rate = w[at.k + i, lane] * w[at.h, lane]
        near = EDGE * (high - low)
        if low == -LARGEST:
            continue
        if (rate < 0.0 and x - low < near) or (rate > 0.0 and high - x < near):
            return i
    return -1

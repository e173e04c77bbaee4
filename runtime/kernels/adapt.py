"""Adaptive steps, compiled: Dormand and Prince's 5(4) pair with dense output of order 4.

Every lane has its own time and step; a lane whose trajectory has ended takes the next one, so a
block stays full, and a trajectory's numbers do not depend on the others.
"""
# ruff: noqa: PLR0917 - kernels take arguments by place

import math
from typing import Final, NamedTuple

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.kernels.blocks import (
    COMPLETED,
    DIVERGED,
    LEFT_DOMAIN,
    STAGES,
    TOO_MANY_STEPS,
    Block,
    Domain,
    Results,
    blank,
    end,
    end_at,
    first_exit,
    is_finite,
    load,
    nearer_side,
    new_block,
    outside,
    point,
    side_of,
    take_rates,
)
from runtime.kernels.cache import kernel, part
from runtime.kernels.machine import run
from runtime.kernels.tape import LANES, Tape

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
# Step control: Hairer, Norsett, Wanner II.4 and IV.2 (PI controller, Gustafsson).
SAFETY, MEMORY, SHRINK, GROW = 0.9, 0.04, 0.2, 10.0
EXPONENT: Final = 0.2 - 0.75 * MEMORY


class Task(NamedTuple):
    """What every trajectory shares: sample times (T,), tolerances rtol and (n,) atol, limits."""

    times: Array
    atol: Array
    rtol: float
    most_steps: int


class Pace(NamedTuple):
    """Per lane: its trajectory, the next sample, steps tried, the last error, fresh, rejected."""

    trajectory: Integers
    sample: Integers
    tries: Integers
    error: Array
    fresh: Booleans
    rejected: Booleans


@kernel
def adapt(tape: Tape, domain: Domain, start: Array, task: Task, results: Results) -> None:
    """Integrate from the registers `start` (B, r) at the first time, forwards or backwards."""
    block = new_block(tape)
    pace = Pace(
        np.zeros(LANES, dtype=np.int64),
        np.zeros(LANES, dtype=np.int64),
        np.zeros(LANES, dtype=np.int64),
        np.zeros(LANES),
        np.zeros(LANES, dtype=np.bool_),
        np.zeros(LANES, dtype=np.bool_),
    )
    waiting = 0
    lanes = 0
    while True:
        lane = 0
        while lane < LANES:
            if lane < lanes and block.alive[lane]:
                lane += 1
            elif waiting < start.shape[0]:
                _take_up(block, pace, domain, lane, waiting, start, task, results)
                waiting += 1
                lanes = max(lanes, lane + 1)
            elif lane < lanes:
                lanes -= 1
                _move(block, pace, lanes, lane)
            else:
                break
        if lanes == 0:
            return
        _attempt(tape, block, pace, domain, task, lanes, results)
        for i in range(lanes):
            if block.alive[i]:
                _judge(block, pace, domain, task, i, results)


@part
def _take_up(
    block: Block,
    pace: Pace,
    domain: Domain,
    lane: int,
    b: int,
    start: Array,
    task: Task,
    results: Results,
) -> None:
    """Begin trajectory b in a lane; it ends at once outside the domain or where T = 1."""
    load(block, lane, start[b])
    block.t[lane] = task.times[0]
    pace.trajectory[lane] = b
    pace.sample[lane] = 1
    pace.tries[lane] = 0
    pace.error[lane] = 1e-4
    pace.fresh[lane] = True
    pace.rejected[lane] = False
    left = outside(block.rows, lane, 0, domain.lows.shape[0], domain)
    if left >= 0:
        side = side_of(block.rows[left, lane], domain.highs[left])
        _stop(block, pace, lane, LEFT_DOMAIN, left, side, results)
        blank(results, b, 0)
        return
    for i in range(block.x.shape[0]):
        results.states[b, 0, i] = block.x[i, lane]
    if task.times.shape[0] == 1:
        _stop(block, pace, lane, COMPLETED, -1, 0, results)


@part
def _stop(
    block: Block, pace: Pace, lane: int, code: int, variable: int, side: int, results: Results
) -> None:
    """End a lane where it is now."""
    b = pace.trajectory[lane]
    end(results, b, code, variable, side, block.t[lane])
    end_at(results, b, block.x, lane)
    blank(results, b, pace.sample[lane])
    block.alive[lane] = False


@part
def _move(block: Block, pace: Pace, source: int, lane: int) -> None:
    """Put what lane `source` does into `lane`."""
    for i in range(block.rows.shape[0]):
        block.rows[i, lane] = block.rows[i, source]
    for i in range(block.x.shape[0]):
        block.x[i, lane] = block.x[i, source]
        # Of the rates only the first are kept from step to step.
        block.k[0, i, lane] = block.k[0, i, source]
    block.t[lane] = block.t[source]
    block.h[lane] = block.h[source]
    block.alive[lane] = block.alive[source]
    pace.trajectory[lane] = pace.trajectory[source]
    pace.sample[lane] = pace.sample[source]
    pace.tries[lane] = pace.tries[source]
    pace.error[lane] = pace.error[source]
    pace.fresh[lane] = pace.fresh[source]
    pace.rejected[lane] = pace.rejected[source]


@part
def _attempt(
    tape: Tape,
    block: Block,
    pace: Pace,
    domain: Domain,
    task: Task,
    lanes: int,
    results: Results,
) -> None:
    """One step of every lane, from x to new with k[0] .. k[6]; k[0] is the last one's k[6]."""
    first = 1
    for lane in range(lanes):
        if pace.fresh[lane]:
            first = 0
    for stage in range(first, STAGES):
        if stage == 1:
            _choose_steps(block, pace, domain, task, lanes, results)
        _set_stage(block, domain.moving, stage, lanes)
        run(tape, block.rows, block.points, lanes)
        take_rates(tape, block, stage, lanes)
    for i in range(block.x.shape[0]):
        for lane in range(lanes):
            block.new[i, lane] = block.rows[i, lane]


@part
def _set_stage(block: Block, moving: Integers, stage: int, lanes: int) -> None:
    for j in range(moving.shape[0]):
        i = moving[j]
        for lane in range(lanes):
            block.rows[i, lane] = 0.0
        for before in range(stage):
            weight = TABLEAU[stage, before]
            for lane in range(lanes):
                block.rows[i, lane] += weight * block.k[before, i, lane]
        for lane in range(lanes):
            block.rows[i, lane] = block.x[i, lane] + block.h[lane] * block.rows[i, lane]


@part
def _choose_steps(
    block: Block,
    pace: Pace,
    domain: Domain,
    task: Task,
    lanes: int,
    results: Results,
) -> None:
    """First steps of fresh lanes, and no step beyond the last time."""
    final = task.times[-1]
    for lane in range(lanes):
        left = final - block.t[lane]
        if pace.fresh[lane]:
            pace.fresh[lane] = False
            block.h[lane] = math.copysign(_first_step(block, domain, task, lane), left)
            if not is_finite(block.k[0], lane):
                _stop(block, pace, lane, DIVERGED, -1, 0, results)
        if abs(block.h[lane]) * 1.01 >= abs(left):
            block.h[lane] = left


@part
def _first_step(block: Block, domain: Domain, task: Task, lane: int) -> float:
    """A hundredth of the time in which the state would double (Hairer, Norsett, Wanner II.4)."""
    size = 0.0
    speed = 0.0
    for j in range(domain.moving.shape[0]):
        i = domain.moving[j]
        scale = task.atol[i] + task.rtol * abs(block.x[i, lane])
        size = max(size, abs(block.x[i, lane]) / scale)
        speed = max(speed, abs(block.k[0, i, lane]) / scale)
    return 0.01 * size / speed if size > 1e-5 and speed > 1e-5 else 1e-6


@part
def _judge(
    block: Block, pace: Pace, domain: Domain, task: Task, lane: int, results: Results
) -> None:
    """Accept or reject a lane's step, and choose the next one's length."""
    h = block.h[lane]
    error = _error(block, domain, task, lane)
    pace.tries[lane] += 1
    if error <= 1.0:
        growth = error**EXPONENT / (SAFETY * pace.error[lane] ** MEMORY)
        growth = min(1.0 / SHRINK, max(1.0 / GROW, growth))
        if pace.rejected[lane]:
            growth = max(1.0, growth)
        pace.error[lane] = max(error, 1e-4)
        pace.rejected[lane] = False
        _accept(block, pace, domain, task, lane, results)
        block.h[lane] = h / growth
    else:
        # Also where the step met a number that is not finite: error is NaN or infinite then.
        shrink = error**EXPONENT / SAFETY
        block.h[lane] = h / shrink if shrink < 1.0 / SHRINK else h * SHRINK
        pace.rejected[lane] = True
        if block.t[lane] + 0.1 * block.h[lane] == block.t[lane]:
            _stop(block, pace, lane, DIVERGED, -1, 0, results)
    if block.alive[lane] and pace.tries[lane] >= task.most_steps:
        _stop(block, pace, lane, TOO_MANY_STEPS, -1, 0, results)


@part
def _error(block: Block, domain: Domain, task: Task, lane: int) -> float:
    """The largest error of a state in units of its tolerance; NaN where it is not finite."""
    largest = 0.0
    for j in range(domain.moving.shape[0]):
        i = domain.moving[j]
        error = 0.0
        for stage in range(STAGES):
            error += ERROR[stage] * block.k[stage, i, lane]
        size = max(abs(block.x[i, lane]), abs(block.new[i, lane]))
        error = abs(error * block.h[lane]) / (task.atol[i] + task.rtol * size)
        if not error <= largest:
            largest = error
    return largest if is_finite(block.new, lane) else np.nan


@part
def _accept(
    block: Block, pace: Pace, domain: Domain, task: Task, lane: int, results: Results
) -> None:
    """Give the samples within the step and go on to its end, or to where the domain is left."""
    n = block.x.shape[0]
    h = block.h[lane]
    final = task.times[-1]
    reached = final if h == final - block.t[lane] else block.t[lane] + h
    _set_dense(block, domain, lane)
    variable = outside(block.new, lane, 0, n, domain)
    theta = 1.0
    if variable >= 0 or _may_leave(block, domain, lane):
        theta, found = first_exit(block.dense, domain)
        variable = found if found >= 0 else variable
    _give_samples(block, pace, task, lane, theta, results)
    if variable >= 0:
        for i in range(n):
            block.x[i, lane] = point(block.dense, i, theta)
        block.t[lane] += theta * h
        side = nearer_side(block.x[variable, lane], variable, domain)
        _stop(block, pace, lane, LEFT_DOMAIN, variable, side, results)
        return
    for i in range(n):
        block.x[i, lane] = block.new[i, lane]
        block.k[0, i, lane] = block.k[STAGES - 1, i, lane]
    block.t[lane] = reached
    if pace.sample[lane] == task.times.shape[0]:
        _stop(block, pace, lane, COMPLETED, -1, 0, results)


@part
def _set_dense(block: Block, domain: Domain, lane: int) -> None:
    """The polynomial of order 4 through the step."""
    dense = block.dense
    h = block.h[lane]
    for i in range(block.x.shape[0]):
        dense[0, i] = block.x[i, lane]
        dense[1, i] = dense[2, i] = dense[3, i] = dense[4, i] = 0.0
    for j in range(domain.moving.shape[0]):
        i = domain.moving[j]
        dense[1, i] = block.new[i, lane] - block.x[i, lane]
        dense[2, i] = h * block.k[0, i, lane] - dense[1, i]
        dense[3, i] = dense[1, i] - h * block.k[STAGES - 1, i, lane] - dense[2, i]
        for stage in range(STAGES):
            dense[4, i] += h * DENSE[stage] * block.k[stage, i, lane]


@part
def _may_leave(block: Block, domain: Domain, lane: int) -> bool:
    """Whether a step with both ends inside is so near an edge that it could bulge out of it."""
    for j in range(domain.moving.shape[0]):
        i = domain.moving[j]
        x = block.x[i, lane]
        new = block.new[i, lane]
        slopes = abs(block.k[0, i, lane]) + abs(block.k[STAGES - 1, i, lane])
        bulge = 0.5 * abs(block.h[lane]) * slopes
        if min(x, new) - bulge < domain.lows[i] or max(x, new) + bulge > domain.highs[i]:
            return True
    return False


@part
def _give_samples(
    block: Block,
    pace: Pace,
    task: Task,
    lane: int,
    theta: float,
    results: Results,
) -> None:
    """The samples up to theta of the step."""
    b = pace.trajectory[lane]
    while pace.sample[lane] < task.times.shape[0]:
        place = (task.times[pace.sample[lane]] - block.t[lane]) / block.h[lane]
        if place > theta:
            return
        for i in range(block.x.shape[0]):
            exact = block.new[i, lane] if place == 1.0 else point(block.dense, i, place)
            results.states[b, pace.sample[lane], i] = exact
        pace.sample[lane] += 1

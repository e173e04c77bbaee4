"""Adaptive steps, compiled: Dormand and Prince's 5(4) pair with dense output of order 4.

Every lane has its own time and step; a lane whose trajectory has ended takes the next one, so a
block stays full, and a trajectory's numbers do not depend on the others.

pace: (5, LANES) per lane its trajectory, its next sample, how many steps were tried, whether its
first rates are still to be worked out, whether the last step was rejected.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from runtime.arrays import Array, Integers
from runtime.kernels.blocks import (
    COMPLETED,
    DIVERGED,
    LARGEST,
    LEFT_DOMAIN,
    STAGES,
    TOO_MANY_STEPS,
    Places,
    blank,
    copy_lane,
    copy_rows,
    first_exit,
    is_finite,
    load,
    note_end,
    note_exit,
    outsider,
    places_of,
    point,
    take_rates,
    work_space,
)
from runtime.kernels.cache import inlined, kernel, part
from runtime.kernels.dormand_prince import first_step, may_leave, set_dense, set_stage, step_error
from runtime.kernels.machine import run
from runtime.kernels.tape import LANES, Tape

# Step control: Hairer, Norsett, Wanner II.4 and IV.2 (PI controller, Gustafsson).
SAFETY, MEMORY, SHRINK, GROW = 0.9, 0.04, 0.2, 10.0
EXPONENT: Final = 0.2 - 0.75 * MEMORY
LEAST_ERROR: Final = 1e-4
EDGE: Final = 1e-9
"""Part of a domain's width that counts as its edge, where steps cannot cross it."""


TRAJECTORY, SAMPLE, TRIES, FRESH, REJECTED = range(5)


class Aim(NamedTuple):
    """When it ends, forwards or backwards; the relative tolerance; how many steps may be tried."""

    end: float
    rtol: float
    most_steps: int


@kernel
def adapt(
    tape: Tape,
    domain: Array,
    moving: Integers,
    start: Array,
    times: Array,
    atol: Array,
    rtol: float,
    most_steps: int,
    states: Array,
    ended: Array,
) -> None:
    """Integrate from the registers `start` (B, r) at times[0]; samples at times (T,).

    atol: (n,). Fills states (B, T, n) and ended (B, 4 + n).
    """
    at = places_of(tape)
    w = work_space(tape, at)
    pace = np.zeros((5, LANES), dtype=np.int64)
    aim = Aim(times[-1], rtol, most_steps)
    waiting = start.shape[0]
    lanes = start.shape[0] - waiting
    while True:
        for lane in range(LANES):
            while waiting > 0 and (lane >= lanes or w[at.alive, lane] == 0.0):
                b = start.shape[0] - waiting
                _take_up(w, at, pace, domain, lane, start, b, times, states, ended)
                waiting -= 1
                lanes = max(lanes, lane + 1)
        lanes = _close_ranks(w, at, pace, lanes)
        if lanes == 0:
            return
        _attempt(tape, w, at, pace, moving, atol, aim, lanes, states, ended)
        for i in range(lanes):
            if w[at.alive, i] != 0.0:
                _judge(w, at, pace, domain, moving, atol, aim, times, i, states, ended)


@part
def _take_up(
    w: Array,
    at: Places,
    pace: Integers,
    domain: Array,
    lane: int,
    start: Array,
    b: int,
    times: Array,
    states: Array,
    ended: Array,
) -> None:
    """Begin trajectory b in a lane; it ends at once outside the domain or where no time passes."""
    load(w, at, lane, start, b)
    w[at.t, lane] = times[0]
    w[at.error, lane] = LEAST_ERROR
    pace[TRAJECTORY, lane] = b
    pace[SAMPLE, lane] = 0
    pace[TRIES, lane] = 0
    pace[FRESH, lane] = 1
    pace[REJECTED, lane] = 0
    variable = outsider(w, at.register, domain, domain.shape[1], lane)
    if variable >= 0:
        _stop(w, at, pace, lane, LEFT_DOMAIN, states, ended)
        note_exit(variable, w[variable, lane], domain, ended, b)
        return
    for s in range(times.shape[0]):
        if times[s] != times[0]:
            return
        for i in range(at.n):
            states[b, s, i] = w[at.x + i, lane]
        pace[SAMPLE, lane] = s + 1
    _stop(w, at, pace, lane, COMPLETED, states, ended)


@part
def _stop(
    w: Array, at: Places, pace: Integers, lane: int, code: float, states: Array, ended: Array
) -> None:
    """End a lane where it is now."""
    b = pace[TRAJECTORY, lane]
    note_end(w, at, lane, code, ended, b)
    blank(states, b, pace[SAMPLE, lane])


@part
def _close_ranks(w: Array, at: Places, pace: Integers, lanes: int) -> int:
    """Move the living lanes together; how many there are."""
    living = 0
    for lane in range(lanes):
        if w[at.alive, lane] == 0.0:
            continue
        if living < lane:
            for i in range(w.shape[0]):
                w[i, living] = w[i, lane]
            for i in range(pace.shape[0]):
                pace[i, living] = pace[i, lane]
        living += 1
    return living


@inlined
def _attempt(
    tape: Tape,
    w: Array,
    at: Places,
    pace: Integers,
    moving: Integers,
    atol: Array,
    aim: Aim,
    lanes: int,
    states: Array,
    ended: Array,
) -> None:
    """One step of every lane, from x to new; its first rates are the last ones of the step before.

    Where a lane is fresh, all lanes work out their first rates: the same numbers again.
    """
    fresh = 0
    for lane in range(lanes):
        fresh += pace[FRESH, lane]
    for stage in range(0 if fresh else 1, STAGES):
        if stage == 1:
            _choose_steps(w, at, pace, moving, atol, aim, lanes, states, ended)
        set_stage(w, at, moving, stage, lanes)
        run(tape, w, lanes)
        take_rates(tape, w, at.k + stage * at.n, lanes)
    copy_rows(w, at.register, at.new, at.n, lanes)


@part
def _choose_steps(
    w: Array,
    at: Places,
    pace: Integers,
    moving: Integers,
    atol: Array,
    aim: Aim,
    lanes: int,
    states: Array,
    ended: Array,
) -> None:
    """First steps of fresh lanes, and no step beyond the end."""
    for lane in range(lanes):
        left = aim.end - w[at.t, lane]
        if pace[FRESH, lane] == 1:
            pace[FRESH, lane] = 0
            first = first_step(w, at, moving, atol, aim.rtol, lane)
            w[at.h, lane] = math.copysign(first, left)
            if not is_finite(w, at.k, at.n, lane):
                _stop(w, at, pace, lane, DIVERGED, states, ended)
        if abs(w[at.h, lane]) * 1.01 >= abs(left):
            w[at.h, lane] = left


@part
def _judge(
    w: Array,
    at: Places,
    pace: Integers,
    domain: Array,
    moving: Integers,
    atol: Array,
    aim: Aim,
    times: Array,
    lane: int,
    states: Array,
    ended: Array,
) -> None:
    """Accept or reject a lane's step, and choose the next one's length."""
    h = w[at.h, lane]
    error = step_error(w, at, moving, atol, aim.rtol, lane)
    pace[TRIES, lane] += 1
    if error <= 1.0:
        shrink = error**EXPONENT / (SAFETY * w[at.error, lane] ** MEMORY)
        shrink = min(1.0 / SHRINK, max(1.0 / GROW, shrink))
        if pace[REJECTED, lane] == 1:
            shrink = max(1.0, shrink)
        w[at.error, lane] = max(error, LEAST_ERROR)
        pace[REJECTED, lane] = 0
        _accept(w, at, pace, domain, moving, aim, times, lane, states, ended)
        w[at.h, lane] = h / shrink
    else:
        # Also where the step met a number that is not finite: the error is NaN or infinite then.
        shrink = error**EXPONENT / SAFETY
        w[at.h, lane] = h / shrink if shrink < 1.0 / SHRINK else h * SHRINK
        pace[REJECTED, lane] = 1
        if w[at.t, lane] + 0.1 * w[at.h, lane] == w[at.t, lane]:
            _stop_stuck(w, at, pace, domain, moving, lane, states, ended)
    if w[at.alive, lane] != 0.0 and pace[TRIES, lane] >= aim.most_steps:
        _stop(w, at, pace, lane, TOO_MANY_STEPS, states, ended)


@part
def _stop_stuck(
    w: Array,
    at: Places,
    pace: Integers,
    domain: Array,
    moving: Integers,
    lane: int,
    states: Array,
    ended: Array,
) -> None:
    """End a lane that cannot step on: at an edge of the domain on its way out, or within it.

    A formula may have no value beyond its domain (the root of a negative number), so that no step
    across the edge succeeds; what comes so near to it leaves the domain there.
    """
    for j in range(moving.shape[0]):
        i = moving[j]
        low, high, x = domain[0, i], domain[1, i], w[at.x + i, lane]
        rate = w[at.k + i, lane] * w[at.h, lane]
        near = EDGE * (high - low)
        if low == -LARGEST:
            continue
        if (rate < 0.0 and x - low < near) or (rate > 0.0 and high - x < near):
            _stop(w, at, pace, lane, LEFT_DOMAIN, states, ended)
            note_exit(i, x, domain, ended, pace[TRAJECTORY, lane])
            return
    _stop(w, at, pace, lane, DIVERGED, states, ended)


@part
def _accept(
    w: Array,
    at: Places,
    pace: Integers,
    domain: Array,
    moving: Integers,
    aim: Aim,
    times: Array,
    lane: int,
    states: Array,
    ended: Array,
) -> None:
    """Give the samples within the step and go on to its end, or to where the domain is left."""
    h = w[at.h, lane]
    reached = aim.end if h == aim.end - w[at.t, lane] else w[at.t, lane] + h
    variable = outsider(w, at.new, domain, at.n, lane)
    leaves = variable >= 0 or may_leave(w, at, domain, moving, lane)
    theta = 1.0
    if leaves or (times[pace[SAMPLE, lane]] - w[at.t, lane]) / h <= 1.0:
        set_dense(w, at, moving, lane)
    if leaves:
        theta, found = first_exit(w, at, lane, domain)
        variable = found if found >= 0 else variable
    _give_samples(w, at, pace, times, theta, lane, states)
    if variable >= 0:
        w[at.t, lane] += theta * h
        for i in range(at.n):
            w[at.x + i, lane] = point(w, at.dense + 5 * i, lane, theta)
        _stop(w, at, pace, lane, LEFT_DOMAIN, states, ended)
        value = w[at.x + variable, lane]
        note_exit(variable, value, domain, ended, pace[TRAJECTORY, lane])
        return
    w[at.t, lane] = reached
    copy_lane(w, at.new, at.x, at.n, lane)
    copy_lane(w, at.k + (STAGES - 1) * at.n, at.k, at.n, lane)
    if pace[SAMPLE, lane] == times.shape[0]:
        _stop(w, at, pace, lane, COMPLETED, states, ended)


@part
def _give_samples(
    w: Array, at: Places, pace: Integers, times: Array, theta: float, lane: int, states: Array
) -> None:
    """The samples up to theta of the step."""
    b = pace[TRAJECTORY, lane]
    while pace[SAMPLE, lane] < times.shape[0]:
        sample = pace[SAMPLE, lane]
        place = (times[sample] - w[at.t, lane]) / w[at.h, lane]
        if place > theta:
            return
        for i in range(at.n):
            exact = w[at.new + i, lane]
            states[b, sample, i] = (
                exact if place == 1.0 else point(w, at.dense + 5 * i, lane, place)
            )
        pace[SAMPLE, lane] = sample + 1

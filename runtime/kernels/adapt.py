"""Adaptive steps, compiled: Dormand and Prince's 5(4) pair with dense output of order 4.

Every lane has its own time and step; a lane whose trajectory has ended takes the next one, so a
block stays full, and a trajectory's numbers do not depend on the others. Where there are guards,
each step is searched for one that opens (`switching`).
"""

import math
from typing import Final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.kernels.blocks import (
    COMPLETED,
    DIVERGED,
    LEFT_DOMAIN,
    STAGES,
    TOO_MANY_STEPS,
    Places,
    copy_lane,
    copy_rows,
    first_exit,
    is_finite,
    note_exit,
    outsider,
    places_of,
    point,
    take_rates,
    work_space,
)
from runtime.kernels.cache import inlined, kernel, part
from runtime.kernels.dormand_prince import (
    edge_ahead,
    first_step,
    may_leave,
    set_dense,
    set_stage,
    step_error,
)
from runtime.kernels.events import Gates
from runtime.kernels.machine import fill_literals, run
from runtime.kernels.pace import (
    FRESH,
    GUARD,
    JUDGE,
    LEAST_ERROR,
    REJECTED,
    ROWS,
    SAMPLE,
    TASK,
    TRAJECTORY,
    TRIES,
    Aim,
    close_ranks,
    refill,
    stop,
)
from runtime.kernels.switching import find_events, look_at_starts, switch_all, with_room
from runtime.kernels.tape import LANES, Tape

# Step control: Hairer, Norsett, Wanner II.4 and IV.2 (PI controller, Gustafsson).
SAFETY, MEMORY, SHRINK, GROW = 0.9, 0.04, 0.2, 10.0
EXPONENT: Final = 0.2 - 0.75 * MEMORY


@kernel
def adapt(
    tape: Tape,
    gates: Gates,
    domain: Array,
    moving: Integers,
    start: Array,
    times: Array,
    atol: Array,
    rtol: float,
    most_steps: int,
    states: Array,
    ended: Array,
) -> Array:
    """Integrate from the registers `start` (B, r) at times[0]; samples at times (T,).

    atol: (n,). Fills states (B, T, n) and ended (B, 4 + n). Without guards in `gates` no mode
    switches; the switches are returned, as rows of the log.
    """
    at = places_of(tape)
    w = work_space(tape, at)
    v = np.zeros((gates.tape.rows, LANES))
    fill_literals(gates.tape, v)
    log, logged = np.empty((0, 4 + 2 * at.n)), np.zeros(1, dtype=np.int64)
    pace = np.zeros((ROWS, LANES), dtype=np.int64)
    aim = Aim(times[-1], rtol, most_steps)
    guarded = gates.ways.shape[0] > 0
    waiting = start.shape[0]
    lanes = start.shape[0] - waiting
    while True:
        if waiting > 0:
            waiting, lanes = refill(
                w, at, pace, domain, start, waiting, lanes, times, states, ended
            )
        lanes = close_ranks(w, at, pace, lanes)
        if lanes == 0:
            return log[: logged[0]]
        if guarded:
            log = with_room(log, logged[0])
            look_at_starts(gates, v, w, at, pace, lanes)
            switch_all(gates, v, w, at, pace, domain, times, lanes, states, ended, log, logged)
        _attempt(tape, w, at, pace, moving, atol, aim, lanes, states, ended)
        if guarded:
            find_events(gates, v, w, at, pace, domain, moving, atol, aim, lanes)
        _judge_all(w, at, pace, domain, moving, atol, aim, times, lanes, states, ended)
        if guarded:
            switch_all(gates, v, w, at, pace, domain, times, lanes, states, ended, log, logged)


@part
def _judge_all(
    w: Array,
    at: Places,
    pace: Integers,
    domain: Array,
    moving: Integers,
    atol: Array,
    aim: Aim,
    times: Array,
    lanes: int,
    states: Array,
    ended: Array,
) -> None:
    """Judge the steps of all living lanes but those that are to be repeated, or to jump at once."""
    for i in range(lanes):
        if w[at.alive, i] != 0.0 and pace[TASK, i] == JUDGE:
            _judge(w, at, pace, domain, moving, atol, aim, times, i, states, ended)


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
                stop(w, at, pace, lane, DIVERGED, states, ended)
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
        stop(w, at, pace, lane, TOO_MANY_STEPS, states, ended)


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
    i = edge_ahead(w, at, domain, moving, lane)
    if i >= 0:
        stop(w, at, pace, lane, LEFT_DOMAIN, states, ended)
        note_exit(i, w[at.x + i, lane], domain, ended, pace[TRAJECTORY, lane])
        return
    stop(w, at, pace, lane, DIVERGED, states, ended)


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
    """Give the samples within the step and go on to its end, an event, or the domain's edge."""
    if pace[GUARD, lane] >= 0:
        _go_to_event(w, at, pace, times, lane, states)
        return
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
        stop(w, at, pace, lane, LEFT_DOMAIN, states, ended)
        value = w[at.x + variable, lane]
        note_exit(variable, value, domain, ended, pace[TRAJECTORY, lane])
        return
    w[at.t, lane] = reached
    copy_lane(w, at.new, at.x, at.n, lane)
    copy_lane(w, at.k + (STAGES - 1) * at.n, at.k, at.n, lane)
    if pace[SAMPLE, lane] == times.shape[0]:
        stop(w, at, pace, lane, COMPLETED, states, ended)


@part
def _go_to_event(
    w: Array, at: Places, pace: Integers, times: Array, lane: int, states: Array
) -> None:
    """Give the samples before the event and go there; the step's polynomial is known."""
    theta = w[at.theta, lane]
    _give_samples(w, at, pace, times, theta, lane, states)
    w[at.t, lane] += theta * w[at.h, lane]
    for i in range(at.n):
        w[at.x + i, lane] = point(w, at.dense + 5 * i, lane, theta)


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

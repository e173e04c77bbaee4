"""Fixed steps, compiled: the classical Runge-Kutta method (Kutta 1901), and discrete-time maps.

Every trajectory has its own times; inputs are held during a step. A step of length 0 does nothing.
"""

from runtime.arrays import Array, Integers
from runtime.kernels.blocks import (
    COMPLETED,
    DIVERGED,
    LEFT_DOMAIN,
    Places,
    any_alive,
    are_inside,
    begin_dense,
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
from runtime.kernels.machine import run
from runtime.kernels.tape import LANES, Tape


@kernel
def march(
    tape: Tape,
    domain: Array,
    moving: Integers,
    start: Array,
    times: Array,
    inputs: Array,
    columns: Integers,
    is_map: int,
    states: Array,
    ended: Array,
) -> None:
    """Steps from the registers `start` (B, r); a map is iterated where `is_map` is 1.

    moving: the states that have a rate and no input. times: (B or 1, S + 1).
    inputs: (B or 1, S or 1, k) for the register's entries `columns`.
    Fills states (B, S + 1, n) and ended (B, 4 + n).
    """
    at = places_of(tape)
    w = work_space(tape, at)
    steps = times.shape[1] - 1
    for first in range(0, start.shape[0], LANES):
        lanes = min(LANES, start.shape[0] - first)
        for lane in range(lanes):
            load(w, at, lane, start, first + lane)
        for s in range(steps):
            _begin(w, at, times, inputs, columns, s, first, lanes)
            _keep(w, at, s, first, lanes, states)
            if not are_inside(w, at.register, domain, domain.shape[1], at.alive, lanes):
                _end_outside(w, at, domain, s, first, lanes, states, ended)
            if is_map == 1:
                _map_step(tape, w, at, moving, lanes)
            else:
                _runge_kutta_step(tape, w, at, moving, lanes)
            if not are_inside(w, at.new, domain, at.n, at.alive, lanes):
                if is_map == 0:
                    _rates_at_new(tape, w, at, lanes)
                _end_leaving(w, at, domain, moving, is_map, s, first, lanes, states, ended)
                if not any_alive(w, at, lanes):
                    break
            copy_rows(w, at.new, at.x, at.n, lanes)
            copy_rows(w, at.new, at.register, at.n, lanes)
        _complete(w, at, times, first, lanes, states, ended)


@inlined
def _begin(
    w: Array,
    at: Places,
    times: Array,
    inputs: Array,
    columns: Integers,
    s: int,
    first: int,
    lanes: int,
) -> None:
    """Take the step's time, length and inputs."""
    for lane in range(lanes):
        course = first + lane if times.shape[0] > 1 else 0
        w[at.t, lane] = times[course, s]
        step = times[course, s + 1] - times[course, s]
        w[at.h, lane] = step if w[at.alive, lane] != 0.0 else 0.0
    held = s if inputs.shape[1] > 1 else 0
    for j in range(columns.shape[0]):
        entry = columns[j]
        for lane in range(lanes):
            b = first + lane if inputs.shape[0] > 1 else 0
            if w[at.h, lane] != 0.0:
                w[entry, lane] = inputs[b, held, j]
            if entry < at.n:
                w[at.x + entry, lane] = w[entry, lane]


@inlined
def _keep(w: Array, at: Places, s: int, first: int, lanes: int, states: Array) -> None:
    for lane in range(lanes):
        if w[at.alive, lane] != 0.0:
            for i in range(at.n):
                states[first + lane, s, i] = w[at.x + i, lane]


@part
def _end_outside(
    w: Array,
    at: Places,
    domain: Array,
    s: int,
    first: int,
    lanes: int,
    states: Array,
    ended: Array,
) -> None:
    """End the lanes whose start or inputs are outside the domain; padding does not look."""
    for lane in range(lanes):
        variable = outsider(w, at.register, domain, domain.shape[1], lane)
        if w[at.h, lane] != 0.0 and variable >= 0:
            note_end(w, at, lane, LEFT_DOMAIN, ended, first + lane)
            note_exit(variable, w[variable, lane], domain, ended, first + lane)
            blank(states, first + lane, s)
            w[at.h, lane] = 0.0


@inlined
def _map_step(tape: Tape, w: Array, at: Places, moving: Integers, lanes: int) -> None:
    run(tape, w, lanes)
    take_rates(tape, w, at.k, lanes)
    copy_rows(w, at.x, at.new, at.n, lanes)
    for j in range(moving.shape[0]):
        i = moving[j]
        for lane in range(lanes):
            if w[at.h, lane] != 0.0:
                w[at.new + i, lane] = w[at.k + i, lane]


@inlined
def _runge_kutta_step(tape: Tape, w: Array, at: Places, moving: Integers, lanes: int) -> None:
    """From x to new; the first stage's rates stay in k, the next ones follow behind."""
    copy_rows(w, at.x, at.new, at.n, lanes)
    for stage in range(4):
        run(tape, w, lanes)
        k = at.k + min(stage, 1) * at.n
        take_rates(tape, w, k, lanes)
        weight = 1.0 / 3.0 if 0 < stage < 3 else 1.0 / 6.0
        reach = 1.0 if stage == 2 else 0.5
        for j in range(moving.shape[0]):
            i = moving[j]
            for lane in range(lanes):
                total = w[at.new + i, lane] if stage > 0 else 0.0
                w[at.new + i, lane] = total + weight * w[k + i, lane]
                w[i, lane] = w[at.x + i, lane] + reach * w[at.h, lane] * w[k + i, lane]
    for j in range(moving.shape[0]):
        i = moving[j]
        for lane in range(lanes):
            # A lane that rests stays as it is even where its rates are not finite.
            move = w[at.h, lane] * w[at.new + i, lane] if w[at.h, lane] != 0.0 else 0.0
            w[at.new + i, lane] = w[at.x + i, lane] + move


@part
def _rates_at_new(tape: Tape, w: Array, at: Places, lanes: int) -> None:
    copy_rows(w, at.new, at.register, at.n, lanes)
    run(tape, w, lanes)
    take_rates(tape, w, at.k + at.n, lanes)


@part
def _end_leaving(
    w: Array,
    at: Places,
    domain: Array,
    moving: Integers,
    is_map: int,
    s: int,
    first: int,
    lanes: int,
    states: Array,
    ended: Array,
) -> None:
    """End the lanes whose step left the domain or the finite numbers."""
    for lane in range(lanes):
        b = first + lane
        variable = outsider(w, at.new, domain, at.n, lane)
        if w[at.h, lane] == 0.0 or variable < 0:
            continue
        blank(states, b, s + 1)
        if not is_finite(w, at.new, at.n, lane):
            note_end(w, at, lane, DIVERGED, ended, b)
            continue
        if is_map == 1:
            w[at.t, lane] += w[at.h, lane]
            copy_lane(w, at.new, at.x, at.n, lane)
        else:
            begin_dense(w, at, moving, lane, at.k + at.n)
            theta, found = first_exit(w, at, lane, domain)
            variable = found if found >= 0 else variable
            w[at.t, lane] += theta * w[at.h, lane]
            for i in range(at.n):
                w[at.x + i, lane] = point(w, at.dense + 5 * i, lane, theta)
        note_end(w, at, lane, LEFT_DOMAIN, ended, b)
        note_exit(variable, w[at.x + variable, lane], domain, ended, b)


@inlined
def _complete(
    w: Array, at: Places, times: Array, first: int, lanes: int, states: Array, ended: Array
) -> None:
    last = times.shape[1] - 1
    _keep(w, at, last, first, lanes, states)
    for lane in range(lanes):
        if w[at.alive, lane] != 0.0:
            w[at.t, lane] = times[first + lane if times.shape[0] > 1 else 0, last]
            note_end(w, at, lane, COMPLETED, ended, first + lane)

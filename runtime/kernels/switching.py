"""Switches of mode in an adaptive integration: finding them, taking them, noting them.

log: (room, 4 + 2 n) per switch its trajectory, time, the modes left and entered, the states before
and after; logged: (1,) how many there are. The other arrays are those of `adapt` and `events`.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.kernels.blocks import (
    ARRIVED,
    CHATTERING,
    COMPLETED,
    DIVERGED,
    LEFT_DOMAIN,
    Places,
    first_exit,
    is_finite,
    note_exit,
    outsider,
    point,
)
from runtime.kernels.cache import part
from runtime.kernels.dormand_prince import edge_ahead, may_leave, set_dense, step_error
from runtime.kernels.events import CLOSE, MODE, TARGET, Gates, jump, open_guard, seek
from runtime.kernels.pace import (
    CUT,
    FRESH,
    GUARD,
    JUDGE,
    JUMP,
    LEAST_ERROR,
    NO_GUARD,
    NOT_LOOKED,
    REJECTED,
    SAMPLE,
    SWITCHES,
    TASK,
    TRAJECTORY,
    TRIES,
    TRY_AGAIN,
    Aim,
    stop,
)
from runtime.kernels.tape import LANES

MOST_SWITCHES: Final = 50
"""More of them in no time have no end."""
SHARE: Final = 1e-9
"""Part of the time since the start that counts as no time."""
SHARE_OF_RUN: Final = 1e-12
"""The same, as a part of the whole run."""
BEYOND: Final = 1e-9
"""Part of a step: a guard that opens so little beyond the domain's edge opens at the edge."""
WITHIN: Final = 1e-3
"""Part of a step from its ends in which its polynomial is as good as the ends are."""
HAIR: Final = 1e-12
"""Part of a step: so far beyond its surface, a guard that opens the other way is closed."""
NEARLY: Final = 2e-4
"""How closely an event is located before the step is cut there."""


@part
def find_events(
    gates: Gates,
    v: Array,
    w: Array,
    at: Places,
    pace: Integers,
    domain: Array,
    moving: Integers,
    atol: Array,
    aim: Aim,
    lanes: int,
) -> None:
    """Look for guards that open in the steps that were tried, and note what to do with each."""
    for lane in range(lanes):
        if w[at.alive, lane] != 0.0:
            pace[TASK, lane] = _find_event(
                gates, v, w, at, pace, domain, moving, atol, aim.rtol, lane
            )


@part
def _find_event(
    gates: Gates,
    v: Array,
    w: Array,
    at: Places,
    pace: Integers,
    domain: Array,
    moving: Integers,
    atol: Array,
    rtol: float,
    lane: int,
) -> int:
    """Look for a guard that opens in the step that was tried; what to do with the step.

    A step in whose midst one opens is repeated up to there: its end is more exact than its midst.
    """
    pace[GUARD, lane] = NO_GUARD
    if not step_error(w, at, moving, atol, rtol, lane) <= 1.0:
        return _find_at_edge(gates, v, w, at, pace, domain, moving, lane)
    set_dense(w, at, moving, lane)
    inside, limit = 1.0, 1.0
    if outsider(w, at.new, domain, at.n, lane) >= 0 or may_leave(w, at, domain, moving, lane):
        inside, variable = first_exit(w, at, lane, domain)
        limit = min(1.0, inside + BEYOND) if variable >= 0 else 1.0
    guard, low, high = seek(gates, v, w, at, lane, limit, NEARLY)
    if guard < 0:
        return JUDGE
    if pace[CUT, lane] == 0 and WITHIN < high < 1.0 - WITHIN:
        pace[CUT, lane] = 1
        pace[TRIES, lane] += 1
        w[at.h, lane] *= high
        return TRY_AGAIN
    guard, low, high = seek(gates, v, w, at, lane, limit, CLOSE)
    pace[CUT, lane] = 0
    pace[GUARD, lane] = guard
    # A section is reached where it has been crossed.
    w[at.theta, lane] = min(high if gates.ways[guard, MODE] < 0 else low, inside)
    w[at.beyond, lane] = high + HAIR if limit == 1.0 else min(high + HAIR, inside)
    return JUDGE


@part
def _find_at_edge(
    gates: Gates,
    v: Array,
    w: Array,
    at: Places,
    pace: Integers,
    domain: Array,
    moving: Integers,
    lane: int,
) -> int:
    """Where no step leads across an edge of the domain: whether a guard is open at the edge."""
    if w[at.t, lane] + 0.02 * w[at.h, lane] != w[at.t, lane]:
        return JUDGE
    state = edge_ahead(w, at, domain, moving, lane)
    if state < 0:
        return JUDGE
    before = w[at.x + state, lane]
    w[at.beyond, lane] = -1.0
    middle = 0.5 * domain[0, state] + 0.5 * domain[1, state]
    w[at.x + state, lane] = domain[0, state] if before < middle else domain[1, state]
    pace[GUARD, lane] = open_guard(gates, v, w, at, lane)
    if pace[GUARD, lane] >= 0:
        return JUMP
    w[at.x + state, lane] = before
    return JUDGE


@part
def look_at_starts(
    gates: Gates, v: Array, w: Array, at: Places, pace: Integers, lanes: int
) -> None:
    """Note the guards that are open where lanes begin their trajectories."""
    for lane in range(lanes):
        if pace[GUARD, lane] == NOT_LOOKED:
            pace[GUARD, lane] = open_guard(gates, v, w, at, lane)
            w[at.beyond, lane] = -1.0


@part
def switch_all(
    gates: Gates,
    v: Array,
    w: Array,
    at: Places,
    pace: Integers,
    domain: Array,
    times: Array,
    lanes: int,
    states: Array,
    ended: Array,
    log: Array,
    logged: Integers,
) -> None:
    """Take the guards that have opened."""
    for lane in range(lanes):
        if w[at.alive, lane] != 0.0 and pace[GUARD, lane] >= 0:
            _switch(gates, v, w, at, pace, domain, times, lane, states, ended, log, logged)


@part
def _switch(
    gates: Gates,
    v: Array,
    w: Array,
    at: Places,
    pace: Integers,
    domain: Array,
    times: Array,
    lane: int,
    states: Array,
    ended: Array,
    log: Array,
    logged: Integers,
) -> None:
    """Take the guard that has opened, and those that are open after its jump."""
    guard = pace[GUARD, lane]
    pace[GUARD, lane] = NO_GUARD
    while guard >= 0:
        if gates.ways[guard, MODE] < 0:
            stop(w, at, pace, lane, ARRIVED, states, ended)
            return
        if w[at.beyond, lane] < 0.0:
            _take(gates, v, w, at, pace, lane, guard, log[logged[0]])
        else:
            _take_located(gates, v, w, at, pace, domain, lane, guard, log[logged[0]])
        logged[0] += 1
        if not _goes_on(w, at, pace, domain, times, lane, states, ended):
            return
        if guard == gates.last:
            stop(w, at, pace, lane, ARRIVED, states, ended)
            return
        guard = open_guard(gates, v, w, at, lane)
    pace[FRESH, lane] = 1
    pace[REJECTED, lane] = 0
    w[at.error, lane] = LEAST_ERROR
    if not w[at.t, lane] < times[-1]:
        _complete(w, at, pace, times, lane, states, ended)


@part
def _take_located(
    gates: Gates,
    v: Array,
    w: Array,
    at: Places,
    pace: Integers,
    domain: Array,
    lane: int,
    guard: int,
    row: Array,
) -> None:
    """Take a guard that was located, from just before its surface, or a hair beyond it.

    After a jump from just before it, another guard is open still that opens on the other side of
    the same surface; then it is taken from beyond, unless something is open there, too.
    """
    beyond = w[at.beyond, lane]
    w[at.beyond, lane] = -1.0
    _take(gates, v, w, at, pace, lane, guard, row)
    if open_guard(gates, v, w, at, lane) < 0:
        return
    _go_to(w, at, lane, beyond)
    _take(gates, v, w, at, pace, lane, guard, row)
    if outsider(w, at.x, domain, at.n, lane) >= 0 or open_guard(gates, v, w, at, lane) >= 0:
        _go_to(w, at, lane, w[at.theta, lane])
        _take(gates, v, w, at, pace, lane, guard, row)


@part
def _go_to(w: Array, at: Places, lane: int, theta: float) -> None:
    """Go to a place of the step."""
    for i in range(at.n):
        w[at.x + i, lane] = point(w, at.dense + 5 * i, lane, theta)


@part
def _take(
    gates: Gates,
    v: Array,
    w: Array,
    at: Places,
    pace: Integers,
    lane: int,
    guard: int,
    row: Array,
) -> None:
    """Take a guard, and note it in a row of the log."""
    row[0] = pace[TRAJECTORY, lane]
    row[1] = w[at.t, lane]
    row[2] = w[at.x + gates.state, lane]
    row[3] = gates.ways[guard, TARGET]
    for i in range(at.n):
        row[4 + i] = w[at.x + i, lane]
    jump(gates, v, w, at, lane, guard)
    for i in range(at.n):
        row[4 + at.n + i] = w[at.x + i, lane]


@part
def _goes_on(
    w: Array,
    at: Places,
    pace: Integers,
    domain: Array,
    times: Array,
    lane: int,
    states: Array,
    ended: Array,
) -> bool:
    """Whether a lane goes on after a jump: in the domain, and not one of ever more in no time."""
    if not is_finite(w, at.x, at.n, lane):
        stop(w, at, pace, lane, DIVERGED, states, ended)
        return False
    variable = outsider(w, at.x, domain, at.n, lane)
    if variable >= 0:
        stop(w, at, pace, lane, LEFT_DOMAIN, states, ended)
        note_exit(variable, w[at.x + variable, lane], domain, ended, pace[TRAJECTORY, lane])
        return False
    now = w[at.t, lane]
    no_time = SHARE * (now - times[0]) + SHARE_OF_RUN * (times[-1] - times[0])
    if pace[SWITCHES, lane] == 0 or now - w[at.since, lane] > no_time:
        w[at.since, lane] = now
        pace[SWITCHES, lane] = 0
    pace[SWITCHES, lane] += 1
    if pace[SWITCHES, lane] > MOST_SWITCHES:
        stop(w, at, pace, lane, CHATTERING, states, ended)
        return False
    return True


@part
def _complete(
    w: Array, at: Places, pace: Integers, times: Array, lane: int, states: Array, ended: Array
) -> None:
    """The last samples of a lane that has switched at the very end."""
    for sample in range(pace[SAMPLE, lane], times.shape[0]):
        for i in range(at.n):
            states[pace[TRAJECTORY, lane], sample, i] = w[at.x + i, lane]
        pace[SAMPLE, lane] = sample + 1
    stop(w, at, pace, lane, COMPLETED, states, ended)


@part
def with_room(log: Array, logged: int) -> Array:
    """The log, with room for what may happen in all lanes until it is looked at again."""
    needed = logged + 2 * LANES * (MOST_SWITCHES + 2)
    if needed <= log.shape[0]:
        return log
    larger = np.empty((2 * needed, log.shape[1]))
    larger[:logged] = log[:logged]
    return larger

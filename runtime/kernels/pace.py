"""How far each lane of an adaptive integration is, how it begins and how it ends.

pace: (9, LANES) per lane its trajectory, its next sample, how many steps were tried, whether its
first rates are still to be worked out, whether the last step was rejected. Where there are guards,
also the one that opens in the step (or `NO_GUARD`, or `NOT_LOOKED` at the start), whether the step
was cut to end where one opens, how many switches followed one another in no time, and what to do
with the step that was tried: judge it, repeat it as long as it is now, or jump from where it began.
"""

from typing import Final, NamedTuple

from runtime.arrays import Array, Integers
from runtime.kernels.blocks import (
    COMPLETED,
    LEFT_DOMAIN,
    Places,
    blank,
    load,
    note_end,
    note_exit,
    outsider,
)
from runtime.kernels.cache import part
from runtime.kernels.tape import LANES

LEAST_ERROR: Final = 1e-4
TRAJECTORY, SAMPLE, TRIES, FRESH, REJECTED, GUARD, CUT, SWITCHES, TASK = range(9)
ROWS: Final = 9
NO_GUARD, NOT_LOOKED = -1, -2
JUDGE, TRY_AGAIN, JUMP = range(3)


class Aim(NamedTuple):
    """When it ends, forwards or backwards; the relative tolerance; how many steps may be tried."""

    end: float
    rtol: float
    most_steps: int


@part
def refill(
    w: Array,
    at: Places,
    pace: Integers,
    domain: Array,
    start: Array,
    waiting: int,
    lanes: int,
    times: Array,
    states: Array,
    ended: Array,
) -> tuple[int, int]:
    """Give free lanes to waiting trajectories; how many wait still, and the lanes in use."""
    for lane in range(LANES):
        while waiting > 0 and (lane >= lanes or w[at.alive, lane] == 0.0):
            b = start.shape[0] - waiting
            _take_up(w, at, pace, domain, lane, start, b, times, states, ended)
            waiting -= 1
            lanes = max(lanes, lane + 1)
    return waiting, lanes


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
    for i in range(ROWS):
        pace[i, lane] = 0
    w[at.t, lane] = times[0]
    w[at.error, lane] = LEAST_ERROR
    pace[TRAJECTORY, lane] = b
    pace[FRESH, lane] = 1
    pace[GUARD, lane] = NOT_LOOKED
    variable = outsider(w, at.register, domain, domain.shape[1], lane)
    if variable >= 0:
        stop(w, at, pace, lane, LEFT_DOMAIN, states, ended)
        note_exit(variable, w[variable, lane], domain, ended, b)
        return
    for s in range(times.shape[0]):
        if times[s] != times[0]:
            return
        for i in range(at.n):
            states[b, s, i] = w[at.x + i, lane]
        pace[SAMPLE, lane] = s + 1
    stop(w, at, pace, lane, COMPLETED, states, ended)


@part
def stop(
    w: Array, at: Places, pace: Integers, lane: int, code: float, states: Array, ended: Array
) -> None:
    """End a lane where it is now; it asks for nothing more."""
    pace[FRESH, lane] = 0
    b = pace[TRAJECTORY, lane]
    note_end(w, at, lane, code, ended, b)
    blank(states, b, pace[SAMPLE, lane])


@part
def close_ranks(w: Array, at: Places, pace: Integers, lanes: int) -> int:
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

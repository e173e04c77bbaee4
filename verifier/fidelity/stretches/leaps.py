"""Switches of a mode to itself, which no log of the mode shows: jumps of states tell them.

Between two samples of the time base a robot has leaped where a state that such a way resets is far
from what the mode's own field makes of it, and near to what the reset does. M: samples of the
time base; n: states.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.flow import Flow, flow_of, registers
from runtime.integrators import rk4
from runtime.machine import evaluate
from runtime.program import Guard, Program

CLEAR: Final = 6.0
"""A jump is clear of so many robust deviations of the errors of one sample period."""
HALF: Final = 0.5
"""And the reset leaves at most this share of the error."""
LEAST: Final = 1e-6
"""Errors below this share of the domain are rounding."""
FEW: Final = 8


def leaps_in(
    program: Program, times: Array, states: Array, controls: Array
) -> tuple[Integers, Integers]:
    """The steps (k,) in which the robot took a way from a mode to itself, and those modes (k,).

    times (M,), states (M, n) as measured, controls (M, p). Step i leads to sample i + 1.
    """
    own = [guard for guard in program.field.guards if guard.mode == guard.target]
    if not own or len(times) < FEW:
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    flow = flow_of(program)
    names = [state.name for state in program.states]
    modes = np.rint(states[:-1, names.index(program.field.mode)]).astype(np.int64)
    steps = np.column_stack([times[:-1], (times[:-1] + times[1:]) / 2.0, times[1:]])
    path = _run(flow, states[:-1], controls[:-1], steps)
    error = states[1:] - path[:, 2]
    widths = np.array([max(state.high - state.low, 1e-300) for state in program.states])
    usual = 1.4826 * np.nanmedian(np.abs(error), axis=0) + LEAST * widths
    leaped = np.zeros(len(steps), dtype=bool)
    for guard in own:
        after = np.array(path[:, 1])
        columns = [names.index(name) for name, _ in guard.resets]
        after[:, columns] = _reset(flow, guard, path[:, 1], controls[:-1])
        left = states[1:] - _run(flow, after, controls[:-1], steps[:, 1:])[:, 1]
        leaped |= (modes == guard.mode) & _is_clear(
            error[:, columns], left[:, columns], usual[columns]
        )
    found = np.flatnonzero(leaped)
    return found, modes[found]


def _is_clear(error: Array, left: Array, usual: Array) -> Booleans:
    """Whether (M - 1,) some reset state is off without the jump, and far less so with it."""
    off = np.nan_to_num(np.abs(error)) > CLEAR * usual
    return np.asarray(np.any(off & (np.abs(left) < HALF * np.abs(error)), axis=1))


def _run(flow: Flow, start: Array, controls: Array, times: Array) -> Array:
    n, p = len(flow.program.states), len(flow.program.controls)
    return rk4(flow, start, times, controls[:, np.newaxis], np.arange(n, n + p))


def _reset(flow: Flow, guard: Guard, states: Array, controls: Array) -> Array:
    register = registers(flow, states, controls)
    return evaluate([code for _, code in guard.resets], flow.program.register, register)

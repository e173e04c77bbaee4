"""The values of all guards in given states, and what changes them.

T: points; n: states; q: guards. At a knot, inputs are those held until there.
"""

import numpy as np

from runtime.arrays import Array, Integers
from runtime.machine import evaluate
from verifier.fidelity.shooting.jumps import register_under
from verifier.fidelity.switching.setting import Setting


def guards_at(setting: Setting, states: Array, knots: Integers) -> Array:
    """The guards (T, q) in states (T, n) at `knots` (T,)."""
    grid = setting.model.grid
    inputs = grid.inputs[np.maximum(knots - 1, 0)]
    register = register_under(setting.flow, states, inputs, grid.columns)
    codes = [guard.condition for guard in setting.guards]
    return evaluate(codes, setting.program.register, register)


def changed_by(setting: Setting, states: Array, knots: Integers, shift: tuple[int, float]) -> Array:
    """By how much guards change (T, q) when one state is `shift` = (column, by) elsewhere."""
    up, down = np.array(states), np.array(states)
    up[:, shift[0]] += shift[1]
    down[:, shift[0]] -= shift[1]
    return np.abs(guards_at(setting, up, knots) - guards_at(setting, down, knots)) / 2.0


def room_at(setting: Setting, states: Array, knots: Integers) -> Array:
    """What the tolerances of all states together change in the guards (T, q)."""
    room = np.zeros((len(states), len(setting.guards)))
    for each, tolerance in zip(setting.samples, setting.tolerance, strict=True):
        if np.isfinite(tolerance):
            room += changed_by(setting, states, knots, (each.column, float(tolerance)))
    return room

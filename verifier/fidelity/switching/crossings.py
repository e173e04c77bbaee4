"""When the model takes a way out of its mode: guards along predicted paths.

B: paths; S: steps; n: states; q: guards. A crossing is where a guard's value turns from negative
to zero or more: between two knots where states carry it over, at a knot where an input does.
"""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.machine import evaluate
from verifier.fidelity.shooting.jumps import register_under
from verifier.fidelity.switching.setting import Setting, inputs_at


@final
@dataclass(frozen=True, eq=False, slots=True)
class GuardPaths:
    """Values of all guards at the knots of paths, all (B, S + 1, q).

    before: with the inputs as held until the knot; after: with those from the knot on.
    times (B, S + 1): of the knots.
    """

    times: Array
    before: Array
    after: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class Opening:
    """Where one guard first opens along each path (B,).

    times: infinite where it does not. steps: the knot after which (or, by an input, at which) it
    does. speed: how fast its value rises there; infinite where an input opens it. was_open: at
    the very beginning, where `times` is extrapolated.
    """

    times: Array
    steps: Integers
    speed: Array
    was_open: Booleans


def guard_paths(setting: Setting, paths: Array, knots: Integers, modes: Array) -> GuardPaths:
    """The guards along paths (B, S + 1, n) at knots (B, S + 1), each in one mode (B,)."""
    codes = [guard.condition for guard in setting.guards]
    columns = setting.model.grid.columns
    found = []
    for shift in (1, 0):
        inputs = inputs_at(setting, np.maximum(knots - shift, knots[:, :1]), modes)
        register = register_under(setting.flow, paths, inputs, columns)
        _unwind(setting, register, paths)
        found.append(evaluate(codes, setting.program.register, register))
    return GuardPaths(setting.model.grid.times[knots], found[0], found[1])


def opening_of(along: GuardPaths, guards: Integers) -> Opening:
    """The first opening of the guard `guards` (B,) along each path."""
    rows = np.arange(len(guards))
    before, after = along.before[rows, :, guards], along.after[rows, :, guards]
    by_state = (after[:, :-1] < 0.0) & (before[:, 1:] >= 0.0)
    by_input = (before[:, 1:] < 0.0) & (after[:, 1:] >= 0.0)
    opens = by_state | by_input
    never = ~np.any(opens, axis=1)
    step = np.argmax(opens, axis=1)
    start, end = along.times[rows, step], along.times[rows, step + 1]
    low, high = after[rows, step], before[rows, step + 1]
    rise = np.where(end > start, (high - low) / np.maximum(end - start, 1e-12), 0.0)
    share = np.clip(-low / np.where(high > low, high - low, 1.0), 0.0, 1.0)
    states = by_state[rows, step]
    times = np.where(states, start + share * (end - start), end)
    speed = np.where(states, rise, np.inf)
    return _with_open_ones(along, (before, after), Opening(times, step, speed, never))


def _with_open_ones(along: GuardPaths, values: tuple[Array, Array], found: Opening) -> Opening:
    """Extrapolated back to its opening where a guard is open at the beginning and rises."""
    before, after = values
    never = found.was_open
    was_open = after[:, 0] >= 0.0
    step = np.maximum(along.times[:, 1] - along.times[:, 0], 1e-12)
    rise = (before[:, 1] - after[:, 0]) / step
    earlier = along.times[:, 0] - after[:, 0] / np.where(rise > 0.0, rise, np.inf)
    times = np.where(was_open, earlier, np.where(never, np.inf, found.times))
    speed = np.where(was_open, np.where(rise > 0.0, rise, np.inf), found.speed)
    return Opening(times, np.where(was_open, 0, found.steps), speed, was_open)


def _unwind(setting: Setting, register: Array, paths: Array) -> None:
    """Angles that start within their domain go on beyond it, so that no guard sees the seam."""
    for each in setting.samples:
        if each.turn > 0.0:
            turns = np.rint((register[:, :1, each.column] - paths[:, :1, each.column]) / each.turn)
            register[..., each.column] = paths[..., each.column] + turns * each.turn

"""Predictions through a switch of the mode: the time is the robot's, the jump is the spec's.

The mode is an input, so the model changes its mode when the robot did; what the guard resets, jumps
there as the spec says. A guard that the robot crossed early or late is thus no error of a state:
its time is judged by itself (`verifier.fidelity.switching`).

K: predictions; n: states; G: knots of the grid.
"""

import numpy as np

from runtime.arrays import Array, Integers
from runtime.flow import Flow, registers
from runtime.machine import evaluate
from runtime.program import Guard, Program
from verifier.fidelity.shooting.grid import Grid
from verifier.fidelity.stretches.segments import on_circle


def switch_knots(flow: Flow, grid: Grid) -> Integers:
    """The knots from which another mode holds than before, or the same one anew."""
    modes = modes_at(flow.program, grid)
    return np.union1d(np.flatnonzero(np.diff(modes) != 0.0) + 1, grid.leaps)


def modes_at(program: Program, grid: Grid) -> Array:
    """The mode (G,) that holds from each knot on; that at rest where no input tells it."""
    column = mode_column(program, grid)
    if column >= 0:
        return np.asarray(grid.inputs[:, column])
    rest = next((s.hold for s in program.states if s.name == program.field.mode), 0.0)
    return np.full(len(grid.times), rest)


def mode_column(program: Program, grid: Grid) -> int:
    """Which of the grid's inputs is the mode; -1 where none tells it."""
    names = [program.register[column] for column in grid.columns]
    return names.index(program.field.mode) if program.field.mode in names else -1


def jumped(flow: Flow, grid: Grid, states: Array, knots: Integers) -> Array:
    """The states (K, n) after the switches at `knots` (K,), from those just before them.

    Of several guards between the same two modes, that one counts which is nearest to opening, or
    furthest open. Where the spec has none, nothing jumps.
    """
    modes = modes_at(flow.program, grid)
    left, entered = modes[knots - 1], modes[knots]
    after = np.array(states)
    for way in sorted(set(zip(left, entered, strict=True))):
        here = (left == way[0]) & (entered == way[1])
        guards = [g for g in flow.program.field.guards if (g.mode, g.target) == way]
        if guards:
            inputs = grid.inputs[knots[here] - 1]
            register = register_under(flow, states[here], inputs, grid.columns)
            after[here] = reset_by(flow.program, guards, register, states[here])
    return after


def register_under(flow: Flow, states: Array, inputs: Array, columns: Integers) -> Array:
    """The register (..., r) in which guards are read: angles within their domain.

    states (..., n); inputs (..., k) of the register's `columns` (k,).
    """
    program = flow.program
    defaults = flow.defaults[len(program.states) : len(program.states) + len(program.controls)]
    register = registers(flow, states, defaults)
    register[..., columns] = inputs
    for index, state in enumerate(program.states):
        register[..., index] = on_circle(state, register[..., index])
    return register


def reset_by(program: Program, guards: list[Guard], register: Array, states: Array) -> Array:
    """The states (K, n) after the jump of one of `guards`, from those before it.

    register (K, r): before it, too, with angles within their domain.
    """
    values = evaluate([guard.condition for guard in guards], program.register, register)
    chosen = np.argmax(values, axis=-1)
    names = [state.name for state in program.states]
    after = np.array(states)
    for index, guard in enumerate(guards):
        here = chosen == index
        if guard.resets and np.any(here):
            codes = [code for _, code in guard.resets]
            columns = [names.index(name) for name, _ in guard.resets]
            after[np.ix_(here, columns)] = evaluate(codes, program.register, register[here])
    return after

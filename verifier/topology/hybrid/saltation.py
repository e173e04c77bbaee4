"""The linearised hybrid flow along a cycle: smooth pieces, and at each switch a saltation matrix.

A displaced trajectory meets the guard a little earlier or later, so a switch takes displacements
by S = R + (f' - R f) grad(g)^T / (grad(g) . f): R derivative of the reset, f and f' rates before
and after, g the guard's condition (Leine and Nijmeijer 2004, section 7.3).

m: number of axes; n: of states.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array
from runtime.flow import in_one_mode, rates, registers
from runtime.machine import evaluate
from runtime.program import Guard
from runtime.rollout import Switches
from verifier.topology.hybrid.flow import EXACT, Hybrid, conditions, followed, on_axes, points_in
from verifier.topology.slices import shortest

NUDGE: Final = 1e-5
"""How far points are displaced, in widths."""


def monodromy(hybrid: Hybrid, start: Array, switches: Switches) -> Array:
    """What a round does to displacements (m, m), in widths, from the state (n,) after a switch."""
    whole = np.eye(len(hybrid.view.axes))
    state, time = start, 0.0
    for i in range(len(switches)):
        guard = _guard(hybrid, switches, i)
        whole = _smooth(hybrid, state, switches.times[i] - time) @ whole
        whole = _saltation(hybrid, guard, switches.before[i], switches.after[i]) @ whole
        state, time = switches.after[i], switches.times[i]
    return np.asarray(whole)


def transverse(hybrid: Hybrid, start: Array, whole: Array) -> tuple[complex, ...]:
    """Eigenvalues of a monodromy matrix without the flow's own direction, the largest first."""
    width = hybrid.view.width
    direction = on_axes(hybrid, rates(hybrid.flow, start, hybrid.view.u)) / width
    frame = np.linalg.qr(np.column_stack([direction, np.eye(len(width))]))[0]
    return sorted_values((frame.T @ whole @ frame)[1:, 1:])


def sorted_values(matrix: Array) -> tuple[complex, ...]:
    """Eigenvalues, the largest first; NaN of a matrix that is not finite."""
    if not np.all(np.isfinite(matrix)):
        return (complex(np.nan),) * len(matrix)
    values = np.linalg.eigvals(matrix)
    order = np.lexsort((-values.imag, -np.abs(values)))
    return tuple(complex(value) for value in values[order])


def _guard(hybrid: Hybrid, switches: Switches, i: int) -> Guard:
    """The guard that a switch took: the one of its kind that is open there, or nearest to it."""
    kind = (switches.left[i], switches.entered[i])
    guards = tuple(guard for guard in hybrid.guards if (guard.mode, guard.target) == kind)
    return guards[int(np.argmax(conditions(hybrid, guards, switches.before[i])))]


def _smooth(hybrid: Hybrid, state: Array, duration: float) -> Array:
    """The fundamental matrix of one mode's field, by central differences."""
    if duration <= 0.0:
        return np.eye(len(hybrid.view.axes))
    ends = followed(
        hybrid, _around(hybrid, state), np.array([0.0, duration]), EXACT, in_one_mode(hybrid.flow)
    )
    return _slopes_of_points(hybrid, on_axes(hybrid, ends.states[:, -1]))


def _saltation(hybrid: Hybrid, guard: Guard, before: Array, after: Array) -> Array:
    width, u = hybrid.view.width, hybrid.view.u
    near = _around(hybrid, before)
    gradient = _slopes(conditions(hybrid, (guard,), near))[0]
    reset = _slopes_of_points(hybrid, _reset(hybrid, guard, near))
    inward = on_axes(hybrid, rates(hybrid.flow, before, u)) / width
    outward = on_axes(hybrid, rates(hybrid.flow, after, u)) / width
    return np.asarray(reset + np.outer(outward - reset @ inward, gradient) / (gradient @ inward))


def _reset(hybrid: Hybrid, guard: Guard, states: Array) -> Array:
    """The points (B, m) that states jump to."""
    program = hybrid.flow.program
    names = [state.name for state in program.states]
    jumped = states.copy()
    register = registers(hybrid.flow, states, hybrid.view.u)
    for name, code in guard.resets:
        jumped[:, names.index(name)] = evaluate([code], program.register, register)[:, 0]
    return on_axes(hybrid, jumped)


def _around(hybrid: Hybrid, state: Array) -> Array:
    """States (2 m, n) displaced along each axis, up, then down."""
    mode = int(state[hybrid.column])
    nudges = NUDGE * np.diag(hybrid.view.width)
    at = on_axes(hybrid, state)
    return points_in(hybrid, np.concatenate([at + nudges, at - nudges]), mode)


def _slopes_of_points(hybrid: Hybrid, points: Array) -> Array:
    """Derivatives (m, m), in widths, of points (2 m, m), which may lie on both sides of a seam."""
    up, down = np.split(points, 2)
    short = shortest(hybrid.view, up - down) / hybrid.view.width
    return np.asarray(short.T / (2.0 * NUDGE))


def _slopes(values: Array) -> Array:
    """Derivatives (k, m) by displacement from values (2 m, k) of `_around`."""
    up, down = np.split(values, 2)
    return np.asarray((up - down).T / (2.0 * NUDGE))

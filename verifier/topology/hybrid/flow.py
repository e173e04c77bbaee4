"""A slice whose mode switches: the axes and the mode move, everything else is held.

m: number of axes; n: of states; B: lanes. A switch is known by the modes that it leaves and enters.
"""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.flow import Flow, flow_of, rates, registers
from runtime.integrators import Trajectories, adaptive
from runtime.machine import evaluate
from runtime.program import Guard, Program, Role
from verifier.topology.paths.seeds import spread
from verifier.topology.slices import Slice, states_at

EXACT: Final = 1e-12
"""Local error of a step where numbers matter, as a share of the widths and relative."""
ROUGH: Final = 1e-7
"""The same where only the course matters."""
MOST_STEPS: Final = 100_000
PROBES: Final = 128
"""Places in each mode at which the speed of its field is looked at."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Hybrid:
    """A slice together with its modes.

    flow: over all states, with the guards. column: of the mode among the states; shown: the mode
    whose field the slice is. tempo: the time in which a typical point crosses the slice, s.
    """

    view: Slice
    flow: Flow
    column: int
    modes: tuple[str, ...]
    shown: int
    tempo: float

    @property
    def guards(self) -> tuple[Guard, ...]:
        """All guards, with the jumps of the axes alone."""
        return self.flow.program.field.guards


def hybrid_of(view: Slice) -> Hybrid | None:
    """The slice with its modes; None where the behavior has none that switch."""
    field = view.whole.program.field
    if not field.guards:
        return None
    program = _switching(view)
    column = next(i for i, state in enumerate(program.states) if state.name == field.mode)
    flow = flow_of(program)
    values = program.states[column].values
    return Hybrid(view, flow, column, values, int(view.x[column]), _tempo(view, flow, column))


def points_in(hybrid: Hybrid, points: Array, mode: int) -> Array:
    """Whole states (..., n) at points (..., m) in one mode."""
    x = states_at(hybrid.view, points)
    x[..., hybrid.column] = mode
    return x


def on_axes(hybrid: Hybrid, states: Array) -> Array:
    """The points (..., m) of whole states."""
    return np.asarray(states[..., list(hybrid.view.columns)])


def followed(
    hybrid: Hybrid, states: Array, times: Array, tolerance: float, flow: Flow | None = None
) -> Trajectories:
    """Trajectories from whole states (B, n) through all switches; with another flow, its own."""
    widths = np.ones(states.shape[-1])
    widths[list(hybrid.view.columns)] = hybrid.view.width
    return adaptive(
        flow or hybrid.flow,
        states,
        hybrid.view.u,
        times,
        tolerance,
        tolerance * widths,
        MOST_STEPS,
    )


def conditions(hybrid: Hybrid, guards: tuple[Guard, ...], states: Array) -> Array:
    """The conditions (..., k) of guards at whole states: zero or more where a guard is open."""
    program = hybrid.flow.program
    register = registers(hybrid.flow, states, hybrid.view.u)
    return evaluate([guard.condition for guard in guards], program.register, register)


def leaves_at(hybrid: Hybrid, points: Array, mode: int) -> Booleans:
    """Where (...) among points (..., m) a mode is left at once."""
    guards = tuple(guard for guard in hybrid.guards if guard.mode == mode)
    if not guards:
        return np.zeros(points.shape[:-1], dtype=np.bool_)
    opened = conditions(hybrid, guards, points_in(hybrid, points, mode)) >= 0.0
    return np.asarray(opened.any(axis=-1))


def _switching(view: Slice) -> Program:
    """The program of the slice with its mode free again; held states do not jump."""
    field = view.whole.program.field
    axes = {axis.name for axis in view.axes}
    guards = tuple(
        replace(guard, resets=tuple(reset for reset in guard.resets if reset[0] in axes))
        for guard in field.guards
    )
    states = tuple(
        replace(state, role=Role.BOTH) if state.name == field.mode else state
        for state in view.program.states
    )
    kept = replace(view.program.field, mode=field.mode, guards=guards)
    return replace(view.program, states=states, field=kept)


def _tempo(view: Slice, flow: Flow, column: int) -> float:
    points = states_at(view, spread(view, PROBES))
    speeds = []
    for mode in range(len(flow.program.states[column].values)):
        points[:, column] = mode
        rate = rates(flow, points, view.u)[:, list(view.columns)]
        speeds.append(np.linalg.norm(rate / view.width, axis=-1))
    speed = np.concatenate(speeds)
    moving = speed[np.isfinite(speed) & (speed > 0.0)]
    return float(1.0 / np.median(moving)) if moving.size else np.inf

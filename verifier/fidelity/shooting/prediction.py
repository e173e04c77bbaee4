"""What the spec predicts from given states, under the measured inputs, on the time grid.

W: predictions; n: states; S: steps of the longest one. Shorter ones stay where they ended.
"""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.flow import Flow
from runtime.integrators import rk4
from verifier.fidelity.shooting.grid import Grid
from verifier.fidelity.shooting.jumps import jumped, switch_knots

NEVER = 2**62
BATCH = 4_000_000
"""At most so many numbers in one batch of states: bounds the memory that a long trace takes."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Model:
    """A flow, or a step map, with the measured inputs on the grid."""

    flow: Flow
    grid: Grid

    @property
    def states(self) -> int:
        """The length of the state vector."""
        return len(self.flow.program.states)


def predict(model: Model, start: Array, first: Integers, last: Integers) -> Array:
    """The states (W, S + 1, n) at the knots `first` to `last` (W,), from `start` (W, n).

    NaN from where a prediction leaves the domain. At a knot from which another mode holds, the
    state is the one after the jump.
    """
    switches = switch_knots(model.flow, model.grid)
    if not np.any(_next(switches, first) <= last):
        return _in_one_go(model, start, first, last)
    paths = np.empty((len(start), _steps(first, last) + 1, start.shape[1]))
    rows, here, now = np.arange(len(start)), np.asarray(first), start
    while len(rows):
        switch = _next(switches, here)
        end = np.minimum(switch, last[rows])
        part = _in_one_go(model, now, here, end)
        # A part stays where it ended, so all that follows is filled in, and overwritten later.
        steps = np.arange(paths.shape[1]) - (here - first[rows])[:, None]
        ahead = steps >= 0
        into, step = np.nonzero(ahead)
        paths[rows[into], step] = part[into, np.minimum(steps[ahead], part.shape[1] - 1)]
        goes_on = switch <= last[rows]
        rows, here = rows[goes_on], end[goes_on]
        now = jumped(model.flow, model.grid, part[goes_on, -1], here)
        paths[rows, here - first[rows]] = now
    return paths


def _in_one_go(model: Model, start: Array, first: Integers, last: Integers) -> Array:
    knots = np.minimum(first[:, None] + np.arange(_steps(first, last) + 1), last[:, None])
    inputs = model.grid.inputs[knots[:, :-1]]
    return rk4(model.flow, start, model.grid.times[knots], inputs, model.grid.columns)


def _next(switches: Integers, knots: Integers) -> Integers:
    """The first switch after each knot; beyond all knots where there is none."""
    return np.append(switches, NEVER)[np.searchsorted(switches, knots, side="right")]


def chunks(model: Model, first: Integers, last: Integers, copies: int) -> list[slice]:
    """Slices of the windows small enough to predict `copies` of each of them at once."""
    width = model.states + len(model.grid.columns)
    each = max(1, BATCH // max(1, copies * width * (_steps(first, last) + 1)))
    return [slice(i, i + each) for i in range(0, len(first), each)]


def _steps(first: Integers, last: Integers) -> int:
    return int(np.max(last - first)) if len(first) else 0

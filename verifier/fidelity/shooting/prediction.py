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

    NaN from where a prediction leaves the domain.
    """
    knots = np.minimum(first[:, None] + np.arange(_steps(first, last) + 1), last[:, None])
    inputs = model.grid.inputs[knots[:, :-1]]
    return rk4(model.flow, start, model.grid.times[knots], inputs, model.grid.columns)


def chunks(model: Model, first: Integers, last: Integers, copies: int) -> list[slice]:
    """Slices of the windows small enough to predict `copies` of each of them at once."""
    width = model.states + len(model.grid.columns)
    each = max(1, BATCH // max(1, copies * width * (_steps(first, last) + 1)))
    return [slice(i, i + each) for i in range(0, len(first), each)]


def _steps(first: Integers, last: Integers) -> int:
    return int(np.max(last - first)) if len(first) else 0

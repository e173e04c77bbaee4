"""What changes of mode are judged in: the model on its grid, the samples, the changes.

K: changes; n: states; D: predicted states; S: steps; G: knots of the grid.
"""

from dataclasses import dataclass, replace
from typing import final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.flow import Flow, flow_of, in_one_mode
from runtime.integrators import rk4
from runtime.program import Fidelity, Guard, Program
from verifier.fidelity.shooting.grid import Grid, flow_grid
from verifier.fidelity.shooting.jumps import mode_column, modes_at
from verifier.fidelity.shooting.noise import noise_of
from verifier.fidelity.shooting.prediction import Model
from verifier.fidelity.shooting.samples import Samples, samples_of
from verifier.fidelity.stretches.changes import Changes
from verifier.fidelity.stretches.needs import Input, Needs, changes_of, period_of
from verifier.fidelity.stretches.segments import spans_between_exclusions
from verifier.fidelity.stretches.spans import without

STEPS = 60
"""At least so many integration steps to the horizon: crossings are read off them."""
LEAD = 0.1
"""A state beside a switch is fitted to the samples of at most this share of a horizon."""
FEWEST = 8
"""But to so many samples of the time base, where the stay is long enough."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Setting:
    """All that the judgement of switches reads.

    sigma (D,): noise of each predicted state. spans (k, 2): what may be judged. tolerance (D,):
    infinite where none is declared. lead: seconds of samples to which states are fitted.
    """

    model: Model
    samples: tuple[Samples, ...]
    sigma: Array
    changes: Changes
    spans: Array
    tolerance: Array
    horizon: float
    lead: float

    @property
    def program(self) -> Program:
        """The program that is judged by."""
        return self.model.flow.program

    @property
    def flow(self) -> Flow:
        """Its flow."""
        return self.model.flow

    @property
    def guards(self) -> tuple[Guard, ...]:
        """The ways of the spec."""
        return self.program.field.guards

    @property
    def only_mode(self) -> int:
        """The mode of a trace without changes."""
        return int(np.rint(modes_at(self.program, self.model.grid)[0]))

    @property
    def mode_names(self) -> tuple[str, ...]:
        """The names of the modes, by their indices."""
        states = self.program.states
        return next(s.values for s in states if s.name == self.program.field.mode)

    @property
    def columns(self) -> list[int]:
        """Where the predicted states stand in the state vector."""
        return [each.column for each in self.samples]


def setting_of(program: Program, needs: Needs, fidelity: Fidelity) -> Setting:
    """The setting; `needs` holds the measured mode."""
    base = period_of(needs.series[needs.base].times)
    lead = max(LEAD * fidelity.horizon, FEWEST * base)
    needs = replace(needs, inputs=tuple(_calmed(each, lead) for each in needs.inputs))
    grid = flow_grid(needs, fidelity.horizon / STEPS)
    flow = flow_of(program)
    samples = samples_of(needs, grid, 0.0)
    changes = changes_of(program, needs)
    spans = spans_between_exclusions(program, needs)
    quiet = without(spans, np.column_stack([changes.since, changes.until]))
    noise = noise_of(Model(in_one_mode(flow), grid), samples, quiet)
    return Setting(
        model=Model(flow, grid),
        samples=samples,
        sigma=np.array([each.sigma for each in noise]),
        changes=changes,
        spans=spans,
        tolerance=np.array([fidelity.tolerance.get(s.state.name, np.inf) for s in samples]),
        horizon=fidelity.horizon,
        lead=lead,
    )


def _calmed(given: Input, lead: float) -> Input:
    """A sensed-only input averaged over `lead` seconds: its noise alone would open guards."""
    series = given.series
    if series is None or not given.is_noisy:
        return given
    width = min(len(series.times), max(1, round(lead / period_of(series.times))))
    kernel = np.ones(width)
    count = np.convolve(np.ones(len(series.times)), kernel, "same")
    values = np.convolve(series.values, kernel, "same") / count
    return replace(given, series=replace(series, values=values))


def run(setting: Setting, start: Array, knots: Integers, modes: Array) -> Array:
    """The states (B, S + 1, n) at `knots` (B, S + 1) from `start` (B, n), each in one mode (B,)."""
    grid = setting.model.grid
    return rk4(
        setting.flow,
        start,
        grid.times[knots],
        inputs_at(setting, knots[:, :-1], modes),
        grid.columns,
    )


def inputs_at(setting: Setting, knots: Integers, modes: Array) -> Array:
    """The inputs (B, S, k) that hold from `knots` (B, S) on, with the mode (B,) put in."""
    grid = setting.model.grid
    inputs = np.array(grid.inputs[knots])
    column = mode_column(setting.program, grid)
    if column >= 0:
        inputs[..., column] = modes[:, np.newaxis]
    return inputs


def knot_at(grid: Grid, times: Array) -> Integers:
    """The first knot at or after each time, the last one at most."""
    return np.minimum(np.searchsorted(grid.times, times - 1e-9), len(grid.times) - 1)

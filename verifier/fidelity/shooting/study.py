"""All that is computed from a trace before anything is judged."""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.flow import Flow
from runtime.program import Fidelity
from verifier.fidelity.shooting.accuracy import STEPS, accurate_grid
from verifier.fidelity.shooting.grid import flow_grid, tick_grid
from verifier.fidelity.shooting.input_noise import with_input_noise
from verifier.fidelity.shooting.noise import noise_of
from verifier.fidelity.shooting.plan import Plan
from verifier.fidelity.shooting.prediction import Model
from verifier.fidelity.shooting.samples import samples_of
from verifier.fidelity.shooting.shooting import Shots, shoot
from verifier.fidelity.shooting.windows import windows_of
from verifier.fidelity.stretches.needs import Needs, period_of
from verifier.fidelity.stretches.segments import Segments
from verifier.report.report import Noise


@final
@dataclass(frozen=True, eq=False, slots=True)
class Study:
    """The windows, shot. `noise` is of each predicted state.

    step_error: of the integration at the horizon, as a share of the tolerance.
    """

    plan: Plan
    segments: Segments
    noise: tuple[Noise, ...]
    shots: Shots
    step_error: float


def study_of(
    flow: Flow, fidelity: Fidelity, needs: Needs, segments: Segments, rng: np.random.Generator
) -> Study | str:
    """The study, or the reason why this trace does not allow one."""
    every = flow.program.field.every
    horizon = max(fidelity.horizon, every)
    grid = tick_grid(needs, every) if flow.is_map else flow_grid(needs, horizon / STEPS)
    if grid is None:
        return f"the samples do not meet the clock of the step map, {every:g} s"
    plan = _plan(Model(flow, grid), needs, segments, horizon)
    if len(plan.windows.times) == 0:
        return (
            f"no window of {horizon:g} s has samples at its start and at its end: the slowest"
            f" variable has one every {period_of(needs.series[needs.base].times):.3g} s"
        )
    step_error = 0.0
    if not flow.is_map:
        grid, step_error = accurate_grid(plan, fidelity)
        plan = _plan(Model(flow, grid), needs, segments, horizon)
    noise = noise_of(plan.model, plan.samples, segments.spans)
    shots = shoot(plan, noise)
    return Study(plan, segments, noise, with_input_noise(plan, shots, rng), step_error)


def _plan(model: Model, needs: Needs, segments: Segments, horizon: float) -> Plan:
    samples = samples_of(needs, model.grid, model.flow.program.field.every)
    windows = windows_of(samples, needs.base, segments.spans, horizon)
    return Plan(needs, model, samples, windows)

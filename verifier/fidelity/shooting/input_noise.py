"""The noise of measured sensed-only inputs, carried to the horizons.

Only that of sensed-only states: a control is a command, and what looks like noise in it acted.
"""

from dataclasses import replace

import numpy as np

from runtime.arrays import Array
from verifier.fidelity.shooting.grid import moved_inputs
from verifier.fidelity.shooting.noise import as_declared, plain_noise
from verifier.fidelity.shooting.plan import Plan
from verifier.fidelity.shooting.prediction import Model, chunks, predict
from verifier.fidelity.shooting.samples import Samples
from verifier.fidelity.shooting.shooting import Shots
from verifier.fidelity.shooting.windows import Windows, chosen_samples

COPIES = 12
"""So many noisy copies of the inputs are predicted."""


def with_input_noise(plan: Plan, shots: Shots, rng: np.random.Generator) -> Shots:
    """The shots, their variances raised by the noise of the sensed-only inputs."""
    series = [each.series for each in plan.needs.inputs if each.is_noisy and each.series]
    declared = {each.name: each for each in plan.model.flow.program.bindings}
    sigma = {
        s.name: as_declared(plain_noise(s.times, s.values, 0.0), declared.get(s.name)).sigma
        for s in series
    }
    if not any(sigma.values()):
        return shots
    calm = _averages(plan, plan.model, shots.start)
    spread = np.zeros_like(calm)
    for _ in range(COPIES):
        shifts = {s.name: sigma[s.name] * rng.standard_normal(len(s.times)) for s in series}
        copy = Model(plan.model.flow, moved_inputs(plan.model.grid, plan.needs, shifts))
        spread += (_averages(plan, copy, shots.start) - calm) ** 2
    more = np.nan_to_num(spread) / COPIES
    errors = tuple(
        tuple(replace(e, variance=e.variance + more[h, j]) for j, e in enumerate(each))
        for h, each in enumerate(shots.errors)
    )
    return Shots(shots.start, shots.is_lost, errors)


def _averages(plan: Plan, model: Model, start: Array) -> Array:
    """Each variable predicted around each horizon: (horizons, variables, W)."""
    found = np.empty((len(plan.horizons), len(plan.samples), len(start)))
    for part in chunks(model, plan.windows.first, plan.windows.last, 1):
        some = plan.windows.part(part)
        paths = predict(model, start[part], some.first, some.last)
        for h, horizon in enumerate(plan.horizons):
            for j, each in enumerate(plan.samples):
                found[h, j, part] = _average(paths, each, some, horizon)
    return found


def _average(paths: Array, samples: Samples, windows: Windows, horizon: float) -> Array:
    chosen = chosen_samples(samples, windows, horizon)
    step = np.clip(samples.knots[chosen.index] - windows.first[:, None], 0, paths.shape[1] - 1)
    at = paths[np.arange(len(paths))[:, None], step, samples.column]
    total = np.sum(np.where(chosen.used, at, 0.0), axis=1)
    return np.asarray(total / np.maximum(chosen.used.sum(axis=1), 1))

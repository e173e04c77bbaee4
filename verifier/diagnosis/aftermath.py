"""The verdict's own figures once more, under a setting that explains the departure."""

from dataclasses import replace
from typing import Final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.flow import Flow
from verifier.diagnosis.altered import Altered, Seen
from verifier.diagnosis.courses import means
from verifier.diagnosis.loosened import PACE
from verifier.diagnosis.scene import Scene
from verifier.fidelity.shooting.grid import Grid
from verifier.fidelity.shooting.plan import Plan
from verifier.fidelity.shooting.prediction import Model
from verifier.fidelity.shooting.samples import Samples
from verifier.fidelity.shooting.shooting import Errors, Shots, shoot
from verifier.fidelity.shooting.study import Study

USUAL: Final = 0.9
"""Most steps are no longer than this quantile of them."""


def altered_study(scene: Scene, study: Study, setting: Altered) -> Study:
    """The study with the inputs, numbers and measured states of `setting`, shot again."""
    grid = _grid(scene, study, setting)
    flow = settled(scene, setting, float(np.quantile(np.diff(grid.times), USUAL)))
    samples = tuple(_samples(each, setting.seen[each.state.name]) for each in study.plan.samples)
    plan = Plan(study.plan.needs, Model(flow, grid), samples, study.plan.windows)
    shots = shoot(plan, study.noise)
    errors = tuple(
        tuple(_no_calmer(n, o) for n, o in zip(new, old, strict=True))
        for new, old in zip(shots.errors, study.shots.errors, strict=True)
    )
    return replace(study, plan=plan, shots=Shots(shots.start, shots.is_lost, errors))


def _no_calmer(new: Errors, old: Errors) -> Errors:
    """With the noise of sensed-only inputs, which was found for the plain setting."""
    return replace(new, variance=np.maximum(new.variance, np.nan_to_num(old.variance)))


def settled(scene: Scene, setting: Altered, step: float) -> Flow:
    """The flow with the setting's numbers as its defaults, for integration in such steps (s)."""
    flow = scene.flow_for([setting])
    names = flow.program.register
    defaults = np.array(flow.defaults)
    for name, value in setting.register.items():
        defaults[names.index(name)] = 1.0 / step if name == PACE else value
    defaults.setflags(write=False)
    return replace(flow, defaults=defaults)


def _grid(scene: Scene, study: Study, setting: Altered) -> Grid:
    """The study's grid; inputs first, then rates that are put in from outside."""
    old, needs = study.plan.model.grid, study.plan.needs
    names = [each.name for each in needs.inputs]
    columns = [old.inputs[:, k] for k in range(len(names))]
    discrete = {state.name for state in scene.program.states if state.values}
    for k, each in enumerate(needs.inputs):
        if each.name in setting.register:
            columns[k] = np.full(len(old.times), setting.register[each.name])
        elif each.name in setting.courses and each.name not in discrete:
            columns[k] = np.clip(_held(setting, each.name, old), each.low, each.high)
    more = [name for name in setting.courses if name not in names]
    columns += [_held(setting, name, old) for name in more]
    register = scene.flow.program.register
    places: Integers = np.array([register.index(name) for name in (*names, *more)], dtype=np.int64)
    inputs = np.stack(columns, axis=-1) if columns else np.empty((len(old.times), 0))
    return replace(old, inputs=inputs, columns=places)


def _held(setting: Altered, name: str, grid: Grid) -> Array:
    """The mean from each knot to the next."""
    found = means(setting.courses[name], grid.times)
    return np.append(found, found[-1:])


def _samples(samples: Samples, seen: Seen) -> Samples:
    """As the state itself was, by how it was measured."""
    values = samples.values
    if seen.delay != 0.0:
        values = np.interp(samples.times + seen.delay, samples.times, values)
    return replace(samples, values=(values - seen.offset) / seen.scale)

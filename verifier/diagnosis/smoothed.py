"""The register along the trace: states smoothed, inputs as held, and the rates there."""

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from scipy.signal import savgol_filter

from runtime.arrays import Array
from runtime.code import Code
from runtime.machine import evaluate, run_tape
from verifier.diagnosis.altered import Altered
from verifier.diagnosis.courses import means
from verifier.diagnosis.scene import Scene
from verifier.fidelity.stretches.needs import held
from verifier.fidelity.stretches.segments import on_circle

HALF: Final = 0.1
"""States are smoothed by cubics over this share of the horizon to either side."""
MOST: Final = 20_000
"""So many instants, at most."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Smoothed:
    """Instants `times` (T,), evenly spaced, and the register (T, r) of the loosened program."""

    times: Array
    register: Array


def smoothed(scene: Scene) -> Smoothed:
    """From the first to the last sample of all driven states."""
    series = scene.needs.series
    low, high = max(s.times[0] for s in series), min(s.times[-1] for s in series)
    period = max(float(np.median(np.diff(scene.needs.series[scene.needs.base].times))), 1e-9)
    times = np.linspace(low, high, int(np.clip((high - low) / period, 8, MOST)) + 1)
    register = np.tile(scene.flow.defaults, (len(times), 1))
    for given in scene.needs.inputs:
        known = given.value if given.series is None else held(given.series, times)
        register[:, given.column] = known
    half = round(HALF * scene.horizon / float(times[1] - times[0]))
    for column, state, each in zip(scene.needs.columns, scene.needs.driven, series, strict=True):
        values = np.interp(times, each.times, each.values)
        if 2 * half + 1 > 4 and 2 * half + 1 <= len(times):
            values = savgol_filter(values, 2 * half + 1, 3)
        register[:, column] = on_circle(state, values)
    return Smoothed(times, register)


def values_of(scene: Scene, along: Smoothed, code: Code) -> Array:
    """An expression along the trace (T,)."""
    return evaluate([code], scene.flow.program.register, along.register)[:, 0]


def rates_of(scene: Scene, along: Smoothed, setting: Altered) -> Array:
    """The rates along the trace (T, n) in this setting.

    Where they are outside the domain they are as before it.
    """
    register = np.array(along.register)
    names = scene.flow.program.register
    for name, value in setting.register.items():
        register[:, names.index(name)] = value
    edges = np.append(along.times, 2.0 * along.times[-1] - along.times[-2])
    for name, course in setting.courses.items():
        register[:, names.index(name)] = means(course, edges - 0.5 * (edges[1] - edges[0]))
    found = run_tape(scene.flow_for([setting]).tape, register)
    good = np.all(np.isfinite(found), axis=1)
    if not np.any(good):
        return np.zeros_like(found)
    last = np.maximum.accumulate(np.where(good, np.arange(len(good)), int(np.argmax(good))))
    return np.asarray(found[last])

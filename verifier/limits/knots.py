"""The instants between which a planted deviation is integrated, and what was measured there.

They need not be the samples: a deviation is smooth, so a fortieth of the horizon is fine enough
however fast the sensors are. Nor need the noise of the measured states be smoothed away: smoothing
was tried, and changed the deviation by less than a hundredth.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans
from verifier.fidelity.shooting.grid import Grid
from verifier.fidelity.shooting.jumps import switch_knots
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.needs import Input, held
from verifier.fidelity.stretches.spans import length

STEPS: Final = 40
"""At least so many steps to a horizon."""
FINEST: Final = 100
"""And at most about so many."""
JUST: Final = 1e-6
"""So much of the horizon before a switch is a knot as well: what a guard resets, jumps."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Knots:
    """K instants, in the judged stretches `spans` only; of a step map, its ticks.

    begins (K,): whether a stretch begins here. states, middle (K, n): at each knot, and halfway
    to the next one. controls (K, p): the mean until the next one; of a step map, at the tick.
    grid: the same knots with all inputs, in which the mode switches.
    """

    times: Array
    begins: Booleans
    spans: Array
    states: Array
    middle: Array
    controls: Array
    is_map: bool
    grid: Grid


def knots_of(study: Study) -> Knots:
    """The knots of a study's judged stretches."""
    model, needs = study.plan.model, study.plan.needs
    times, begins = _ticks(study) if model.flow.is_map else _evenly(study)
    means = [mean_input(each, times, 0.0, is_map=model.flow.is_map) for each in needs.inputs]
    inputs = np.stack(means, axis=-1) if means else np.empty((len(times), 0))
    after = np.append(times[1:], times[-1:])
    states = _measured(study, inputs, times)
    leaps = np.flatnonzero(np.isin(times, model.grid.times[model.grid.leaps]))
    n, p = model.states, len(model.flow.program.controls)
    return Knots(
        times=times,
        begins=begins,
        spans=study.segments.spans,
        states=states[:, :n],
        middle=_measured(study, inputs, (times + after) / 2.0)[:, :n],
        controls=states[:, n : n + p],
        is_map=model.flow.is_map,
        grid=Grid(times, inputs, model.grid.columns, leaps),
    )


def mean_input(given: Input, times: Array, late: float, *, is_map: bool) -> Array:
    """An input as acted on `late` seconds late: its mean (K,) from each knot to the next.

    Of a step map, and of what is no quantity (a mode), its value at the knot.
    """
    if given.series is None:
        return np.full(len(times), given.value)
    start, stop = times - late, np.append(times[1:], times[-1:]) - late
    now = held(given.series, start)
    is_name = not np.isfinite(given.low) and not given.is_sensed
    if is_map or is_name:
        return np.clip(now, given.low, given.high)
    at, values = given.series.times, given.series.values
    ends = min(at[0], start[0]) - 1.0, max(at[-1], stop[-1]) + 1.0
    edges = np.concatenate([[ends[0]], at[1:], [ends[1]]])
    area = np.concatenate([[0.0], np.cumsum(values * np.diff(edges))])
    width = stop - start
    gained = np.interp(stop, edges, area) - np.interp(start, edges, area)
    mean = np.where(width > 0.0, gained / np.where(width > 0.0, width, 1.0), now)
    return np.clip(mean, given.low, given.high)


def _ticks(study: Study) -> tuple[Array, Booleans]:
    grid, spans = study.plan.model.grid.times, study.segments.spans
    inside = [grid[(grid >= a) & (grid <= b)] for a, b in spans]
    return _joined([each for each in inside if len(each)])


def _evenly(study: Study) -> tuple[Array, Booleans]:
    """No step above a fortieth of the horizon; inputs that change less often, change at knots."""
    horizon, steps = study.plan.windows.horizon, np.diff(study.plan.model.grid.times)
    least = max(np.quantile(steps, 0.9), horizon / FINEST) if len(steps) else np.inf
    step = min(horizon / STEPS, least)
    after = _switches(study)
    switches = np.concatenate([after, after - JUST * horizon, *_rare_changes(study, step)])
    parts = []
    for a, b in study.segments.spans:
        inner = switches[(switches > a) & (switches < b)]
        parts.append(np.union1d(np.linspace(a, b, int(np.ceil((b - a) / step)) + 1), inner))
    return _joined(parts)


def _rare_changes(study: Study, step: float) -> list[Array]:
    """When inputs change that do so in fewer than half of the steps."""
    most = length(study.segments.spans) / step / 2.0
    told = [each.series for each in study.plan.needs.inputs if each.series is not None]
    changes = [s.times[1:][np.diff(s.values) != 0.0] for s in told]
    return [times for times in changes if len(times) < most]


def _joined(parts: list[Array]) -> tuple[Array, Booleans]:
    begins = [np.arange(len(part)) == 0 for part in parts]
    return np.concatenate(parts), np.concatenate(begins)


def _switches(study: Study) -> Array:
    grid = study.plan.model.grid
    return grid.times[switch_knots(study.plan.model.flow, grid)]


def _measured(study: Study, inputs: Array, times: Array) -> Array:
    """The register (K, r) at `times` (K,), each in the step that begins with its knot."""
    register = np.tile(study.plan.model.flow.defaults, (len(times), 1))
    register[:, study.plan.model.grid.columns] = inputs
    for each in study.plan.samples:
        register[:, each.column] = np.interp(times, each.times, each.values)
    return register

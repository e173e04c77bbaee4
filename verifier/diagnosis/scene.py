"""The windows on which explanations are tried: longer than those of the verdict, side by side.

Every sample lies in one window, and a window's start is a free nuisance. Longer windows tell more
(fewer nuisances), as long as the field does not blow small errors up; at least a dozen of them are
wanted, since what they say apart from one another is the measure of doubt.

W: windows; D: predicted states; S: integration steps; m: samples of a state in a window.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.flow import Flow
from runtime.integrators import rk4
from runtime.program import Kind, Program
from verifier.diagnosis.altered import Altered, Seen
from verifier.diagnosis.courses import Course, means
from verifier.diagnosis.loosened import is_bound, loosened_flow
from verifier.diagnosis.wraps import is_wrap
from verifier.fidelity.shooting.plan import Plan
from verifier.fidelity.shooting.samples import Samples, edges, measured_states
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.needs import Needs
from verifier.fidelity.stretches.spans import spans_of

LONG: Final = 2.0
"""Windows of so many horizons are wanted."""
WANTED: Final = 12
"""And at least so many of them, but none is shorter than half a horizon."""
SHORT: Final = 0.5
MOST: Final = 64
"""More windows are thinned out, in even spacing."""
MOST_SAMPLES: Final = 80
"""More samples of a state in a window are thinned out."""
FEWEST: Final = 4
"""With fewer samples of a state a window tells nothing."""
STEPS: Final = 20
"""Integration steps to a horizon, at least."""
HALVINGS: Final = 5
ACCURACY: Final = 0.1
"""Halved steps may move a prediction by this share of the noise,"""
FINEST: Final = 1e-4
"""which counts as at least this share of the domain."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Observed:
    """One predicted state as measured: values (W, m) at `times`, real where `used`.

    at: which knot of its window each is. floor: the noise that its sensor has at least.
    """

    name: str
    column: int
    turn: float
    width: float
    low: float
    high: float
    floor: float
    times: Array
    values: Array
    at: Integers
    used: Booleans


@final
@dataclass(frozen=True, eq=False, slots=True)
class Scene:
    """All that trying an explanation needs.

    flow, wrapped: without and with parts that saturate or have dead zones, and states that stop at
    bounds. times: (W, S + 1) integration knots; a short window repeats its last one. start: (W, n).
    plain: the setting in which all is as the spec and the log say.
    """

    program: Program
    flow: Flow
    wrapped: Flow
    needs: Needs
    times: Array
    start: Array
    observed: tuple[Observed, ...]
    plain: Altered
    horizon: float

    @property
    def windows(self) -> int:
        """How many there are."""
        return len(self.times)

    def flow_for(self, settings: list[Altered]) -> Flow:
        """The plain flow, unless some part of the formula saturates, or a state is bounded."""
        is_wrapped = any(is_wrap(n) or is_bound(n) for s in settings for n in s.register)
        return self.wrapped if is_wrapped else self.flow


def scene_of(program: Program, study: Study) -> Scene:
    """The windows of a study, for its program loosened, in steps that are fine enough."""
    step = study.plan.windows.horizon / STEPS
    scene = _scene(program, study, step)
    for _ in range(0 if program.field.is_map or scene.windows == 0 else HALVINGS):
        step /= 2.0
        finer = _scene(program, study, step)
        if _is_close(scene, finer):
            break
        scene = finer
    return scene


def _is_close(scene: Scene, finer: Scene) -> bool:
    """Whether halved steps move no prediction by more than a share of the noise."""
    one, other = (predicted_ends(each) for each in (scene, finer))
    moved = np.nanmax(np.abs(one - other), axis=0, initial=0.0)
    allowed = [max(each.floor, FINEST * each.width) for each in scene.observed]
    return bool(np.all(moved <= ACCURACY * np.array(allowed)))


def _scene(program: Program, study: Study, step: float) -> Scene:
    """With no step above `step` (s)."""
    plan, horizon = study.plan, study.plan.windows.horizon
    changes = _changes(program, plan.needs)
    jumps = any(guard.resets for guard in program.field.guards)
    spans = _cut(study.segments.spans, changes) if jumps else study.segments.spans
    rows = [_chosen(plan, low, high) for low, high in _windows(spans, horizon)]
    rows = [row for row in rows if all(len(each) >= FEWEST for each in row)]
    knots = [_knots(plan, row, step, changes) for row in rows]
    times = _padded(knots)
    observed = tuple(
        _observed(each, [row[j] for row in rows], times, study.noise[j].sigma)
        for j, each in enumerate(plan.samples)
    )
    return Scene(
        program=program,
        flow=loosened_flow(program, wraps=False),
        wrapped=loosened_flow(program, wraps=True),
        needs=plan.needs,
        times=times,
        start=_starts(plan, times[:, 0]) if rows else np.empty((0, plan.model.states)),
        observed=observed,
        plain=_plain(plan, observed),
        horizon=horizon,
    )


def _windows(spans: Array, horizon: float) -> list[tuple[float, float]]:
    """Windows of even length in every stretch, thinned to the most that are allowed."""
    total = float(np.sum(spans[:, 1] - spans[:, 0]))
    wanted = min(LONG * horizon, max(SHORT * horizon, total / WANTED))
    found: list[tuple[float, float]] = []
    for low, high in spans:
        count = max(1, int((high - low) / wanted + 1e-6))
        inner = np.linspace(low, high, count + 1)
        found += [(float(a), float(b)) for a, b in pairwise(inner)]
    keep = np.unique(np.linspace(0, len(found) - 1, min(MOST, len(found))).astype(np.int64))
    return [found[i] for i in keep]


def _chosen(plan: Plan, low: float, high: float) -> list[Integers]:
    """Per predicted state, the indices of its samples in a window; the end belongs to the next."""
    chosen = []
    for each in plan.samples:
        first, stop = np.searchsorted(each.times, [low - 1e-9, high - 1e-9])
        stride = -(-(stop - first) // MOST_SAMPLES)
        chosen.append(np.arange(first, stop, max(stride, 1)))
    return chosen


def _changes(program: Program, needs: Needs) -> Array:
    """When the discrete inputs change."""
    discrete = {state.name for state in program.states if state.kind is Kind.DISCRETE}
    told = [i.series for i in needs.inputs if i.name in discrete and i.series is not None]
    found = [each.times[1:][np.diff(each.values) != 0.0] for each in told]
    return np.unique(np.concatenate([np.empty(0), *found]))


def _cut(spans: Array, changes: Array) -> Array:
    """Spans that end where states may jump."""
    pieces = []
    for low, high in spans:
        inner = changes[(changes > low) & (changes < high)]
        pieces += list(pairwise([low, *inner, high]))
    return spans_of([(float(a), float(b)) for a, b in pieces])


def _knots(plan: Plan, row: list[Integers], step: float, changes: Array) -> Array:
    """Integration knots of one window: samples and changes, no further apart than `step`."""
    pairs = list(zip(plan.samples, row, strict=True))
    if plan.model.flow.is_map:
        knots = np.concatenate([each.knots[index] for each, index in pairs])
        return np.asarray(plan.model.grid.times[int(np.min(knots)) : int(np.max(knots)) + 1])
    times = np.unique(np.concatenate([each.times[index] for each, index in pairs]))
    inner = changes[(changes > times[0]) & (changes < times[-1])]
    times = np.union1d(times, inner)
    pieces = np.maximum(1, np.ceil(np.diff(times) / step - 1e-9)).astype(np.int64)
    parts = [
        np.linspace(a, b, n, endpoint=False)
        for a, b, n in zip(times[:-1], times[1:], pieces, strict=True)
    ]
    return np.concatenate([*parts, times[-1:]])


def _padded(rows: list[Array]) -> Array:
    longest = max((len(row) for row in rows), default=1)
    return np.array([np.pad(r, (0, longest - len(r)), "edge") for r in rows]).reshape(-1, longest)


def _observed(samples: Samples, rows: list[Integers], times: Array, floor: float) -> Observed:
    most = max((len(row) for row in rows), default=0)
    index = np.array([np.pad(r, (0, most - len(r)), "edge") for r in rows], dtype=np.int64)
    index = index.reshape(-1, most)
    used = np.array([np.arange(most) < len(row) for row in rows], dtype=bool).reshape(-1, most)
    at = [np.searchsorted(t, samples.times[i] - 1e-9) for t, i in zip(times, index, strict=True)]
    state = samples.state
    low, high = edges(samples)
    return Observed(
        state.name,
        samples.column,
        samples.turn,
        state.high - state.low,
        low,
        high,
        floor,
        samples.times[index],
        samples.values[index],
        np.array(at, dtype=np.int64).reshape(-1, most),
        used,
    )


def _starts(plan: Plan, times: Array) -> Array:
    """What was measured at the first knots, by nearest samples: refined by every fit."""
    knots = np.searchsorted(plan.model.grid.times, times)
    return measured_states(
        plan.model, plan.samples, np.minimum(knots, len(plan.model.grid.times) - 1)
    )


def _plain(plan: Plan, observed: tuple[Observed, ...]) -> Altered:
    """Inputs as they were measured; those of a step map as they are at its ticks."""
    courses = {}
    for column, each in enumerate(plan.needs.inputs):
        if each.series is not None and len(each.series.times) > 1:
            clipped = np.clip(each.series.values, each.low, each.high)
            courses[each.name] = Course(each.series.times, clipped)
            if plan.model.flow.is_map:
                grid = plan.model.grid
                courses[each.name] = Course(grid.times, grid.inputs[:, column])
    register = {each.name: each.value for each in plan.needs.inputs if each.series is None}
    return Altered(register, courses, {each.name: Seen() for each in observed})


def predicted_ends(scene: Scene) -> Array:
    """The predicted states (W, D) at the end of each window, from measured starts."""
    courses = scene.plain.courses
    names = [*courses, *scene.plain.register]
    columns = np.array([scene.flow.program.register.index(n) for n in names], dtype=np.int64)
    steps = scene.times[:, :-1].shape
    told = [
        means(courses[n], scene.times) if n in courses else np.full(steps, scene.plain.register[n])
        for n in names
    ]
    inputs = np.stack(told, axis=-1) if told else np.empty((*steps, 0))
    low, high = scene.flow.domain[:, columns]
    paths = rk4(scene.flow, scene.start, scene.times, np.clip(inputs, low, high), columns)
    return np.asarray(paths[:, -1, [each.column for each in scene.observed]])

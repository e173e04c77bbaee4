"""A drawn field refitted: each vector that the trace tells, by least squares on the windows.

The rates of a drawn field are sums of its vectors, each times its share at a place. A vector that
is off by `c` therefore adds `c * share` to a rate. The shares are taken along the smoothed trace
and put in as functions of time, so that all vectors are fitted together, starts free, by the same
Gauss-Newton fit as every other number.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.program import Program, Unit
from verifier.diagnosis.altered import Altered, Effect, Number, Values
from verifier.diagnosis.courses import Course
from verifier.diagnosis.fitting import Fit, fit, intervals_of, plain_fit
from verifier.diagnosis.loosened import offset_of
from verifier.diagnosis.parameters import NUDGE
from verifier.diagnosis.refitting import apart
from verifier.diagnosis.scene import Scene, scene_of
from verifier.diagnosis.smoothed import smoothed
from verifier.fidelity.shooting.study import Study
from verifier.report.diagnosis import CandidateKind

Shares: TypeAlias = Callable[[Array], Array]

MOST: Final = 60
"""So many vectors are fitted at once, those with the greatest shares."""
SEEN: Final = 0.05
"""A vector with no greater share than this anywhere along the trace is not told."""
FEWEST: Final = 4
"""With fewer windows no vector is told."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class DrawnField:
    """A field as a sum of vectors.

    over: the names that span it. drives: whose rates the vectors are. shares: of each of N vectors
    at places (P, len(over)): (P, N). values: (N, len(drives)) in SI.
    """

    over: tuple[str, ...]
    drives: tuple[str, ...]
    shares: Shares
    values: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class FittedVectors:
    """Vectors (N, m) in SI; half of their intervals' widths, infinite where they stay.

    is_told: which of them the trace tells, moved or not.
    """

    values: Array
    half: Array
    is_told: Booleans


def fitted_vectors(
    program: Program, study: Study, drawn: DrawnField, confidence: float
) -> FittedVectors:
    """The vectors that explain the windows best; those that need not move stay as drawn."""
    scene = scene_of(program, study)
    still = np.full(drawn.values.shape, np.inf)
    untold = FittedVectors(drawn.values, still, np.zeros(drawn.values.shape, dtype=bool))
    if scene.windows < FEWEST:
        return untold
    base = plain_fit(scene)
    effects = apart(scene, base, _effects(scene, drawn))
    if not effects:
        return untold
    is_told = np.array(untold.is_told)
    for effect in effects:
        is_told[_place(effect)] = True
    found = _sparse(scene, base, effects, confidence)
    values, half = np.array(drawn.values), still
    intervals = intervals_of(scene, found, confidence)
    for effect, value, interval in zip(found.effects, found.values, intervals, strict=True):
        values[_place(effect)] += value
        half[_place(effect)] = 0.5 * (interval.high - interval.low)
    return FittedVectors(values, half, is_told)


def _sparse(scene: Scene, base: Fit, effects: list[Effect], confidence: float) -> Fit:
    """Without those whose intervals hold 0, unless that explains less by more than they cost."""
    whole = _joint(scene, base, effects)
    intervals = intervals_of(scene, whole, confidence)
    kept = [
        effect
        for effect, interval in zip(whole.effects, intervals, strict=True)
        if not interval.low <= 0.0 <= interval.high
    ]
    if not kept or len(kept) == len(effects):
        return whole if kept else base
    fewer = _joint(scene, base, kept)
    cost = len(effects) - len(kept)
    return fewer if fewer.objective - whole.objective < cost else whole


def _joint(scene: Scene, base: Fit, effects: list[Effect]) -> Fit:
    return fit(scene, tuple(effects), (0.0,) * len(effects), base.starts, base.sigma)


def _effects(scene: Scene, drawn: DrawnField) -> list[Effect]:
    """The vectors that the trace comes near to, the greatest share first."""
    along = smoothed(scene)
    names = scene.flow.program.register
    places = along.register[:, [names.index(name) for name in drawn.over]]
    shares = drawn.shares(places)
    near = np.flatnonzero(np.max(np.abs(shares), axis=0) > SEEN)
    order = near[np.argsort(-np.sum(shares[:, near] ** 2, axis=0))]
    begins = along.times - 0.5 * (along.times[1] - along.times[0])
    moves = {each.name for each in scene.observed}
    found = []
    for k in order:
        for j, name in enumerate(drawn.drives):
            if name in moves:
                size = float(np.max(np.abs(drawn.values[:, j]))) or 1.0
                course = Course(begins, np.ascontiguousarray(shares[:, k]))
                found.append(_effect(name, (int(k), j), size, course, scene))
    return found[:MOST]


def _effect(name: str, place: tuple[int, int], size: float, course: Course, scene: Scene) -> Effect:
    """size: of the vectors of this rate, the largest."""
    number = Number("value", Unit("1", 1.0), 0.0, NUDGE * size, -size * 1e3, size * 1e3)
    return Effect(
        kind=CandidateKind.BIAS,
        applies_to=(name,),
        label=f"{place[0]} {place[1]}",
        numbers=(number,),
        apply=_Add(offset_of(name), course),
        origin=scene.program.field.origin,
    )


def _place(effect: Effect) -> tuple[int, int]:
    k, j = effect.label.split(" ")
    return int(k), int(j)


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Add:
    """Adds a vector's share of a rate."""

    name: str
    share: Course

    def __call__(self, setting: Altered, values: Values) -> Altered:
        (value,) = values
        if value == 0.0:
            return setting
        added = value * self.share.values
        if self.name in setting.courses:
            added = added + setting.courses[self.name].values
        return setting.with_course(self.name, replace(self.share, values=added))

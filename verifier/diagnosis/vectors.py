"""A drawn field refitted: each vector that the trace tells, by least squares on the windows.

The rates of a drawn field are sums of its vectors, each times its share at a place. A vector that
is off by `c` therefore adds `c * share` to a rate. The shares are taken along the smoothed trace
and put in as functions of time; the residuals r of the windows and their slopes J by all c, starts
free, are those of every other fit (`profiled`). Vectors that act together along the trace are told
together only, so what is minimized is

    |r - J c|^2 / sigma^2 + |c / prior|^2

with a prior of a share of the largest vector: of all fields that fit, the one that moves least
(ridge regression, Hoerl and Kennard 1970). A vector counts as told where the trace leaves less
doubt of it than the prior.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final, TypeAlias, final

import numpy as np
from scipy import stats

from runtime.arrays import Array, Booleans
from runtime.program import Program, Unit
from verifier.diagnosis.altered import Altered, Effect, Number, Values
from verifier.diagnosis.courses import Course
from verifier.diagnosis.fitting import correlation_time, information, plain_fit
from verifier.diagnosis.loosened import offset_of
from verifier.diagnosis.parameters import NUDGE
from verifier.diagnosis.profiled import profiled
from verifier.diagnosis.residuals import owners, used
from verifier.diagnosis.scene import Scene, scene_of
from verifier.diagnosis.smoothed import smoothed
from verifier.fidelity.shooting.study import Study
from verifier.report.diagnosis import CandidateKind

Shares: TypeAlias = Callable[[Array], Array]

PRIOR: Final = 0.3
"""So far, in the largest vector of a rate, vectors are thought to be off."""
TOLD: Final = 0.5
"""A vector is told where its doubt is below this share of the prior."""
MOST: Final = 120
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
    """Vectors (N, m) in SI, and how exactly each matters, the others as they are.

    half: of an interval's width (N, m); infinite where the vector stays. Digits below it make no
    difference that the trace would tell; what it says of one vector alone is often less.
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
    half = np.full(drawn.values.shape, np.inf)
    is_told: Booleans = np.zeros(drawn.values.shape, dtype=bool)
    effects = _effects(scene, drawn) if scene.windows >= FEWEST else []
    if not effects:
        return FittedVectors(drawn.values, half, is_told)
    prior = np.array([PRIOR * each.numbers[0].step / NUDGE for each in effects])
    normal, right = _normal_equations(scene, effects, prior)
    wide = float(stats.norm.ppf(0.5 + 0.5 * confidence))
    found, told, kept = _moved(normal, right, prior, wide)
    values = np.array(drawn.values)
    for i, effect in enumerate(effects):
        place = _place(effect)
        is_told[place] = told[i]
        if kept[i]:
            values[place] += found[i]
            half[place] = wide / np.sqrt(normal[i, i])
    return FittedVectors(values, half, is_told)


def _normal_equations(scene: Scene, effects: list[Effect], prior: Array) -> tuple[Array, Array]:
    """The information (p, p) of the windows, and its right side (p,).

    Noise and its correlation time are those of what all vectors together leave.
    """
    base = plain_fit(scene)
    left = profiled(scene, tuple(effects), (0.0,) * len(effects), base.starts, base.sigma)
    owner, real = owners(scene), used(scene)
    sigma, thinning = base.sigma, np.ones(len(base.sigma))
    for _ in range(2):
        weight = (sigma * np.sqrt(thinning))[owner]
        white = left.slopes / weight[:, None]
        normal = information(white)
        right = np.einsum("wri,wr->i", white, left.residual / weight)
        found = np.linalg.solve(normal + np.diag(prior**-2.0), right)
        rest = left.residual - left.slopes @ found
        counts = np.array([np.sum(real[:, owner == j]) for j in range(len(sigma))])
        power = np.array([np.sum(rest[:, owner == j] ** 2) for j in range(len(sigma))])
        sigma = np.maximum(np.sqrt(power / np.maximum(counts, 1)), 1e-12)
        thinning = correlation_time(scene, rest)
    return normal, right


def _moved(
    normal: Array, right: Array, prior: Array, wide: float
) -> tuple[Array, Booleans, Booleans]:
    """What is added to each vector (p,), which the trace tells, and which of these surely move."""
    whole = normal + np.diag(prior**-2.0)
    found = np.linalg.solve(whole, right)
    doubt = np.sqrt(np.diag(np.linalg.inv(whole)))
    told = doubt < TOLD * prior
    kept = told & (np.abs(found) > wide * doubt)
    if np.any(told) and not _is_as_good(whole, right, kept, told):
        kept = told
    return _solved(whole, right, kept), told, kept


def _is_as_good(whole: Array, right: Array, kept: Booleans, told: Booleans) -> bool:
    """Whether those left out explain no more than chance would, one half each."""
    few, many = (_solved(whole, right, which) for which in (kept, told))
    gained = 0.5 * float(right @ many - right @ few)
    return gained < float(np.sum(told & ~kept))


def _solved(whole: Array, right: Array, kept: Booleans) -> Array:
    found = np.zeros(len(right))
    if np.any(kept):
        found[kept] = np.linalg.solve(whole[np.ix_(kept, kept)], right[kept])
    return found


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

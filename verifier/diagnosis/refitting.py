"""The numbers of the spec that this trace can tell, refitted together with what was taken in."""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from verifier.diagnosis.altered import Effect
from verifier.diagnosis.fitting import Fit, fit, information, intervals_of
from verifier.diagnosis.parameters import NUDGE, Parameter, effect_of
from verifier.diagnosis.profiled import profiled
from verifier.diagnosis.residuals import owners
from verifier.diagnosis.scene import Scene
from verifier.report.diagnosis import ParameterKind
from verifier.report.report import Interval

OWN: Final = (ParameterKind.CONTROL, ParameterKind.CONSTANT)
OTHERWISE: Final = (ParameterKind.RATE_GAIN,)
"""Refitted where the spec has no numbers of its own that could be."""
LOOSEST: Final = 0.2
"""A number is refitted where its standard error, the others free, is below this share of it."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Number:
    """One number, as fitted. is_moved: it was taken in as an explanation."""

    parameter: Parameter
    value: float
    interval: Interval
    is_moved: bool


def refitted(
    scene: Scene, taken: Fit, parameters: tuple[Parameter, ...], confidence: float
) -> tuple[tuple[Number, ...], Fit]:
    """The numbers and the joint fit. Those that were taken in keep the values of that fit."""
    labels = {effect.label for effect in taken.effects}
    own = [p for p in parameters if p.kind in OWN]
    wanted = own or [p for p in parameters if p.kind in OTHERWISE]
    told = _told(scene, taken, [p for p in wanted if p.label not in labels])
    effects = (*taken.effects, *(effect_of(each) for each in told))
    begin = (*taken.values, *(each.spec for each in told))
    joint = fit(scene, effects, begin, taken.starts, taken.sigma)
    moved = [p for p in parameters if p.label in labels]
    sparse = _by_label(scene, taken, confidence)
    free = _by_label(scene, joint, confidence)
    numbers = [Number(p, *sparse[p.label], is_moved=True) for p in moved]
    numbers += [Number(p, *free[p.label], is_moved=False) for p in told]
    order = {each: place for place, each in enumerate(parameters)}
    return tuple(sorted(numbers, key=lambda n: order[n.parameter])), joint


def _by_label(scene: Scene, fitted: Fit, confidence: float) -> dict[str, tuple[float, Interval]]:
    """The first number of each effect."""
    intervals = intervals_of(scene, fitted, confidence)
    found, at = {}, 0
    for effect in fitted.effects:
        if effect.numbers:
            found[effect.label] = fitted.values[at], intervals[at]
        at += len(effect.numbers)
    return found


def _told(scene: Scene, taken: Fit, wanted: list[Parameter]) -> list[Parameter]:
    """As many of them, in order, as can be told apart from what is in already."""
    by_label = {each.label: each for each in wanted}
    return [by_label[e.label] for e in apart(scene, taken, [effect_of(each) for each in wanted])]


def apart(scene: Scene, base: Fit, effects: list[Effect]) -> list[Effect]:
    """As many effects of one number each, in order, as can be told apart, sizes by their steps."""
    neutral = tuple(value for each in effects for value in each.neutral)
    values = (*base.values, *neutral)
    left = profiled(scene, (*base.effects, *effects), values, base.starts, base.sigma)
    matrix = information(left.slopes / base.sigma[owners(scene)][:, None])
    kept = list(range(len(base.values)))
    found = []
    for place, each in enumerate(effects, start=len(base.values)):
        if _error(matrix, kept, place) < LOOSEST * each.numbers[0].step / NUDGE:
            kept.append(place)
            found.append(each)
    return found


def _error(matrix: Array, kept: list[int], place: int) -> float:
    """The standard error of one number, those `kept` free."""
    own = matrix[place, place]
    if own <= 0.0:
        return np.inf
    if kept:
        across = matrix[kept, place]
        inner = np.linalg.pinv(matrix[np.ix_(kept, kept)], hermitian=True)
        left = own - across @ inner @ across
        own = left if left > 1e-9 * own else 0.0
    return float(1.0 / np.sqrt(own)) if own > 0.0 else np.inf

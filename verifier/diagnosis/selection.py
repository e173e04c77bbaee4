"""Explanations, tried one by one, the best taken in, then those that are left tried beside it.

A candidate is taken where it predicts held-out windows better than what was taken before it, by
more than chance would, and by enough to matter beside the tolerance.
"""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from verifier.diagnosis.altered import Effect, Number, Values
from verifier.diagnosis.between_samples import jumps_between_samples
from verifier.diagnosis.fitting import (
    ENOUGH,
    Fit,
    correlation_time,
    extended,
    fit,
    intervals_of,
    left_of_starts,
    objective,
    plain_fit,
    white_part,
    white_slopes,
)
from verifier.diagnosis.heldout import Scored, scored
from verifier.diagnosis.naming import kind_of
from verifier.diagnosis.profiled import profiled
from verifier.diagnosis.residuals import owners
from verifier.diagnosis.scene import Scene
from verifier.fidelity.judging.departure import CONFIDENCE
from verifier.report.diagnosis import CandidateKind

MOST: Final = 5
"""So many are taken, at most."""
STAYS: Final = 0.1
"""And so much where it is asked whether an earlier one is still needed."""
CLEAR: Final = 6.0
"""A candidate gains at least so much held-out log-likelihood: many are tried."""
CLOSE: Final = 4.0
"""Candidates that gain as much but for this explain as well."""
ROUGH: Final = 0.95
"""What explains less than this share is not all that there is;"""
ALIKE: Final = 0.02
"""and what explains less by no more than this is as good."""
ALONE: Final = 0.5
"""Where inputs jump between samples, no single window holds more than this share of a gain."""
HINT: Final = 1.5
"""A linear forecast of the gain below this is not followed up."""
MATTERS: Final = 0.05
"""What is explained of a variable, root mean square, is at least this share of its tolerance."""
SAME: Final = 0.02
"""Fits whose residuals differ by less than this share of what they explain are one and the same."""

SLIPS: Final = (CandidateKind.SIGN, CandidateKind.UNIT_SLIP)
"""Among words for the same, these say most."""
PLIANT: Final = (CandidateKind.REGION, CandidateKind.TERM)
"""These can imitate much."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Tried:
    """One candidate beside those taken before. gain: log-likelihood, its penalty taken off.

    share: of the held-out squared error beyond noise that it explains. is_spread: no window alone
    is most of the gain, or no input jumps between samples, which could look like that.
    """

    effect: Effect
    fitted: Fit
    held_out: Scored
    gain: float
    share: float
    matters: bool
    is_spread: bool


@final
@dataclass(frozen=True, eq=False, slots=True)
class Step:
    """One round: what was tried, best first; whether the first was taken; what explains as well.

    same: which explain the same in other words. alike: which explain it otherwise, as well.
    """

    tried: tuple[Tried, ...]
    same: tuple[Tried, ...]
    alike: tuple[Tried, ...]
    is_taken: bool


@final
@dataclass(frozen=True, eq=False, slots=True)
class Selection:
    """The rounds; `plain` is the spec as it is, `final` holds all that was taken."""

    plain: Fit
    final: Fit
    steps: tuple[Step, ...]

    @property
    def taken(self) -> tuple[Step, ...]:
        """The rounds whose best was taken in and not dropped again."""
        kept = {effect.label for effect in self.final.effects}
        return tuple(s for s in self.steps if s.is_taken and s.tried[0].effect.label in kept)

    def without(self) -> "Selection":
        """With nothing taken in."""
        steps = tuple(replace(step, is_taken=False) for step in self.steps)
        return Selection(self.plain, self.plain, steps)

    def share(self, scene: Scene) -> float:
        """The share of the squared error beyond noise that all that was taken explains."""
        known = np.array([each.floor for each in scene.observed])
        floor = np.maximum(known, white_part(scene, self.final)) ** 2
        before, after = self.plain.sigma**2, self.final.sigma**2
        beyond = float(np.sum(np.maximum(before - floor, 0.0) / after))
        return min(float(np.sum((before - after) / after)) / max(beyond, 1e-300), 1.0)


def select(scene: Scene, effects: tuple[Effect, ...], tolerance: dict[str, float]) -> Selection:
    """Forward selection among `effects`, which stand in order of preference."""
    plain = base = plain_fit(scene)
    steps: list[Step] = []
    while len(steps) < MOST:
        step = _step(scene, base, _left(effects, base), tolerance)
        steps.append(step)
        if not step.is_taken:
            break
        base = _pruned(scene, step.tried[0].fitted, tolerance)
    return Selection(plain, base, tuple(steps))


def _pruned(scene: Scene, base: Fit, tolerance: dict[str, float]) -> Fit:
    """Without those that the others have made superfluous."""
    for place in range(len(base.effects) - 1):
        fewer = _without(scene, base, place)
        both = scored(scene, base), scored(scene, fewer)
        thinning = correlation_time(scene, base.left.residual)
        lost = float(np.sum((both[0].likelihood - both[1].likelihood) / thinning))
        is_clear = lost - len(base.effects[place].numbers) >= CLOSE
        if not (is_clear and _matters(scene, both[1], both[0], tolerance, STAYS)):
            return _pruned(scene, fewer, tolerance)
    return base


def _without(scene: Scene, base: Fit, place: int) -> Fit:
    first = sum(len(each.numbers) for each in base.effects[:place])
    last = first + len(base.effects[place].numbers)
    effects = base.effects[:place] + base.effects[place + 1 :]
    values = base.values[:first] + base.values[last:]
    return fit(scene, effects, values, base.starts, base.sigma)


def _left(effects: tuple[Effect, ...], base: Fit) -> tuple[Effect, ...]:
    """Without those taken, and without a second rate that is put in from outside."""
    taken = {each.label for each in base.effects}
    given = {name for each in base.effects if each.stands_in for name in each.applies_to}
    return tuple(
        each
        for each in effects
        if each.label not in taken and not (each.stands_in and given & set(each.applies_to))
    )


def _step(
    scene: Scene, base: Fit, effects: tuple[Effect, ...], tolerance: dict[str, float]
) -> Step:
    reference = scored(scene, base)
    fits = []
    for effect in _promising(scene, base, effects):
        fitted = extended(scene, base, effect)
        held_out = scored(scene, fitted)
        own = _better(reference, _still(scene, base, effect)) if effect.stands_in else reference
        fits.append((effect, fitted, held_out, own))
    if not fits:
        return Step((), (), (), is_taken=False)
    best = max(fits, key=lambda f: float(np.sum(f[2].likelihood - f[3].likelihood)))
    thinning = correlation_time(scene, best[1].left.residual)
    tried = [_tried(scene, *each, thinning, tolerance) for each in fits]
    return _ranked(scene, tried, base)


def _still(scene: Scene, base: Fit, effect: Effect) -> Scored:
    """The effect at its neutral values: measured states in place of predicted ones, no more."""
    neutral, apply = effect.neutral, effect.apply
    still = replace(effect, numbers=(), apply=lambda setting, _values: apply(setting, neutral))
    effects = (*base.effects, still)
    return scored(scene, fit(scene, effects, base.values, base.starts, base.sigma))


def _better(one: Scored, other: Scored) -> Scored:
    return one if np.sum(one.likelihood) >= np.sum(other.likelihood) else other


def _promising(scene: Scene, base: Fit, effects: tuple[Effect, ...]) -> list[Effect]:
    """Without those of which a linear forecast promises nothing; curved ones stay."""
    single = tuple(each for each in effects if len(each.numbers) == 1)
    together = tuple(each for each in single if not each.stands_in)
    forecast = forecasts(scene, base, together)
    for each in single:
        if each.stands_in:  # it changes the prediction even where its number is neutral
            forecast |= forecasts(scene, base, (each,))
    bent = [each for each in single if np.isinf(forecast[each.label])]
    forecast |= {each.label: _best_start(scene, base, each) for each in bent}
    return [each for each in effects if forecast.get(each.label, np.inf) >= HINT]


def forecasts(scene: Scene, base: Fit, effects: tuple[Effect, ...]) -> dict[str, float]:
    """By label, the log-likelihood that each promises, from the slopes at neutral values."""
    values = (*base.values, *(value for each in effects for value in each.neutral))
    left = profiled(scene, (*base.effects, *effects), values, base.starts, base.sigma)
    white = left.residual / base.sigma[owners(scene)]
    slopes = _freed(left.slopes / base.sigma[owners(scene)][:, None], len(base.values))
    along = np.einsum("wri,wr->i", slopes, white)
    size = np.einsum("wri,wri->i", slopes, slopes)
    return {
        each.label: _forecast(each.numbers[0], float(a), float(b))
        for each, a, b in zip(effects, along, size, strict=True)
    }


def _best_start(scene: Scene, base: Fit, effect: Effect) -> float:
    """The log-likelihood that the best of its starts gains over doing nothing."""
    if not effect.starts:
        return 0.0
    tried = left_of_starts(scene, base, effect)
    return objective(scene, tried[0]) - min(objective(scene, each) for each in tried[1:])


def _forecast(number: Number, along: float, size: float) -> float:
    """The log-likelihood that moving the number promises; infinite where a slope says nothing."""
    if size * (1e3 * number.step) ** 2 < ENOUGH:
        return np.inf
    out = (along < 0.0 and number.neutral <= number.low) or (
        along > 0.0 and number.neutral >= number.high
    )
    return 0.0 if out else 0.5 * along**2 / size


def _freed(slopes: Array, taken: int) -> Array:
    """The slopes of what is new, without what those of the taken numbers explain of them."""
    if taken == 0:
        return slopes
    old = slopes[..., :taken].reshape(-1, taken)
    new = slopes[..., taken:].reshape(len(old), -1)
    rest = new - old @ np.linalg.lstsq(old, new, rcond=None)[0]
    return np.asarray(rest.reshape(*slopes.shape[:2], -1))


def _tried(
    scene: Scene,
    effect: Effect,
    fitted: Fit,
    held_out: Scored,
    reference: Scored,
    thinning: Array,
    tolerance: dict[str, float],
) -> Tried:
    gains = np.sum((held_out.likelihood - reference.likelihood) / thinning, axis=1)
    counts = np.array([int(np.sum(each.used)) for each in scene.observed])
    floor = counts * np.array([each.floor for each in scene.observed]) ** 2
    before, after = np.sum(reference.squares, axis=0), np.sum(held_out.squares, axis=0)
    beyond = np.maximum(before - floor, 0.0) / fitted.sigma**2
    explained = (before - after) / fitted.sigma**2
    return Tried(
        effect=effect,
        fitted=fitted,
        held_out=held_out,
        gain=float(np.sum(gains) - len(effect.numbers) - np.log(effect.best_of)),
        share=min(float(np.sum(explained) / max(float(np.sum(beyond)), 1e-300)), 1.0),
        matters=_matters(scene, reference, held_out, tolerance, MATTERS),
        is_spread=_is_spread(gains) or not jumps_between_samples(scene),
    )


def _is_spread(gains: Array) -> bool:
    """Whether no window alone is most of the gain; one that nothing explains is left out."""
    worst = min(float(np.min(gains)), 0.0)
    return float(np.max(gains)) <= ALONE * (float(np.sum(gains)) - worst)


def _matters(
    scene: Scene, before: Scored, after: Scored, tolerance: dict[str, float], share: float
) -> bool:
    """Whether what is explained of some variable is anything beside its tolerance."""
    counts = np.array([int(np.sum(each.used)) for each in scene.observed])
    allowed = np.array([tolerance.get(each.name, np.inf) for each in scene.observed])
    explained = np.sum(before.squares - after.squares, axis=0)
    return bool(np.any(np.sqrt(np.maximum(explained, 0.0) / counts) > share * allowed))


def _ranked(scene: Scene, tried: list[Tried], base: Fit) -> Step:
    """Best first; of those that say the same, the one that stands first in the preference.

    A part of the region or a further term can imitate much, and yields to all that explains as
    well.
    """
    order = sorted(tried, key=lambda t: -t.gain)
    whole = [t for t in order if t.effect.kind not in PLIANT]
    yields = order[0].effect.kind in PLIANT and whole
    top = whole[0] if yields and order[0].gain - whole[0].gain < CLOSE else order[0]
    same = [t for t in tried if t is top or _are_same(scene, t, top, base)]
    slips = [t for t in same if kind_of(t.effect, _own_values(t)) in SLIPS]
    head = (slips or same)[0]
    alike = [t for t in order if t not in same and _is_as_good(t, top)]
    rest = [t for t in order if t is not head]
    is_clear = head.gain >= CLEAR and head.is_spread
    is_taken = is_clear and head.matters and _is_sure(scene, head)
    others = tuple(t for t in same if t is not head)
    return Step((head, *rest), others, tuple(alike), is_taken=is_taken)


def _is_as_good(other: Tried, top: Tried) -> bool:
    """Where neither is the whole truth, a likelihood says little; shares that are alike do."""
    is_rough = top.share < ROUGH and other.share > top.share - ALIKE
    return top.gain - other.gain < CLOSE or is_rough


def _own_values(tried: Tried) -> Values:
    """The values of the numbers that it brought in, which stand last."""
    values = tried.fitted.values
    return values[len(values) - len(tried.effect.numbers) :]


def _is_sure(scene: Scene, tried: Tried) -> bool:
    """Whether some number of it is surely not where it changes nothing."""
    numbers = tried.effect.numbers
    intervals = intervals_of(scene, tried.fitted, CONFIDENCE)[-len(numbers) :] if numbers else ()
    return not numbers or any(
        not interval.low <= number.neutral <= interval.high
        for number, interval in zip(numbers, intervals, strict=True)
    )


def _are_same(scene: Scene, one: Tried, other: Tried, base: Fit) -> bool:
    if one.effect.stands_in != other.effect.stands_in:
        return False
    scale = other.fitted.sigma[owners(scene)]
    first, second = (t.fitted.left.residual / scale for t in (one, other))
    explained = np.sum(
        (white_slopes(scene, base)[0] * base.sigma[owners(scene)] / scale - second) ** 2
    )
    return bool(np.sum((first - second) ** 2) < SAME * explained)

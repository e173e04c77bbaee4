"""Explanations, tried one by one, the best taken in, then those that are left tried beside it.

A candidate is taken where it predicts held-out windows better than what was taken before it, by
more than chance would, and by enough to matter beside the tolerance.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from verifier.diagnosis.altered import Effect
from verifier.diagnosis.fitting import (
    Fit,
    correlation_time,
    extended,
    fit,
    plain_fit,
    white_slopes,
)
from verifier.diagnosis.heldout import Scored, scored
from verifier.diagnosis.profiled import profiled
from verifier.diagnosis.residuals import owners
from verifier.diagnosis.scene import Scene

MOST: Final = 3
"""So many are taken, at most."""
CLEAR: Final = 6.0
"""A candidate gains at least so much held-out log-likelihood: many are tried."""
CLOSE: Final = 4.0
"""Candidates that gain as much but for this explain as well."""
HINT: Final = 1.5
"""A linear forecast of the gain below this is not followed up."""
MATTERS: Final = 0.05
"""What is explained of a variable, root mean square, is at least this share of its tolerance."""
SAME: Final = 0.02
"""Fits whose residuals differ by less than this share of what they explain are one and the same."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Tried:
    """One candidate beside those taken before. gain: log-likelihood, its penalty taken off.

    share: of the held-out squared error beyond noise that it explains. gains: (W,) per window.
    """

    effect: Effect
    fitted: Fit
    held_out: Scored
    gain: float
    share: float
    matters: bool


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
    def taken(self) -> tuple[Tried, ...]:
        """What was taken in, in order."""
        return tuple(step.tried[0] for step in self.steps if step.is_taken)


def select(scene: Scene, effects: tuple[Effect, ...], tolerance: dict[str, float]) -> Selection:
    """Forward selection among `effects`, which stand in order of preference."""
    plain = base = plain_fit(scene)
    steps: list[Step] = []
    while len(steps) < MOST:
        step = _step(scene, base, _left(effects, base), tolerance)
        steps.append(step)
        if not step.is_taken:
            break
        base = step.tried[0].fitted
    return Selection(plain, base, tuple(steps))


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
        own = _own_reference(scene, base, effect) if effect.stands_in else reference
        fits.append((effect, fitted, held_out, own))
    if not fits:
        return Step((), (), (), is_taken=False)
    best = max(fits, key=lambda f: float(np.sum(f[2].likelihood - f[3].likelihood)))
    thinning = correlation_time(scene, best[1].left.residual)
    tried = [_tried(scene, *each, thinning, tolerance) for each in fits]
    return _ranked(scene, tried, base)


def _own_reference(scene: Scene, base: Fit, effect: Effect) -> Scored:
    """The effect at its neutral values: measured states in place of predicted ones, no more."""
    still = _still(effect)
    values = base.values
    return scored(scene, fit(scene, (*base.effects, still), values, base.starts, base.sigma))


def _still(effect: Effect) -> Effect:
    neutral = effect.neutral
    return Effect(
        effect.kind,
        effect.applies_to,
        effect.label,
        (),
        lambda setting, _values: effect.apply(setting, neutral),
        effect.origin,
    )


def _promising(scene: Scene, base: Fit, effects: tuple[Effect, ...]) -> list[Effect]:
    """Without those of which a linear forecast promises nothing; curved ones stay."""
    smooth = tuple(each for each in effects if not each.starts and len(each.numbers) == 1)
    values = (*base.values, *(value for each in smooth for value in each.neutral))
    together = (*base.effects, *smooth)
    left = profiled(scene, together, values, base.starts, base.sigma)
    white = left.residual / base.sigma[owners(scene)]
    slopes = left.slopes / base.sigma[owners(scene)][:, None]
    slopes = _freed(slopes, len(base.values))
    along = np.einsum("wri,wr->i", slopes, white)
    size = np.maximum(np.einsum("wri,wri->i", slopes, slopes), 1e-300)
    forecast = dict(zip((each.label for each in smooth), 0.5 * along**2 / size, strict=True))
    return [each for each in effects if forecast.get(each.label, np.inf) >= HINT]


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
    allowed = np.array([tolerance.get(each.name, np.inf) for each in scene.observed])
    size = np.sqrt(np.maximum(before - after, 0.0) / counts)
    return Tried(
        effect=effect,
        fitted=fitted,
        held_out=held_out,
        gain=float(np.sum(gains)) - len(effect.numbers),
        share=min(float(np.sum(explained) / max(float(np.sum(beyond)), 1e-300)), 1.0),
        matters=bool(np.any(size > MATTERS * allowed)),
    )


def _ranked(scene: Scene, tried: list[Tried], base: Fit) -> Step:
    """Best first; of those that say the same, the one that stands first in the preference."""
    order = sorted(tried, key=lambda t: -t.gain)
    top = order[0]
    same = [t for t in tried if t is top or _are_same(scene, t, top, base)]
    head = same[0]
    alike = [t for t in order if t not in same and top.gain - t.gain < CLOSE]
    rest = [t for t in order if t is not head]
    is_taken = head.gain >= CLEAR and head.matters
    return Step((head, *rest), tuple(same[1:]), tuple(alike), is_taken=is_taken)


def _are_same(scene: Scene, one: Tried, other: Tried, base: Fit) -> bool:
    if one.effect.stands_in != other.effect.stands_in:
        return False
    scale = other.fitted.sigma[owners(scene)]
    first, second = (t.fitted.left.residual / scale for t in (one, other))
    explained = np.sum(
        (white_slopes(scene, base)[0] * base.sigma[owners(scene)] / scale - second) ** 2
    )
    return bool(np.sum((first - second) ** 2) < SAME * explained)

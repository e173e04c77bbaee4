"""Numbers fitted to all windows: Gauss-Newton under Levenberg's damping, starts free.

Each variable is weighted by what the fit itself leaves of it, so that a calm sensor of a variable
that the model describes badly does not decide alone. The objective is then the likelihood with
unknown noise: sum over variables of N log sigma.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from scipy import special

from runtime.arrays import Array
from verifier.diagnosis.altered import Effect, Values
from verifier.diagnosis.profiled import Profiled, left_over, profiled, setting_of
from verifier.diagnosis.residuals import owners, used
from verifier.diagnosis.scene import Scene
from verifier.diagnosis.sensitivities import noise_floor, remaining_noise
from verifier.report.report import Interval

ROUNDS: Final = 12
DAMPING: Final = 1e-3
ENOUGH: Final = 0.01
"""A round that gains less log-likelihood than this is the last."""
FLAT: Final = 1e-10
"""Directions of the numbers with less than this share of the information stay."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Fit:
    """The fitted values of the effects' numbers, and what is left.

    starts: (W, n). sigma: (D,). left: at the values. objective: to be compared between fits of
    one scene; a natural log-likelihood with its sign turned.
    """

    effects: tuple[Effect, ...]
    values: Values
    starts: Array
    sigma: Array
    left: Profiled
    objective: float


def plain_fit(scene: Scene) -> Fit:
    """The spec as it is: only the starts are fitted."""
    return fit(scene, (), (), scene.start, noise_floor(scene))


def extended(scene: Scene, base: Fit, effect: Effect) -> Fit:
    """The base with one more effect, all numbers fitted together."""
    effects = (*base.effects, effect)
    begins = (effect.neutral, *effect.starts)
    best = 0
    if effect.starts:
        tried = left_of_starts(scene, base, effect)
        best = int(np.argmin([objective(scene, each) for each in tried]))
    return fit(scene, effects, (*base.values, *begins[best]), base.starts, base.sigma)


def left_of_starts(scene: Scene, base: Fit, effect: Effect) -> Array:
    """What is left (1 + starts, W, R) with the effect at its neutral values, then at its starts."""
    effects = (*base.effects, effect)
    begins = (effect.neutral, *effect.starts)
    settings = [setting_of(scene, effects, (*base.values, *each)) for each in begins]
    count = len(begins)
    return left_over(scene, settings, [base.starts] * count, [base.sigma] * count)


def fit(
    scene: Scene, effects: tuple[Effect, ...], begin: Values, starts: Array, sigma: Array
) -> Fit:
    """All numbers of the effects, from `begin`."""
    now = _at(scene, effects, begin, starts, sigma)
    now = _at(scene, effects, begin, now.left.improved, now.sigma)
    damping, refused = DAMPING, 0
    for _ in range(ROUNDS):
        following = _stepped(scene, now, damping)
        gained = now.objective - following.objective
        if gained > -ENOUGH:
            now, damping, refused = following, damping / 5.0, 0
        else:
            damping, refused = 10.0 * damping, refused + 1
        if abs(gained) < ENOUGH or refused == 4:
            break
    return now


def objective(scene: Scene, residual: Array) -> float:
    """The sum of N log sigma over the variables; lower is better."""
    counts = [int(np.sum(each.used)) for each in scene.observed]
    return float(np.sum(np.array(counts) * np.log(remaining_noise(scene, residual))))


def white_slopes(scene: Scene, fitted: Fit) -> tuple[Array, Array]:
    """Residuals (W, R) and slopes (W, R, p) over the noise."""
    scale = fitted.sigma[owners(scene)]
    return fitted.left.residual / scale, fitted.left.slopes / scale[:, None]


def information(slopes: Array) -> Array:
    """The information (p, p) of white slopes (W, R, p)."""
    return np.asarray(np.einsum("wri,wrk->ik", slopes, slopes))


def solved(matrix: Array, right: Array, damping: float) -> Array:
    """The damped Newton step, scaled by the diagonal; flat directions stay."""
    size = np.sqrt(np.maximum(np.diag(matrix), 1e-300))
    scaled = matrix / np.outer(size, size)
    values, vectors = np.linalg.eigh(scaled)
    inverse = np.where(values > FLAT * len(values), 1.0 / (np.maximum(values, 1e-300) + damping), 0)
    return np.asarray((vectors * inverse) @ (vectors.T @ (right / size)) / size)


def intervals_of(scene: Scene, fitted: Fit, confidence: float) -> tuple[Interval, ...]:
    """Of each number: sandwich over windows, which count as independent of one another.

    It allows for residuals that depend on one another within a window (White 1980; Liang and
    Zeger 1986), and is never narrower than what white residuals would give.
    """
    residual, slopes = white_slopes(scene, fitted)
    count = slopes.shape[2]
    if count == 0:
        return ()
    matrix = information(slopes)
    inverse = np.linalg.pinv(matrix, hermitian=True)
    scores = np.einsum("wri,wr->wi", slopes, residual)
    windows = scene.windows
    freedom = max(windows - count, 1)
    meat = np.einsum("wi,wk->ik", scores, scores) * windows / freedom
    robust = np.diag(inverse @ meat @ inverse)
    variance = np.maximum(np.maximum(robust, np.diag(inverse)), 0.0)
    half = special.stdtrit(freedom, 0.5 + confidence / 2.0) * np.sqrt(variance)
    flat = np.diag(matrix) <= 0.0
    half = np.where(flat, np.inf, half)
    return tuple(
        Interval(float(v - h), float(v + h)) for v, h in zip(fitted.values, half, strict=True)
    )


def correlation_time(scene: Scene, residual: Array) -> Array:
    """How many samples (D,) of each variable say as much as one independent one.

    From lagged products within windows, up to the first negative one; 1 for white residuals.
    """
    owner, real = owners(scene), used(scene)
    found = []
    for j in range(len(scene.observed)):
        r = np.where(real, residual, 0.0)[:, owner == j]
        power, total = float(np.sum(r**2)), 1.0
        for lag in range(1, r.shape[1] // 2):
            share = float(np.sum(r[:, lag:] * r[:, :-lag])) / max(power, 1e-300)
            if share <= 0.0:
                break
            total += 2.0 * share
        found.append(total)
    return np.array(found)


def white_part(scene: Scene, fitted: Fit) -> Array:
    """How much (D,) of what is left looks like noise: what neighbours do not share."""
    owner, real = owners(scene), used(scene)
    found = []
    for j, sigma in enumerate(fitted.sigma):
        r = np.where(real, fitted.left.residual, 0.0)[:, owner == j]
        shared = float(np.sum(r[:, 1:] * r[:, :-1])) / max(float(np.sum(r**2)), 1e-300)
        found.append(sigma * np.sqrt(1.0 - min(max(shared, 0.0), 1.0)))
    return np.array(found)


def _at(
    scene: Scene, effects: tuple[Effect, ...], values: Values, starts: Array, sigma: Array
) -> Fit:
    left = profiled(scene, effects, values, starts, sigma)
    rest = remaining_noise(scene, left.residual)
    return Fit(effects, values, starts, rest, left, objective(scene, left.residual))


def _stepped(scene: Scene, now: Fit, damping: float) -> Fit:
    residual, slopes = white_slopes(scene, now)
    right = np.einsum("wri,wr->i", slopes, residual)
    step = solved(information(slopes), right, damping)
    values = within(now.effects, np.array(now.values) + step)
    return _at(scene, now.effects, values, steered(scene, now, values), now.sigma)


def steered(scene: Scene, now: Fit, values: Values) -> Array:
    """The starts (W, n) that go with other values."""
    step = np.array(values) - np.array(now.values)
    starts = np.array(now.left.improved)
    for j, each in enumerate(scene.observed):
        moved = starts[:, each.column] + now.left.steering[:, j] @ step
        starts[:, each.column] = np.clip(moved, each.low, each.high)
    return starts


def within(effects: tuple[Effect, ...], values: Array) -> Values:
    """Values clipped to what the numbers may be."""
    numbers = [number for effect in effects for number in effect.numbers]
    return tuple(
        float(np.clip(v, number.low, number.high))
        for v, number in zip(values, numbers, strict=True)
    )

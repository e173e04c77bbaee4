"""Residuals with their derivatives, and what is left of both when the starts are fitted freely.

Each window's start is a nuisance: with r its residuals, S and J their derivatives by the start and
by the numbers of the effects, all divided by the noise, the best start for given numbers leaves
(1 - P) r and (1 - P) J, where P projects onto the columns of S (variable projection: Golub and
Pereyra 1973).

W windows, R residuals, D predicted states, p numbers.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from verifier.diagnosis.altered import Altered, Effect, Values
from verifier.diagnosis.residuals import owners, residuals, used
from verifier.diagnosis.scene import Scene

NUDGE: Final = 1e-5
"""The difference for derivatives by the start, as a share of the domain."""
LOOSE: Final = 1e-9
"""A ridge, as a share of what the samples tell of each start: directions they miss stay."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Profiled:
    """At some numbers and starts: what is left of the residuals (W, R) and slopes (W, R, p).

    Both in SI, unweighted, starts fitted under the weights 1 / sigma^2. slopes: of the
    *prediction* by the numbers. improved: the starts (W, n) a Gauss-Newton step further;
    steering: how they follow the numbers (W, D, p).
    """

    residual: Array
    slopes: Array
    improved: Array
    steering: Array


def setting_of(scene: Scene, effects: tuple[Effect, ...], values: Values) -> Altered:
    """The plain setting with the effects applied one after the other."""
    setting, at = scene.plain, 0
    for effect in effects:
        count = len(effect.numbers)
        setting = effect.apply(setting, values[at : at + count])
        at += count
    return setting


def profiled(
    scene: Scene, effects: tuple[Effect, ...], values: Values, starts: Array, sigma: Array
) -> Profiled:
    """The residuals at `values`, from `starts`, under the noise `sigma` (D,)."""
    settings = [setting_of(scene, effects, values)]
    settings *= 1 + len(scene.observed)
    lanes = [starts, *_nudged(scene, starts)]
    steps = [number.step for effect in effects for number in effect.numbers]
    for k, step in enumerate(steps):
        other = tuple(v + step * (i == k) for i, v in enumerate(values))
        settings.append(setting_of(scene, effects, other))
        lanes.append(starts)
    found = residuals(scene, settings, np.array(lanes))
    slopes = _slopes(scene, found, starts, steps)
    return _projected(scene, found[0], slopes, starts, sigma)


def left_over(
    scene: Scene, settings: list[Altered], starts: list[Array], sigmas: list[Array]
) -> Array:
    """What free starts leave of the residuals (L, W, R), a setting, starts and a noise per lane."""
    count = 1 + len(scene.observed)
    lanes = [lane for each in starts for lane in (each, *_nudged(scene, each))]
    many = [setting for setting in settings for _ in range(count)]
    found = residuals(scene, many, np.array(lanes))
    found = found.reshape(len(settings), count, scene.windows, -1)
    rows = zip(found, starts, sigmas, strict=True)
    return np.array(
        [
            _projected(scene, f[0], _slopes(scene, f, s, []), s, sigma).residual
            for f, s, sigma in rows
        ]
    )


def _nudged(scene: Scene, starts: Array) -> list[Array]:
    lanes = []
    for each, nudge in zip(scene.observed, _nudges(scene, starts), strict=True):
        lane = np.array(starts)
        lane[:, each.column] += nudge
        lanes.append(lane)
    return lanes


def _nudges(scene: Scene, starts: Array) -> list[Array]:
    """Towards the middle of the domain, so that a start at its edge does not leave it."""
    return [
        NUDGE * o.width * np.where(starts[:, o.column] > 0.5 * (o.low + o.high), -1.0, 1.0)
        if np.isfinite(o.low)
        else np.full(len(starts), NUDGE * o.width)
        for o in scene.observed
    ]


def _slopes(scene: Scene, found: Array, starts: Array, steps: list[float]) -> Array:
    """The derivatives of the prediction by the start and the numbers: (W, R, D + p)."""
    by = [np.broadcast_to(n[:, None], found[0].shape) for n in _nudges(scene, starts)]
    by += [np.full(found[0].shape, step) for step in steps]
    slopes = -(found[1:] - found[0]) / np.array(by)
    return np.moveaxis(np.where(used(scene), slopes, 0.0), 0, -1)


def _projected(scene: Scene, r: Array, slopes: Array, starts: Array, sigma: Array) -> Profiled:
    d = len(scene.observed)
    scale = sigma[owners(scene)][:, None]
    white, whole = r[:, :, None] / scale, slopes / scale
    of_start, of_numbers = whole[..., :d], whole[..., d:]
    normal = np.einsum("wri,wrk->wik", of_start, of_start)
    normal = normal + (LOOSE * normal + 1e-300) * np.eye(d)
    right = np.einsum("wri,wrk->wik", of_start, np.concatenate([white, of_numbers], axis=2))
    solved = np.linalg.solve(normal, right)
    moved = np.array(starts)
    for j, each in enumerate(scene.observed):
        moved[:, each.column] = np.clip(
            starts[:, each.column] + solved[:, j, 0], each.low, each.high
        )
    left = np.concatenate([white, of_numbers], axis=2) - of_start @ solved
    left *= scale
    return Profiled(left[..., 0], left[..., 1:], moved, -solved[..., 1:])

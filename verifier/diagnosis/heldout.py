"""How well a fit predicts windows that it was not fitted to.

Windows are dealt to two halves, neighbours in pairs. The numbers for one half are those that the
other half alone would give (a Gauss-Newton step from the fit to all), and each window is scored
by the logarithm of its likelihood. The noise is that of all errors made so: under the noise of the
other half alone, one window that nothing explains, such as the first one of a sensor that is late,
would outweigh all others. Successive residuals that depend on one another count as the fewer that
they are.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans
from verifier.diagnosis.fitting import (
    Fit,
    information,
    solved,
    steered,
    white_slopes,
    within,
)
from verifier.diagnosis.profiled import left_over, setting_of
from verifier.diagnosis.residuals import owners
from verifier.diagnosis.scene import Scene
from verifier.diagnosis.sensitivities import remaining_noise

HALVES: Final = 2
PAIR: Final = 2
"""Neighbours of so many are dealt together, where there are enough windows."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Scored:
    """Per window and variable (W, D): held-out squares of the errors, and log-likelihood."""

    squares: Array
    likelihood: Array


def scored(scene: Scene, fitted: Fit) -> Scored:
    """Every window, predicted by the half that it is not in."""
    halves = halves_of(scene)
    residual, slopes = white_slopes(scene, fitted)
    settings, starts, sigmas = [], [], []
    for mine in halves:
        train = ~mine
        values = fitted.values
        if values:
            right = np.einsum("wri,wr->i", slopes[train], residual[train])
            step = solved(information(slopes[train]), right, 0.0) * _is_free(fitted)
            values = within(fitted.effects, np.array(values) + step)
        settings.append(setting_of(scene, fitted.effects, values))
        starts.append(steered(scene, fitted, values))
        sigmas.append(_noise_of(scene, fitted, train))
    found = left_over(scene, settings, starts, sigmas)
    held = np.zeros_like(residual)
    for rest, mine in zip(found, halves, strict=True):
        held[mine] = rest[mine]
    squares, sigma = _squares(scene, held), remaining_noise(scene, held)
    counts = np.stack([np.sum(each.used, axis=1) for each in scene.observed], axis=1)
    return Scored(squares, -(squares / (2.0 * sigma**2) + counts * np.log(sigma)))


def halves_of(scene: Scene) -> list[Booleans]:
    """Which windows (W,) are in each half."""
    pair = PAIR if scene.windows >= 4 * PAIR else 1
    half = (np.arange(scene.windows) // pair) % HALVES
    return [np.asarray(half == k) for k in range(HALVES)]


def _is_free(fitted: Fit) -> Booleans:
    """Which numbers (p,) are not at an end of their range, where a slope says little."""
    numbers = [number for effect in fitted.effects for number in effect.numbers]
    ends = np.array([(number.low, number.high) for number in numbers]).reshape(-1, 2)
    values = np.array(fitted.values)
    return np.asarray((values > ends[:, 0]) & (values < ends[:, 1]))


def _noise_of(scene: Scene, fitted: Fit, train: Booleans) -> Array:
    """The noise (D,) that the training windows show."""
    share = np.sum(train) / len(train)
    residual = np.where(train[:, None], fitted.left.residual, 0.0) / np.sqrt(share)
    return remaining_noise(scene, residual)


def _squares(scene: Scene, residual: Array) -> Array:
    owner = owners(scene)
    return np.stack(
        [np.sum(residual[:, owner == j] ** 2, axis=1) for j in range(len(scene.observed))], axis=1
    )

"""How much the trace tells of each scalar: sensitivities of the errors, and the information matrix.

The information matrix is that of multiple shooting with free starts: sum over windows of
J' (1 - P) J, each row divided by its noise. Its inverse bounds the covariance of a refit (Cramér
and Rao); its flat directions are what this trace does not tell.
"""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array
from verifier.diagnosis.parameters import Parameter, effect_of
from verifier.diagnosis.profiled import profiled
from verifier.diagnosis.residuals import owners, used
from verifier.diagnosis.scene import Scene


@final
@dataclass(frozen=True, eq=False, slots=True)
class Sensitivities:
    """Of p parameters, in W windows, for the D predicted states `variables`.

    shift: (W, D, p) how far the prediction at the end of the window moves, in the variable's SI
    unit, per unit of the parameter, the start fitted to the samples anew. spread: (D, p) the root
    mean square of that over all samples. information: (p, p), per product of parameter units,
    under `noise` (D,), the root mean square that the spec leaves unexplained.
    """

    parameters: tuple[Parameter, ...]
    variables: tuple[str, ...]
    shift: Array
    spread: Array
    information: Array
    noise: Array


def sensitivities(scene: Scene, parameters: tuple[Parameter, ...]) -> Sensitivities:
    """At the spec's values, with starts fitted to the samples of each window."""
    effects = tuple(effect_of(parameter) for parameter in parameters)
    values = tuple(parameter.spec for parameter in parameters)
    sigma = noise_floor(scene)
    first = profiled(scene, (), (), scene.start, sigma)
    sigma = remaining_noise(scene, first.residual)
    found = profiled(scene, effects, values, first.improved, sigma)
    sigma = remaining_noise(scene, found.residual)
    white = found.slopes / sigma[owners(scene)][:, None]
    return Sensitivities(
        parameters=parameters,
        variables=tuple(each.name for each in scene.observed),
        shift=_at_the_end(scene, found.slopes),
        spread=_spread(scene, found.slopes),
        information=np.einsum("wri,wrk->ik", white, white),
        noise=sigma,
    )


def noise_floor(scene: Scene) -> Array:
    """The least noise (D,) that is believed of each predicted state."""
    return np.array([max(each.floor, 1e-6 * each.width) for each in scene.observed])


def remaining_noise(scene: Scene, residual: Array) -> Array:
    """The root mean square (D,) of residuals (W, R) whose starts are fitted."""
    owner, real = owners(scene), used(scene)
    found = []
    for j in range(len(scene.observed)):
        mine = real[:, owner == j]
        squares = float(np.sum(residual[:, owner == j] ** 2))
        found.append(np.sqrt(squares / max(int(np.sum(mine)) - len(mine), 1)))
    return np.maximum(found, noise_floor(scene))


def _at_the_end(scene: Scene, slopes: Array) -> Array:
    """The slopes (W, R, p) at the last sample of each state in each window: (W, D, p)."""
    owner, real = owners(scene), used(scene)
    found = []
    for j in range(len(scene.observed)):
        mine = slopes[:, owner == j]
        last = np.sum(real[:, owner == j], axis=1) - 1
        found.append(mine[np.arange(len(mine)), last])
    return np.stack(found, axis=1)


def _spread(scene: Scene, slopes: Array) -> Array:
    owner, real = owners(scene), used(scene)
    counts = [max(int(np.sum(real[:, owner == j])), 1) for j in range(len(scene.observed))]
    return np.array(
        [
            np.sqrt(np.sum(slopes[:, owner == j] ** 2, axis=(0, 1)) / count)
            for j, count in enumerate(counts)
        ]
    )

"""Local models joined to one field: each holds alone at its feature, and fades with the distance.

Shepard's weights (D. Shepard, "A two-dimensional interpolation function for irregularly-spaced
data", 1968): w_i = d_i^-p / sum of d_j^-p is 1 - O(d_i^p) near feature i, so the blend has every
feature at its place, with its own linear part. N: places; M: models; B: parts of all models.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from compiler.sketch.models import Model, Settings
from runtime.arrays import Array
from spec_schema.expressions.tree import Expr

NEAREST: Final = 1e-9
"""Distances count as at least so much: the weights stay numbers on the features themselves."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Blend:
    """Models that share a region. power: how quickly each fades."""

    models: tuple[Model, ...]
    power: float

    @property
    def coefficients(self) -> tuple[Expr, ...]:
        """What each part of the blend is multiplied by, 1/s."""
        return tuple(c for model in self.models for c in model.coefficients)

    def weights(self, q: Array, settings: Settings) -> Array:
        """How much (N, M) each model counts; 1 in all."""
        far = np.stack([model.distance(q, settings) for model in self.models], axis=1)
        far = np.maximum(far, NEAREST)
        near = (far.min(axis=1, keepdims=True) / far) ** self.power
        weights: Array = near / near.sum(axis=1, keepdims=True)
        return weights

    def parts(self, q: Array, settings: Settings) -> Array:
        """The vectors (N, B, 2) of all parts at places (N, 2)."""
        weights = self.weights(q, settings)
        return np.concatenate(
            [
                weights[:, i, np.newaxis, np.newaxis] * model.parts(q, settings)
                for i, model in enumerate(self.models)
            ],
            axis=1,
        )

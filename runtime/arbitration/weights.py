"""Weighted choice: each choice counts as much as its expression says."""

from typing import final

import numpy as np

from runtime.arbiter import Arbiter
from runtime.arbitration.conditions import Conditions
from runtime.arrays import Array


@final
class Weights:
    """Numbers for a blend; what is below 0, or no number, counts as 0."""

    def __init__(self, arbiter: Arbiter) -> None:
        self._conditions = Conditions(arbiter, arbiter.weights)

    def reset(self, seed: int) -> None:
        """Do nothing: nothing is kept."""

    def decide(self, reads: Array, time: float) -> Array:  # noqa: ARG002  # weights have no memory
        """The weights."""
        values = self._conditions.at(reads)
        return np.where(values > 0.0, values, 0.0)

    def learn(self, reward: float) -> None:
        """Do nothing: weights do not learn."""

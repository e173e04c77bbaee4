"""Competition: choices as activations of a dynamical system (Large, Christensen, Bajcsy 1999).

time * u_i' = a_i u_i - |a_i| u_i**3 - sum over j != i of g_ji u_j**2 u_i, plus noise (their eq. 4).
"""

import math
from typing import Final, final

import numpy as np

from runtime import chance
from runtime.arbiter import Arbiter, Competition
from runtime.arbitration.conditions import Conditions
from runtime.arbitration.kernels.compete import compete
from runtime.arrays import Array

STEPS: Final = 20
"""Steps in one time scale, and so many times more as suppression makes it faster."""
LARGEST: Final = 100.0
"""Suppressions are kept within this."""


@final
class Competing:
    """Activations that compete; each choice holds as strongly as its activation squared.

    Between two decisions the situation is taken as it was read at the first one: a decision lets
    the activations compete for one period with what is read now, and says where they came to.
    """

    def __init__(self, arbiter: Arbiter, name: str, period: float) -> None:
        assert arbiter.competition is not None, "a competition"
        self._competition: Competition = arbiter.competition
        self._name = name
        self._count = len(arbiter.choices)
        rows = [code for row in self._competition.suppression for code in row]
        self._conditions = Conditions(arbiter, [*self._competition.advantage, *rows])
        self._period = period
        self.reset(0)

    def reset(self, seed: int) -> None:
        """Begin in the balance, from which noise lets the activations leave."""
        self.activations: Array = np.zeros(self._count)
        self._generator = chance.generator(seed, "competition", self._name)

    def decide(self, reads: Array, time: float) -> Array:  # noqa: ARG002  # it is periodic
        """The squares of the activations, one period on."""
        values = np.nan_to_num(self._conditions.at(reads))
        advantage = np.clip(values[: self._count], -1.0, 1.0)
        suppression = np.clip(values[self._count :], -LARGEST, LARGEST).reshape(-1, self._count)
        time_scale, noise = self._competition.time, self._competition.noise
        quickness = max(1.0, float(np.abs(suppression).sum(axis=0).max()))
        steps = math.ceil(STEPS * quickness * self._period / time_scale * (1.0 - 1e-9))
        step = self._period / steps
        compete(
            self.activations,
            advantage,
            suppression,
            self._generator.standard_normal((steps, self._count)),
            step / time_scale,
            noise * math.sqrt(step),
        )
        return self.activations**2

    def learn(self, reward: float) -> None:
        """Do nothing: its parameters are given."""

"""A plan: a behavior with modes, one level up; the mode that it is in is the choice."""

from typing import final

import numpy as np

from runtime import chance
from runtime.arbiter import Arbiter
from runtime.arbitration.conditions import entries_of
from runtime.architecture import Input, Outside
from runtime.arrays import Array
from runtime.program import Program
from runtime.scheduler.inputs import Inputs
from runtime.scheduler.ticker import Ticker, domains_of


@final
class Plan:
    """A program with modes that ticks as a behavior does; the mode at the sample gets 1."""

    def __init__(self, arbiter: Arbiter, name: str, period: float) -> None:
        assert arbiter.plan is not None, "a plan"
        self._program: Program = arbiter.plan
        self._names = entries_of(arbiter)
        self._name, self._period = name, period
        self._count = len(arbiter.choices)
        states = [state.name for state in self._program.states]
        self._mode = states.index(self._program.field.mode)
        self.reset(0)

    def reset(self, seed: int) -> None:
        """Begin in the mode, and with the own states, that the plan holds at its beginning."""
        wires = [
            Input(name, place, 0.0, 1.0, Outside.CLIP, "")
            for place, name in enumerate(self._names)
            if name in self._program.register
        ]
        inputs = Inputs(wires, domains_of(self._program))
        generator = chance.generator(seed, "plan", self._name)
        self.ticker = Ticker(self._program, inputs, (), None, self._period, generator)

    def decide(self, reads: Array, time: float) -> Array:  # noqa: ARG002  # it is periodic
        """1 for the mode that it is in."""
        self.ticker.tick(np.ascontiguousarray(reads), allowed=True)
        numbers = np.zeros(self._count)
        numbers[int(self.ticker.register[self._mode])] = 1.0
        return numbers

    def learn(self, reward: float) -> None:
        """Do nothing: plans do not learn."""

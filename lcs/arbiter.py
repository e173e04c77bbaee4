"""A learner in the place of an arbiter, which it fits by shape; it knows nobody here."""

from typing import Protocol, final

import numpy as np
import numpy.typing as npt

from lcs.arrays import Array


class Acting(Protocol):
    """A learner that acts one input at a time: `ALCSR`, `XCSR`."""

    def act(self, x: npt.ArrayLike) -> int:
        """The action on an input (n,)."""
        ...

    def learn(self, reward: float) -> None:
        """The reward of that action."""
        ...

    def give_up(self) -> None:
        """No reward will come for that action."""
        ...


@final
class LearningArbiter:
    """Decides by what a learner says, and lets it learn while it runs.

    Each choice is an action, each decision a problem: what is rewarded is the time until the next
    decision. Rewards should be few levels, such as 1000 and 0 (thesis, 4.3.1).

    Args:
        learner: what decides and learns; it is kept from run to run.
        choices: how many there are.
    """

    def __init__(self, learner: Acting, choices: int) -> None:
        self._learner, self._choices = learner, choices

    def reset(self, seed: int) -> None:  # noqa: ARG002  # chance is the learner's own
        """Begin a run; what the last decision of the run before led to is not known."""
        self._learner.give_up()

    def decide(self, reads: Array, time: float) -> Array:  # noqa: ARG002  # no clock
        """1 for the action that the learner takes at reads (m,), as (k,).

        Raises:
            LearnerError: not as many finite numbers as the learner has inputs.
        """
        numbers = np.zeros(self._choices)
        numbers[self._learner.act(reads)] = 1.0
        return numbers

    def learn(self, reward: float) -> None:
        """Take the reward for what happened since the last decision.

        Raises:
            LearnerError: it is not finite.
        """
        self._learner.learn(reward)

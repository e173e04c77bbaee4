"""What an arbiter is, for the scheduler: by its shape, so that a learner need know nobody here."""

from typing import Protocol

from runtime.arrays import Array


class Arbiter(Protocol):
    """A control module that says, at each of its decision ticks, how strongly each choice holds.

    The scheduler calls `reset` once before a run, then at each tick `decide`; a learner's `learn`
    is called before each `decide` but the first.
    """

    def reset(self, seed: int) -> None:
        """Begin a run: forget what was latched; all its chance follows from `seed`.

        What was learned may stay.
        """
        ...

    def decide(self, reads: Array, time: float) -> Array:
        """How strongly each choice holds, (k,) numbers of 0 or more, in the order of the choices.

        reads: (m,) what it reads, then its controls, in SI, in their declared order; it is the
        caller's, to be read during the call only. time: seconds, that of this tick.
        """
        ...

    def learn(self, reward: float) -> None:
        """Take the reward for what happened since the last decision."""
        ...

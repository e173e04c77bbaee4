"""What a run gives: states over time, and how each trajectory ended."""

from dataclasses import dataclass
from enum import StrEnum
from typing import final

import numpy as np

from runtime.arrays import Array, Integers


@final
class Ending(StrEnum):
    """How a trajectory ended; `sentence` says it to people."""

    COMPLETED = "completed"
    LEFT_DOMAIN = "left domain"
    DIVERGED = "diverged"
    TOO_MANY_STEPS = "too many steps"
    CHATTERING = "chattering"

    @property
    def sentence(self) -> str:
        """The ending in words."""
        return {
            Ending.COMPLETED: "the run reached its end",
            Ending.LEFT_DOMAIN: "the state left the domain, where the behavior says nothing",
            Ending.DIVERGED: "the rates are not finite here",
            Ending.TOO_MANY_STEPS: "the step limit was reached before the end of the run",
            Ending.CHATTERING: "the mode switches without end, in no time",
        }[self]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Switches:
    """All switches of mode of a batch, trajectory by trajectory, in the order of time; SI.

    trajectories: (k,) indices of the flattened leading axes. times: (k,) seconds.
    left, entered: (k,) indices of modes. before, after: (k, n) the states, without and with the
    jumps and the new mode.
    """

    trajectories: Integers
    times: Array
    left: Integers
    entered: Integers
    before: Array
    after: Array

    def __len__(self) -> int:
        """How many there are."""
        return len(self.times)

    def of(self, trajectory: int) -> "Switches":
        """Those of one trajectory."""
        mine = slice(*np.searchsorted(self.trajectories, [trajectory, trajectory + 1]))
        return Switches(
            self.trajectories[mine],
            self.times[mine],
            self.left[mine],
            self.entered[mine],
            self.before[mine],
            self.after[mine],
        )


@final
@dataclass(frozen=True, eq=False, slots=True)
class Rollout:
    """A behavior's run, or a batch of them with the leading axes `...`; all in SI.

    times: (T,) seconds from 0. states: (..., T, n), angles not wrapped, NaN after the end.
    controls: (..., p). outputs: (..., T, q).
    endings, details: one for each trajectory, in the order of the flattened leading axes; a
    detail is a sentence with names and numbers, empty where the run completed.
    ended_at: (...) seconds. ended_in: (..., n) the state there.
    switches: when modes switched; a sample at that very time is of the mode before.
    """

    program: str
    times: Array
    states: Array
    controls: Array
    outputs: Array
    endings: tuple[Ending, ...]
    details: tuple[str, ...]
    ended_at: Array
    ended_in: Array
    switches: Switches

    @property
    def ending(self) -> Ending:
        """The ending of a single run; of a batch, the first one that is not `COMPLETED`."""
        broken = (ending for ending in self.endings if ending is not Ending.COMPLETED)
        return next(broken, Ending.COMPLETED)

    @property
    def detail(self) -> str:
        """The detail that belongs to `ending`."""
        return self.details[self.endings.index(self.ending)]

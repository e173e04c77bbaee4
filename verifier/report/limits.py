"""What a trace cannot tell: what it leaves open, and how small a fault in it would show.

Both are found by the verifier itself, on this very trace. Neither ever makes a verdict better.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import final

from runtime.program import Unit
from verifier.report.report import Verdict


@final
class Fault(StrEnum):
    """What is planted into a copy of the trace."""

    GAIN = "gain"
    """The rate of a driven variable (of a step map: its increment) is larger by a share."""
    OFFSET = "offset"
    """A constant is added to the rate of a driven variable."""
    DELAY = "delay"
    """The robot acts on an input later than it is logged."""
    SENSOR = "sensor"
    """The log shows a constant too much of a variable."""


@final
@dataclass(frozen=True, slots=True)
class NotTold:
    """Something about the robot that this trace leaves open.

    what: the thing, as a phrase ("the gain of turn apart from its saturation"). names: the
    variables, controls, parameters that it is about. why: a sentence. suggestion: what to record,
    a sentence. origin: the place in the spec that it is about.
    """

    what: str
    names: tuple[str, ...]
    why: str
    suggestion: str
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Trial:
    """One copy of the trace, judged: the planted size (SI, signed), and the verdict on it."""

    size: float
    verdict: Verdict


@final
@dataclass(frozen=True, slots=True)
class Caught:
    """How large one fault has to be for this trace to show it.

    unit: of all sizes here, a gain's is per cent. smallest: the smallest size that was caught, in
    whichever direction it was planted; infinite where none was. largest: the largest size that
    was *not* caught, 0 where all were. trials: all sizes that were tried, ascending. shown_by:
    the variables whose departure gave the smallest one away.
    sentence: all this in words.
    """

    fault: Fault
    variable: str
    unit: Unit
    smallest: float
    largest: float
    trials: tuple[Trial, ...]
    shown_by: tuple[str, ...]
    sentence: str
    origin: str

    @property
    def is_caught(self) -> bool:
        """Whether any size was caught."""
        return self.smallest < float("inf")


@final
@dataclass(frozen=True, slots=True)
class Limits:
    """What this trace cannot tell, most telling first, and what it would have caught.

    notes: on what the self-test rests (a part of a long trace, for example), or why there is none.
    """

    not_told: tuple[NotTold, ...]
    caught: tuple[Caught, ...]
    notes: tuple[str, ...]

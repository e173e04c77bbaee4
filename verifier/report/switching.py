"""The mode changes of a robot, as data: when it switched, where to, and how its state jumped.

A switch that comes early or late is an error of *time*, never of state. SI throughout, seconds from
the trace's start; modes by the names that the spec gives them. A *way* is a guard of the spec: the
change from one mode to another.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import Final, final

from runtime.program import Unit
from verifier.report.report import Interval, Standing


@final
class SwitchSort(StrEnum):
    """What a change of mode is, seen from the spec.

    EXPECTED: the model switches there, too, sooner or later; what counts is the time between them.
    UNEXPECTED: the robot switched, and the model would not have, within a horizon.
    MISSED: the model would have switched, and the robot did not, within a horizon.
    WRONG_TARGET: both switched, to different modes.
    UNDECLARED: the spec has no way between these two modes at all.
    UNJUDGED: beside a gap, an exclusion or an end of the trace, or with too few samples.
    """

    EXPECTED = "expected"
    UNEXPECTED = "unexpected"
    MISSED = "missed"
    WRONG_TARGET = "wrong target"
    UNDECLARED = "undeclared"
    UNJUDGED = "not judged"


@final
@dataclass(frozen=True, slots=True)
class Switch:
    """One change of mode.

    time: when the robot changed; of a missed one, when the model would have. target: where the
    robot went; of a missed one, where the model would have gone. wanted: where the model would
    have gone, where that is another mode; else empty.
    late: how much later than the model the robot switched (s), negative where it was earlier;
    doubt: its standard deviation from noise and from the stamps of the mode; allowed: the time
    that the tolerance of the states allows here. The three are NaN where nothing can be compared.
    """

    time: float
    source: str
    target: str
    sort: SwitchSort
    wanted: str
    late: float
    doubt: float
    allowed: float


@final
@dataclass(frozen=True, slots=True)
class Sample:
    """What a mean over switches is of: values, the standard deviations of their noise.

    bias: what their mean may be off by, whatever the count.
    """

    values: tuple[float, ...]
    deviations: tuple[float, ...]
    bias: float


NO_SAMPLE: Final = Sample((), (), 0.0)


@final
@dataclass(frozen=True, slots=True)
class Timing:
    """How late the robot takes one way, on average (s), against what the tolerance allows.

    allowed: the tolerance of the states that the guard reads over the speed at which the guard is
    approached; `basis` says of what it was derived, as a phrase. resolution: within which time
    (s) the log tells a switch.
    """

    count: int
    late: float
    interval: Interval
    allowed: float
    basis: str
    resolution: float
    standing: Standing
    sample: Sample = NO_SAMPLE


@final
@dataclass(frozen=True, slots=True)
class Jump:
    """The state just after a switch against what the spec says of it, on average over switches.

    is_reset: the spec gives it a new value; else it is to go on from where it was.
    error: measured minus predicted.
    """

    name: str
    unit: Unit
    is_reset: bool
    count: int
    error: float
    interval: Interval
    tolerance: float
    standing: Standing
    sample: Sample = NO_SAMPLE


@final
@dataclass(frozen=True, slots=True)
class Way:
    """One guard of the spec: how often it was taken, when, and with which jumps.

    timing is None where no switch could be compared. unexpected, missed, wrong: counts of those
    sorts; a wrong target counts at the way that the model would have taken.
    origin: the guard's place in the spec.
    """

    source: str
    target: str
    expected: int
    unexpected: int
    missed: int
    wrong: int
    timing: Timing | None
    jumps: tuple[Jump, ...]
    standing: Standing
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Switching:
    """All changes of mode of a trace.

    mode: the discrete state. ways: all guards of the spec, in its order. switches: in order of
    time. standing: EXCEEDED where some way is; WITHIN where every way that was taken is.
    reasons: sentences, those that speak against the robot first. advice: what to do next.
    """

    mode: str
    ways: tuple[Way, ...]
    switches: tuple[Switch, ...]
    standing: Standing
    reasons: tuple[str, ...]
    advice: tuple[str, ...]

"""The test procedure of a behavior: runs to drive and record, and what a rehearsal of them showed.

All numbers are SI. A procedure is derived from the spec alone, by the numbers by which the verifier
judges, so that what it asks for is what the verifier needs.
"""

from dataclasses import dataclass
from typing import final

from runtime.program import Unit
from verifier.report.report import Verdict


@final
@dataclass(frozen=True, slots=True)
class Stage:
    """A part of a run: for so many seconds controls and sensed quantities are `held` like this."""

    seconds: float
    held: dict[str, float]


@final
@dataclass(frozen=True, slots=True)
class Drive:
    """A run: where the behavior is started, what is held meanwhile, and how often it is repeated.

    start: by the name of the state; of a discrete one the index of its value. cells: the flat
    indices of the cells of the coverage that it goes through.
    """

    start: dict[str, float]
    stages: tuple[Stage, ...]
    repeats: int
    cells: tuple[int, ...] = ()

    @property
    def seconds(self) -> float:
        """How long one repetition takes."""
        return sum(stage.seconds for stage in self.stages)


@final
@dataclass(frozen=True, slots=True)
class Signal:
    """What is logged: noise is the standard deviation of a sensor with which it was rehearsed.

    values: of a discrete one, the names of its values. is_set: a control. is_sensed: a quantity
    that the behavior senses and does not move.
    """

    name: str
    unit: Unit
    noise: float
    values: tuple[str, ...]
    is_set: bool
    is_sensed: bool

    @property
    def is_moved(self) -> bool:
        """Whether it is a quantity that things have to be moved for, from value to value."""
        return self.is_sensed and not self.values


@final
@dataclass(frozen=True, slots=True)
class Excitation:
    """Whether a control or sensed quantity can be told from such runs.

    effect: by how many tolerances it moves what is judged, at the horizon, from one end of what the
    runs hold it at to the other; below 1 no recording within the tolerance tells its value.
    """

    name: str
    low: float
    high: float
    effect: float


@final
@dataclass(frozen=True, slots=True)
class Planted:
    """A robot that departs from the spec in one variable, and what the verifier says of it.

    push: what is added to its rate (of a step map: to each step). departure: by how much that
    carries it away at the horizon, on average. is_named: whether this variable is among those that
    are shown to exceed their tolerance.
    """

    variable: str
    push: float
    departure: float
    verdict: Verdict
    is_named: bool

    @property
    def is_caught(self) -> bool:
        """Whether it fails, and by this variable."""
        return self.verdict is Verdict.FAIL and self.is_named


@final
@dataclass(frozen=True, slots=True)
class WayTime:
    """By how much (s) a change of mode may be early or late, on average, in these runs.

    count: how often the faithful robot takes this way in them. basis: what `allowed` follows from,
    as a phrase.
    """

    source: str
    target: str
    count: int
    allowed: float
    basis: str


@final
@dataclass(frozen=True, slots=True)
class Rehearsal:
    """What the verifier says of the procedure where the spec itself drives, with noisy sensors.

    share: of the cells of the coverage, how many were seen. judged: seconds. reasons: of the
    verdict. ways: what is asked of changes of mode.
    """

    verdict: Verdict
    share: float
    judged: float
    reasons: tuple[str, ...]
    planted: tuple[Planted, ...]
    ways: tuple[WayTime, ...]

    @property
    def decides(self) -> bool:
        """Whether a faithful robot passes, and each robot that departs fails."""
        caught = all(each.is_caught for each in self.planted)
        return self.verdict is Verdict.PASS and caught


@final
@dataclass(frozen=True, slots=True)
class Lateness:
    """What the timing of the robot that it was rehearsed with takes up of the tolerances.

    period, response_time: seconds. share: of a tolerance, at worst in these runs. slower: a robot
    so many times later breaks a tolerance by that alone; 0 where none that was tried does.
    """

    period: float
    response_time: float
    share: float
    slower: float


@final
@dataclass(frozen=True, slots=True)
class Procedure:
    """What to record of one behavior.

    rate: samples a second. horizon: seconds. required: the share of cells that must be seen, 0
    where the spec demands none. lateness: None of a robot that follows at once. remarks: sentences
    on what the runs leave open. rehearsal: None where the procedure was not rehearsed.
    """

    name: str
    horizon: float
    rate: float
    drives: tuple[Drive, ...]
    signals: tuple[Signal, ...]
    excited: tuple[Excitation, ...]
    required: float
    lateness: Lateness | None
    remarks: tuple[str, ...]
    rehearsal: Rehearsal | None

    @property
    def seconds(self) -> float:
        """How long all runs take together."""
        return sum(drive.seconds * drive.repeats for drive in self.drives)

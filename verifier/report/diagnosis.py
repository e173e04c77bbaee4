"""Why the robot departs from its spec, as data: what was refitted, and what would explain the rest.

SI throughout; a `Unit` says how people read a number. Intervals are at the report's confidence.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import Final, final

from runtime.program import Unit
from verifier.report.report import Interval, RegionMean, Standing


@final
class Told(StrEnum):
    """What the diagnosis says as a whole.

    SAME_STRUCTURE: moving numbers of the spec explains what departs. LOG_DIFFERS: an entry of
    `trace:` with another delay, sign, unit, scale or offset does. STRUCTURE_DIFFERS: neither does;
    the first candidates say what would, if anything does. CANNOT_TELL: the trace does not decide
    between explanations, or is too short to.
    """

    NO_DIFFERENCE = "no difference"
    SAME_STRUCTURE = "same structure"
    LOG_DIFFERS = "log differs"
    STRUCTURE_DIFFERS = "structure differs"
    CANNOT_TELL = "cannot tell"


@final
class ParameterKind(StrEnum):
    """What kind of number was refitted.

    CONTROL: a control parameter that this trace holds constant. CONSTANT: one of the spec's
    `constants:`. RATE_GAIN, RATE_OFFSET: of one driven variable's rate (1 and 0 in the spec).
    TIME_SCALE: of all rates (1). INPUT_GAIN, INPUT_OFFSET: of a measured input (1 and 0).
    SENSOR_SCALE, SENSOR_OFFSET: of a driven variable as measured (1 and 0).
    """

    CONTROL = "control"
    CONSTANT = "constant"
    RATE_GAIN = "gain of a rate"
    RATE_OFFSET = "offset of a rate"
    TIME_SCALE = "time scale"
    INPUT_GAIN = "gain of an input"
    INPUT_OFFSET = "offset of an input"
    SENSOR_SCALE = "scale of a sensor"
    SENSOR_OFFSET = "offset of a sensor"


OF_SENSORS: Final = (ParameterKind.SENSOR_SCALE, ParameterKind.SENSOR_OFFSET)


@final
class CandidateKind(StrEnum):
    """What would explain a departure.

    DEAD_TIME: the robot answers to an input late. LATE_LOG: the log tells a series late (a
    `delay:` in `trace:` would mend it). CLOCK_OFFSET: all series of one topic, together. LAG: an
    input acts through a first-order lag. PARAMETER: a number of the spec, alone. EXCHANGED_VALUES:
    of a discrete variable. BOUND: a state goes no further than a value. REGION: a rate is off
    where some variable is beyond a border. TERM: a rate has a further term.
    """

    PARAMETER = "parameter"
    DEAD_TIME = "dead time"
    LATE_LOG = "late log"
    CLOCK_OFFSET = "clock offset"
    LAG = "first-order lag"
    GAIN = "gain"
    BIAS = "bias"
    SATURATION = "saturation"
    DEAD_ZONE = "dead zone"
    BOUND = "bound of a state"
    SIGN = "sign"
    SWAPPED_AXES = "swapped axes"
    UNIT_SLIP = "unit slip"
    EXCHANGED_VALUES = "exchanged values"
    REGION = "in one region"
    TERM = "further term"
    GUARD = "guard"


OF_READINGS: Final = (
    CandidateKind.LATE_LOG,
    CandidateKind.CLOCK_OFFSET,
    CandidateKind.SIGN,
    CandidateKind.UNIT_SLIP,
    CandidateKind.SWAPPED_AXES,
    CandidateKind.EXCHANGED_VALUES,
)


@final
@dataclass(frozen=True, slots=True)
class Refitted:
    """One number, refitted together with the others that `Diagnosis.refitted` holds.

    name: of the control or constant, else of the variable that it applies to; empty for the time
    scale. spec: its value in the spec. is_moved: its interval does not hold the spec's value.
    origin: where it stands in the YAML.
    """

    kind: ParameterKind
    name: str
    unit: Unit
    spec: float
    value: float
    interval: Interval
    is_moved: bool
    origin: str
    sentence: str


@final
@dataclass(frozen=True, slots=True)
class FittedNumber:
    """A number of a candidate: `value` as fitted, `neutral` where it changes nothing.

    A number that does not belong to the spec (a delay, a dead zone) comes on top of what the
    spec says already.
    """

    name: str
    unit: Unit
    neutral: float
    value: float
    interval: Interval


@final
@dataclass(frozen=True, slots=True)
class Evidence:
    """How well a candidate predicts windows that it was not fitted to.

    windows: of a GUARD, switches, each told by the mean of all others.
    share: of their squared error beyond noise that it explains (1: all; below 0: it predicts
    worse). gain: of log-likelihood, natural logarithms, per-number penalty taken off. before:
    candidates that were already taken in when this one was tried.
    """

    windows: int
    share: float
    gain: float
    before: tuple[str, ...]


@final
@dataclass(frozen=True, slots=True)
class Candidate:
    """One explanation.

    applies_to: the variables, inputs or topics. label: a short name, such as `dead time of turn`.
    is_taken: the diagnosis names it. alike: labels of the candidates that explain as well.
    origin: where in the YAML it would be mended. claim: what the robot, the spec or the log would
    have to be like; `sentence` adds the evidence. leaves: what it leaves beyond a tolerance,
    with those that were taken before it; empty where nothing is. slip: of a UNIT_SLIP, what the
    log is in and what it was taken for, in words. parameter: of what kind its number is, where it
    is one of those that are refitted.
    """

    kind: CandidateKind
    applies_to: tuple[str, ...]
    label: str
    numbers: tuple[FittedNumber, ...]
    evidence: Evidence
    is_taken: bool
    alike: tuple[str, ...]
    origin: str
    claim: str
    sentence: str
    leaves: str = ""
    slip: str = ""
    parameter: ParameterKind | None = None

    @property
    def is_of_log(self) -> bool:
        """Whether it is about how the log tells what the robot does, not about the robot."""
        is_reading = self.kind in OF_READINGS and self.parameter is not ParameterKind.RATE_GAIN
        return is_reading or self.parameter in OF_SENSORS


@final
@dataclass(frozen=True, slots=True)
class DepartureAfter:
    """The departure of one variable at the declared horizon: as judged, and after the refit."""

    name: str
    unit: Unit
    tolerance: float
    noise: float
    before: float
    after: float
    interval: Interval
    standing: Standing
    origin: str


@final
@dataclass(frozen=True, slots=True)
class DifferingRegion:
    """A part of the region in which a variable still departs after the refit."""

    name: str
    unit: Unit
    region: RegionMean
    sentence: str


@final
@dataclass(frozen=True, slots=True)
class Diagnosis:
    """Why the robot departs: the sentences say it, the numbers stand behind them.

    refitted: all numbers that this trace can tell, fitted together. after: departures after that
    refit. candidates: best first, those that are named before all others; none where there is
    nothing to explain. differs: where the refitted spec still departs.
    """

    told: Told
    sentences: tuple[str, ...]
    refitted: tuple[Refitted, ...]
    after: tuple[DepartureAfter, ...]
    candidates: tuple[Candidate, ...]
    differs: tuple[DifferingRegion, ...]

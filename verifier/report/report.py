"""The report: what the verifier found, as data. SI throughout; a `Unit` says how people read it.

W is the number of judged windows. A value in the user's unit is `value / unit.scale`.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import Final, final

from runtime.arrays import Array, Integers
from runtime.program import Unit
from verifier.traces.trace import Loss


@final
class Verdict(StrEnum):
    """Whether the robot does what the spec says, as far as this trace can tell."""

    PASS = "pass"  # noqa: S105  # the word of the verdict
    FAIL = "fail"
    INCONCLUSIVE = "inconclusive"


WORST_FIRST: Final = (Verdict.FAIL, Verdict.INCONCLUSIVE, Verdict.PASS)


@final
class Standing(StrEnum):
    """Where a departure stands against its tolerance, at the report's confidence."""

    WITHIN = "within"
    EXCEEDED = "exceeded"
    UNDECIDED = "undecided"


@final
@dataclass(frozen=True, slots=True)
class Interval:
    """A confidence interval. An end that the data does not bound is infinite."""

    low: float
    high: float


@final
@dataclass(frozen=True, slots=True)
class Noise:
    """The measurement noise of one variable, estimated from the trace itself.

    sigma: its standard deviation. correlation: of successive values of the noise, as far as the
    samples show it (0 is white). quantum: the step of a quantised sensor, 0 where none is seen.
    method: how sigma was found, as a phrase.
    """

    sigma: float
    samples: int
    correlation: float
    quantum: float
    method: str


@final
@dataclass(frozen=True, slots=True)
class HorizonFigure:
    """How far measured and predicted are apart after `horizon` seconds.

    rmse: the plain root mean square over all windows. departure: the same with the contribution
    of the sensors' noise removed; `interval` holds the true one at the report's confidence, and
    `standing` is where that interval stands. noise: what the noise of the sensors contributes, at
    the horizon and by way of the start, which is not known better than they tell.
    """

    horizon: float
    windows: int
    rmse: float
    noise: float
    departure: float
    interval: Interval
    tolerance: float
    standing: Standing


@final
@dataclass(frozen=True, slots=True)
class RegionMean:
    """The mean of measured minus predicted at the horizon, over windows of one part.

    bounds: the part, `low, high` per name, SI; values: its value per discrete name. Both are empty
    where the mean is that of all windows. The mean speaks of
    windows in which the variable was predicted to move about as far as `moved`, or in which
    it would have moved by `hurried` farther had what drives it come a twentieth of the horizon
    earlier; None where all are alike. mean is
    signed: positive where the robot ends above the prediction.
    """

    bounds: dict[str, tuple[float, float]]
    values: dict[str, str]
    moved: float | None
    hurried: float | None
    windows: int
    mean: float
    interval: Interval
    standing: Standing


@final
@dataclass(frozen=True, eq=False, slots=True)
class WindowView:
    """One window for drawing: all (T,). times count from the trace's start.

    A periodic variable's values are continuous within a window, and predicted stays on the same
    turn as measured.
    """

    times: Array
    measured: Array
    predicted: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class VariableResult:
    """The judgement of one driven variable.

    period: of a periodic variable, else 0. horizons: ascending; the last one is declared and
    decides, the others are for information.
    systematic: at least so much of the error is shown to be no chance, but to come back wherever
    the robot is in the same situation. scatter: how far single windows lie from the mean of their
    part, the noise of the sensors taken out; `allowed_scatter` is what the spec allows beside the
    tolerance.
    mean: the signed mean error at the declared horizon over all windows.
    unjudged: windows in a discrete value that was seen too rarely to be judged on its own.
    moved: how far the variable itself moved over the declared horizon, root mean square.
    regions: the parts; worst: the one that departs most surely, if any.
    errors: (W,) measured minus predicted at the declared horizon, NaN where a window has none.
    views: a few windows, in order of time.
    """

    name: str
    unit: Unit
    period: float
    tolerance: float
    standing: Standing
    noise: Noise
    horizons: tuple[HorizonFigure, ...]
    systematic: float
    scatter: float
    allowed_scatter: float
    unjudged: int
    moved: float
    mean: float
    mean_interval: Interval
    regions: tuple[RegionMean, ...]
    worst: RegionMean | None
    errors: Array
    views: tuple[WindowView, ...]
    origin: str

    @property
    def declared(self) -> HorizonFigure:
        """The figure at the declared horizon."""
        return self.horizons[-1]

    @property
    def hardly_moves(self) -> bool:
        """Whether a spec in which it stays where it is would do as well: weak evidence."""
        return self.moved <= self.tolerance


@final
@dataclass(frozen=True, slots=True)
class CellAxis:
    """One axis of the coverage: `count` equal cells over [low, high].

    values: of a discrete variable, the names of its cells; else empty.
    """

    name: str
    unit: Unit
    low: float
    high: float
    count: int
    values: tuple[str, ...] = ()


@final
@dataclass(frozen=True, eq=False, slots=True)
class Coverage:
    """How much of the declared region the judged windows went through.

    samples: (count of axis 1, ..., count of axis d) effective samples per cell. A cell is seen
    with at least `enough` of them; `share` of all cells is seen, `required` was declared.
    """

    axes: tuple[CellAxis, ...]
    samples: Integers
    enough: int
    share: float
    required: float

    @property
    def is_reached(self) -> bool:
        """Whether enough of the region was seen for a PASS."""
        return self.share >= self.required


@final
@dataclass(frozen=True, slots=True)
class Exclusion:
    """Time of the trace that was not judged: its cause, seconds, and samples of the time base."""

    cause: str
    seconds: float
    samples: int


@final
@dataclass(frozen=True, slots=True)
class SpecIdentity:
    """Which spec was verified."""

    name: str
    file: str
    sha256: str


@final
@dataclass(frozen=True, slots=True)
class TraceIdentity:
    """Which trace was read; `judged` are the seconds inside judged windows.

    content: tells two traces with the same decisions apart from two that differ, whatever they
    are called; empty where it is not told.
    """

    source: str
    start: float
    duration: float
    judged: float
    content: str = ""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Report:
    """What `verify` found.

    reasons: sentences, the deciding one first. advice: what to do next, sentences.
    starts: (W,) when each window starts, seconds from the trace's start.
    places: (W,) per name where each window ran: the start of a state (a periodic one within its
    domain), the mean of an input.
    units: of every name in `places` and of every axis.
    """

    verdict: Verdict
    reasons: tuple[str, ...]
    advice: tuple[str, ...]
    horizon: float
    confidence: float
    variables: tuple[VariableResult, ...]
    coverage: Coverage | None
    exclusions: tuple[Exclusion, ...]
    losses: tuple[Loss, ...]
    notes: tuple[str, ...]
    spec: SpecIdentity
    trace: TraceIdentity
    starts: Array
    places: dict[str, Array]
    units: dict[str, Unit]

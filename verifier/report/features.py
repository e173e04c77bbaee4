"""The robot's topology beside the spec's: attractors, saddles, cycles. SI throughout.

m: axes. A feature of the spec is looked for in two ways: *seen* directly in the trace (where it
comes to rest, how long its laps take), and in the spec's field *refitted* to the trace.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import final

from runtime.arrays import Array
from runtime.program import Unit
from verifier.report.report import Interval


@final
class FeatureStanding(StrEnum):
    """Where a feature of the robot stands against the spec's, at the confidence of `Features`.

    Not visited: the trace tells nothing of it. Undecided: too little.
    """

    WITHIN = "within"
    EXCEEDED = "exceeded"
    UNDECIDED = "undecided"
    NOT_VISITED = "not visited"


@final
@dataclass(frozen=True, slots=True)
class Estimate:
    """A number of the robot with its confidence interval."""

    value: float
    interval: Interval


@final
@dataclass(frozen=True, slots=True)
class FeatureNumber:
    """One number of a feature: a coordinate of its place, a period, an amplitude.

    name: `x`, `period`, `amplitude of x`, `lowest x`, `highest x`. spec: what the spec has; NaN
    where the spec has no such feature.
    seen: from the trace itself; refitted: from the refitted field. None where it does not tell.
    tolerance: how far the robot may be off; infinite where nothing declares it, and `allowed_by`
    says in a phrase what does. standing: of `robot`.
    """

    name: str
    unit: Unit
    spec: float
    seen: Estimate | None
    refitted: Estimate | None
    tolerance: float
    allowed_by: str
    standing: FeatureStanding

    @property
    def robot(self) -> Estimate | None:
        """What counts: what was seen, else what the refitted field has."""
        return self.seen or self.refitted


@final
@dataclass(frozen=True, eq=False, slots=True)
class ComparedFeature:
    """A feature of the spec, and where the robot has it; or one that only the robot has.

    kind: `stable node`, `saddle`, `stable cycle`. name: in words, with its place or period.
    claim: the sentence that declares it, empty for one that follows from the field; origin: the
    `file:line:column` of that claim, or of the field. in_spec: False where only the robot has it.
    visits: how often the robot came to rest there, or how many laps it made; near a saddle: how
    many windows went past.
    spec_path, robot_path (T, m): one point, or a closed loop; empty (0, m) where there is none.
    """

    kind: str
    name: str
    claim: str
    origin: str
    in_spec: bool
    is_cycle: bool
    numbers: tuple[FeatureNumber, ...]
    standing: FeatureStanding
    visits: int
    spec_path: Array
    robot_path: Array
    sentence: str

    @property
    def is_declared(self) -> bool:
        """Whether the spec's author claims it in words."""
        return self.claim != ""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Features:
    """The section of the report.

    axes: the names of the m axes, with their units. settings: the controls and held states at
    which the spec's features were computed: those that held longest in the trace, SI.
    features: declared ones first. notes: sentences on what could not be compared and why.
    confidence: at which all intervals together hold the truth.
    """

    axes: tuple[str, ...]
    units: tuple[Unit, ...]
    settings: tuple[tuple[str, float], ...]
    features: tuple[ComparedFeature, ...]
    notes: tuple[str, ...]
    confidence: float

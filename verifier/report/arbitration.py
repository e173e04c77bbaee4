"""How a robot's own arbiter decides beside the spec's, as data. SI throughout.

A decision is one sample of the choice in the log. k is the number of choices.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import final

from runtime.arrays import Integers
from runtime.program import Unit
from verifier.report.report import Interval, Standing


@final
@dataclass(frozen=True, slots=True)
class Share:
    """A share of decisions that agree.

    effective: how many independent decisions would tell as much; `interval` holds the true share
    at the report's confidence.
    """

    agreeing: int
    decisions: int
    effective: float
    interval: Interval

    @property
    def value(self) -> float:
        """Of the decisions in the log."""
        return self.agreeing / self.decisions if self.decisions else 0.0


@final
@dataclass(frozen=True, slots=True)
class Region:
    """A part of the input space: what holds in it, as phrases, and how far decisions agree."""

    conditions: tuple[str, ...]
    share: Share
    standing: Standing


@final
class ThresholdStanding(StrEnum):
    """What a log says of a threshold."""

    KEPT = "as in the spec"
    MOVED = "elsewhere"
    UNTOLD = "cannot be told"


@final
@dataclass(frozen=True, slots=True)
class Threshold:
    """A number that what is read is compared with.

    name: of a constant or control, or the comparison as written. value: the spec's. fitted: with
    which the robot's decisions agree most, `interval` the values that agree no worse at the
    report's confidence; an end that nothing was read beyond is infinite. agreeing: decisions that
    agree with `fitted`, all other thresholds as they were then.
    """

    name: str
    comparison: str
    unit: Unit
    value: float
    fitted: float
    interval: Interval
    agreeing: int
    standing: ThresholdStanding
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Explanation:
    """A change of the spec that explains decisions that differ: `label` says which.

    agreeing: decisions that agree with it.
    """

    label: str
    agreeing: int


@final
@dataclass(frozen=True, slots=True)
class Stray:
    """Decisions one after the other that nothing explains: seconds from the start, and choices."""

    start: float
    end: float
    decisions: int
    robot: str
    spec: str


@final
@dataclass(frozen=True, eq=False, slots=True)
class Arbitration:
    """What the decisions in a log say of an arbiter.

    changes: how often the robot's choice is another than just before, among what is judged.
    confusion: (k, k) decisions by the robot's choice (row) and the spec's (column). cells: of the
    thresholds' own partition of what is read. boxes: of a k-d grid over it. delay: samples by which
    the robot decides later than the spec (earlier: below 0), as far as that explains decisions.
    strays: what is left unexplained.
    """

    choices: tuple[str, ...]
    share: Share
    changes: int
    required: float
    confusion: Integers
    cells: tuple[Region, ...]
    boxes: tuple[Region, ...]
    thresholds: tuple[Threshold, ...]
    delay: int
    period: float
    explanations: tuple[Explanation, ...]
    strays: tuple[Stray, ...]
    unexplained: int
    sentences: tuple[str, ...]
    origin: str

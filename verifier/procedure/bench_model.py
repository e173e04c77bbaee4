"""The test procedure of an arbiter: readings to show it, and what it is to choose. All SI."""

from dataclasses import dataclass
from typing import final

from runtime.program import Unit
from verifier.report.report import Verdict


@final
@dataclass(frozen=True, slots=True)
class Shown:
    """Readings that are shown for a while, and what the spec chooses in the end."""

    values: dict[str, float]
    chosen: str


@final
@dataclass(frozen=True, slots=True)
class Reading:
    """A quantity that is shown: values of a discrete one, else empty."""

    name: str
    unit: Unit
    values: tuple[str, ...]


@final
@dataclass(frozen=True, slots=True)
class Biased:
    """An arbiter that reads one quantity by `bias` too high, and what the verifier says of it."""

    reading: str
    bias: float
    verdict: Verdict


@final
@dataclass(frozen=True, slots=True)
class Lacking:
    """An arbiter that lacks the rule of this number, from 1, and what the verifier says of it."""

    rule: int
    verdict: Verdict


@final
@dataclass(frozen=True, slots=True)
class BenchTest:
    """What to show an arbiter, one after the other, each for `seconds`; all that `repeats` times.

    period: of its decisions. required: the share of decisions that must agree. never: choices that
    no reading that was tried leads to. verdict: of the verifier on the spec itself, rehearsed, for
    `reasons`; biased, lacking: on others. idle: numbers of rules without which all that is
    shown makes it choose the same.
    """

    name: str
    period: float
    seconds: float
    readings: tuple[Reading, ...]
    shown: tuple[Shown, ...]
    repeats: int
    required: float
    never: tuple[str, ...]
    verdict: Verdict
    reasons: tuple[str, ...]
    biased: tuple[Biased, ...]
    lacking: tuple[Lacking, ...]
    idle: tuple[int, ...]

    @property
    def duration(self) -> float:
        """Seconds that all of it takes."""
        return self.seconds * len(self.shown) * self.repeats

    @property
    def decides(self) -> bool:
        """Whether the spec itself passes, and each that reads wrongly or lacks a rule fails."""
        others = {*(each.verdict for each in self.biased), *(each.verdict for each in self.lacking)}
        return self.verdict is Verdict.PASS and others <= {Verdict.FAIL}

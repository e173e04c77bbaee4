"""What a run says of its requirements, as data. SI throughout; `unit` says how people read it."""

from dataclasses import dataclass
from enum import StrEnum
from typing import final

from runtime.program import Unit


@final
class Outcome(StrEnum):
    """Whether a run satisfies a requirement; open where it ends too soon, or was not measured."""

    SATISFIED = "satisfied"
    VIOLATED = "violated"
    OPEN = "open"


@final
@dataclass(frozen=True, slots=True)
class Witness:
    """The instant that decides, seconds from the run's start, and the quantities' values there."""

    time: float
    values: dict[str, float]


@final
@dataclass(frozen=True, slots=True)
class RequirementResult:
    """One requirement on one run.

    low, high: the robustness is between them; equal where everything that counts was seen,
    infinite where nothing bounds it. Above 0 satisfies; 0 is at the bound, and `outcome` says on
    which side. unit: of the robustness, empty where its predicates have several. witness: None
    where what was not seen decides.
    """

    text: str
    outcome: Outcome
    low: float
    high: float
    unit: Unit
    witness: Witness | None
    sentence: str
    origin: str

    @property
    def detail(self) -> str:
        """The sentence without the outcome, for where that stands beside it."""
        return self.sentence.removeprefix(str(self.outcome)).lstrip(":, ")

    @property
    def robustness(self) -> float:
        """The bound that decides: by how much it surely holds, or surely does not."""
        return self.high if self.outcome is Outcome.VIOLATED else self.low

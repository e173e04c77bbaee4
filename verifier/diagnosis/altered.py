"""What a fit may change: numbers of the register, courses of inputs, how a state was measured."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeAlias, final

from runtime.program import Unit
from verifier.diagnosis.courses import Course
from verifier.mixed_units import Slip
from verifier.report.diagnosis import CandidateKind, ParameterKind


@final
@dataclass(frozen=True, slots=True)
class Seen:
    """How a driven state was measured: the log holds `scale * x(t - delay) + offset`."""

    scale: float = 1.0
    offset: float = 0.0
    delay: float = 0.0


@final
@dataclass(frozen=True, eq=False, slots=True)
class Altered:
    """One setting: register entries by name, courses of inputs, and how states were measured."""

    register: dict[str, float]
    courses: dict[str, Course]
    seen: dict[str, Seen]

    def moved(self, name: str, value: float) -> "Altered":
        """With one entry of the register at another value."""
        return replace(self, register={**self.register, name: value})

    def with_course(self, name: str, course: Course) -> "Altered":
        """With another course of one input."""
        return replace(self, courses={**self.courses, name: course})

    def with_seen(self, name: str, seen: Seen) -> "Altered":
        """With one state measured otherwise."""
        return replace(self, seen={**self.seen, name: seen})


Values: TypeAlias = tuple[float, ...]


@final
@dataclass(frozen=True, slots=True)
class Number:
    """A number that is fitted: `neutral` where it changes nothing, `step` for differences."""

    name: str
    unit: Unit
    neutral: float
    step: float
    low: float
    high: float


@final
@dataclass(frozen=True, eq=False, slots=True)
class Effect:
    """Something that may be otherwise than the spec or the log says, with the numbers it takes.

    label: as in `dead time of turn`. subject: what is late, bounded or off, in words; empty where
    `applies_to` says it. detail: of a further term, the term; of a region, on which side of its
    border it lies; of a bound, how far a state goes. is_delay: a number of seconds that may be
    negative, by which it is named a dead time, a late log or an early one. starts: where a fit
    begins, the neutral values if empty.
    parameter: set where it is one of the scalars that are refitted. stands_in: it
    puts measured states in place of predicted ones, so that it is compared with itself at its
    neutral values. best_of: so many like it were looked at before, which costs their logarithm.
    slips: units that a gain may stand for.
    """

    kind: CandidateKind
    applies_to: tuple[str, ...]
    label: str
    numbers: tuple[Number, ...]
    apply: Callable[[Altered, Values], Altered]
    origin: str
    starts: tuple[Values, ...] = ()
    parameter: ParameterKind | None = None
    stands_in: bool = False
    best_of: int = 1
    slips: tuple[Slip, ...] = ()
    subject: str = ""
    detail: str = ""
    is_delay: bool = False

    @property
    def neutral(self) -> Values:
        """The values that change nothing."""
        return tuple(number.neutral for number in self.numbers)

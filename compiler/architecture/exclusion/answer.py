"""The answer: a proof, a state in which both act, or what is left open; each in a sentence."""

from dataclasses import dataclass
from typing import TypeAlias, final

from runtime.program import Unit
from spec_schema.wording import listed, number


@final
@dataclass(frozen=True, slots=True)
class Proof:
    """They never act at once. reason: why, in a sentence. boxes: how many were looked at."""

    reason: str
    boxes: int = 0


@final
@dataclass(frozen=True, slots=True)
class Reading:
    """A named quantity with a value in SI; label: of a discrete one, the name of its value."""

    name: str
    value: float
    unit: Unit
    label: str = ""

    @property
    def text(self) -> str:
        """As its user writes it: `clearance is 0.29 m`."""
        if self.label:
            return f"{self.name} is {self.label}"
        unit = "" if self.unit.text == "1" else f" {self.unit.text}"
        return f"{self.name} is {number(self.value / self.unit.scale)}{unit}"


@final
@dataclass(frozen=True, slots=True)
class Sample:
    """What was sampled at an instant; effects: `avoid acts until 0.15 s`, of what was decided."""

    time: float
    readings: tuple[Reading, ...]
    effects: tuple[str, ...]

    @property
    def text(self) -> str:
        """`at 0 s clearance is 0.29 m (avoid acts until 0.15 s)`."""
        said = [reading.text for reading in self.readings]
        what = f" {listed(said, last='and')}" if said else ""
        return f"at {number(self.time)} s{what} ({listed(self.effects, last='and')})"


@final
@dataclass(frozen=True, slots=True)
class Moment:
    """From `time` on signals have these values, by name: what a replay feeds."""

    time: float
    signals: tuple[tuple[str, float], ...]


@final
@dataclass(frozen=True, slots=True)
class Witness:
    """Both act at `at` (seconds).

    samples: why. assumed: what a node keeps or tells by itself and is taken to be: it is not shown
    that it ever is. inputs: a run that ends there. help: what mends it.
    """

    first: str
    second: str
    at: float
    samples: tuple[Sample, ...]
    assumed: tuple[str, ...]
    inputs: tuple[Moment, ...]
    help: str

    @property
    def text(self) -> str:
        """The state in a sentence."""
        why = ", ".join(sample.text for sample in self.samples)
        given = f", if {listed(self.assumed, last='and')}" if self.assumed else ""
        head = f"{self.first} and {self.second} both act at {number(self.at)} s"
        return f"{head}: {why}{given}" if why else f"{head}{given}"


@final
@dataclass(frozen=True, slots=True)
class Undecided:
    """Neither shown. reason: what is open; help: what would settle it."""

    reason: str
    help: str


Answer: TypeAlias = Proof | Witness | Undecided

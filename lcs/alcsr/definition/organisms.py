"""Natural problem topography (4.3.1): landscapes, who lives on them, and what they cover."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol, final

from lcs.alcsr.config import Config
from lcs.alcsr.readings import RangeIs


class Chance(Protocol):
    """Where random numbers come from."""

    def random(self) -> float:
        """The next one, uniform in [0, 1)."""
        ...


@final
@dataclass(eq=False, slots=True)
class Organism:
    """A rule: its body is [lower, upper) in each dimension; what it predicts is its food-type.

    right, wrong: how often it was. strength_center, weakness_center: where on average.
    was_able: whether it could breed before it was fed last.
    """

    lower: list[float]
    upper: list[float]
    prediction: float
    strength: float = 0.0
    experience: int = 0
    volume: float = 0.0
    right: int = 0
    wrong: int = 0
    strength_center: list[float] = field(default_factory=list)
    weakness_center: list[float] = field(default_factory=list)
    damaged: bool = False
    was_able: bool = False


@final
@dataclass(eq=False, slots=True)
class Corpse:
    """Of a rule that died of a wrong prediction: its centre, and its cover fractions."""

    center: list[float]
    prediction: float
    lower_fraction: list[float]
    upper_fraction: list[float]


@final
@dataclass(eq=False, slots=True)
class Landscape:
    """Of one action: who lives there, and who died there of the wrong food."""

    organisms: list[Organism] = field(default_factory=list)
    mausoleum: list[Corpse] = field(default_factory=list)


@final
@dataclass(eq=False, slots=True)
class World:
    """All landscapes, and the range of inputs: experienced so far, or declared."""

    config: Config
    landscapes: list[Landscape]
    low: list[float]
    high: list[float]
    reward_range: float

    @property
    def width(self) -> list[float]:
        """The range of each input."""
        return [high - low for low, high in zip(self.low, self.high, strict=True)]


def experience(world: World, x: list[float]) -> None:
    """Widen the known range by `x`; volumes are fractions of it (4.3.1)."""
    if world.config.readings.range_is is RangeIs.DECLARED:
        return
    grown = False
    for i, value in enumerate(x):
        if value < world.low[i]:
            world.low[i], grown = value, True
        if value > world.high[i]:
            world.high[i], grown = value, True
    if grown:
        for land in world.landscapes:
            for organism in land.organisms:
                organism.volume = volume_of(world, organism)


def covers(world: World, organism: Organism, x: list[float]) -> bool:
    """Whether `x` lies in its body: half open, but closed where the known range ends."""
    bounds = zip(organism.lower, x, organism.upper, world.high, strict=True)
    return all(low <= at and (at < up or at == up == end) for low, at, up, end in bounds)


def volume_of(world: World, organism: Organism) -> float:
    """Its volume, of the known range's (4.3.1)."""
    volume = 1.0
    for low, up, width in zip(organism.lower, organism.upper, world.width, strict=True):
        if width > 0.0:
            volume *= (up - low) / width
    return volume


def is_mature(world: World, organism: Organism) -> bool:
    """Table 4.3."""
    return organism.experience > world.config.mature_level * organism.volume


def can_breed(world: World, organism: Organism) -> bool:
    """Table 4.3."""
    return organism.strength >= world.config.breed_level * organism.volume


def center_of(organism: Organism) -> list[float]:
    """The middle of its body."""
    return [0.5 * (low + up) for low, up in zip(organism.lower, organism.upper, strict=True)]


def squared_distance(one: Sequence[float], other: Sequence[float]) -> float:
    """Of two points."""
    total = 0.0
    for a, b in zip(one, other, strict=True):
        total += (a - b) * (a - b)
    return total


def newborn(lower: list[float], upper: list[float], prediction: float) -> Organism:
    """An organism that has not been fed; its volume is not known yet."""
    zeros = [0.0] * len(lower)
    return Organism(
        lower, upper, prediction, strength_center=list(zeros), weakness_center=list(zeros)
    )


def pick(rng: Chance, count: int) -> int:
    """One of so many, at random."""
    return int(rng.random() * count)

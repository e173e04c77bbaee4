"""What a program claims of the topology of its field; numbers are in SI, as everywhere in it."""

from dataclasses import dataclass
from typing import final

from runtime.code import Code


@final
@dataclass(frozen=True, slots=True)
class Place:
    """Where a feature is claimed to be, for one state: within `within` (SI) of `at`."""

    state: str
    at: Code
    within: float


@final
@dataclass(frozen=True, slots=True)
class Reach:
    """How far a cycle is claimed to swing in one state: from `low` to `high`, to `within` (SI)."""

    state: str
    low: Code
    high: Code
    within: float


@final
@dataclass(frozen=True, slots=True)
class Span:
    """The values of a control over which a claim is made; SI."""

    control: str
    low: float
    high: float


@final
@dataclass(frozen=True, slots=True)
class Claim:
    """A claim about the topology of the field: how many features of a type there are, and where.

    text: the sentence as its author wrote it, with its conditions but `over`.
    feature: a type or group of features: `saddle`, `attractor`, `stable cycle`...
    least, most: how many; `most` is None for no limit.
    other: only what no claim above it has named is counted.
    places, reaches, period: what each feature counted must satisfy; codes over controls and
    constants. period_within: the share of the period that it may be off.
    share: not None for a claim on basins: at least so much of the domain goes to the features
    that the claim named `goes_to` counts (empty: those of the last claim above that counts).
    called: a name for what it counts, which later claims refer to.
    over: controls that take all values of an interval; settings: controls at values (SI); what
    neither names has its default. sketched: it follows from a sketch, nobody wrote it.
    """

    text: str
    feature: str
    least: int
    most: int | None
    other: bool
    places: tuple[Place, ...]
    reaches: tuple[Reach, ...]
    period: Code | None
    period_within: float
    share: float | None
    goes_to: str
    called: str
    over: tuple[Span, ...]
    settings: tuple[tuple[str, float], ...]
    sketched: bool
    origin: str

"""The question of exclusion as plain data: two nodes, what decides when they act, and its inputs.

Everything is in SI. A *decider* is an arbiter, or the condition of one node; at its ticks it
decides which of its *outcomes* (an arbiter's choices; a condition has one) hold, and what it
decided is in effect from one response time later, until its next decision is.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias, final

from runtime.arbiter import Rule
from runtime.code import Code
from runtime.program import Unit


@final
@dataclass(frozen=True, slots=True)
class Signal:
    """A number on the board. values: the names of a discrete one.

    every, delay: it changes only at multiples of `every` (of a sensor its rate, of a node's output
    its period), `delay` later on the board; `every` 0 for a signal that may change at any instant.
    told: whether it is what a node tells, and so not any number of its domain at any time.
    """

    name: str
    unit: Unit
    low: float
    high: float
    values: tuple[str, ...]
    every: float
    delay: float
    told: bool = False


@final
class Limit(StrEnum):
    """What the domain of an entry does to a reading outside of it."""

    CLIPS = "clips"
    INHIBITS = "inhibits"
    WRAPS = "wraps"
    """It is turned into the domain, as angles are."""


@final
@dataclass(frozen=True, slots=True)
class Entry:
    """What a name in a decider's code is at its ticks.

    signal: scale times this signal of the question, limited to low..high. Where it is -1, one of
    `values`; and where these are none, anything from low to high (a node's own state), or one of
    `labels` where it is discrete. sets: what choices may set it to, in the place of the signal.
    """

    name: str
    unit: Unit
    low: float
    high: float
    signal: int = -1
    scale: float = 1.0
    limit: Limit = Limit.CLIPS
    values: tuple[float, ...] = ()
    labels: tuple[str, ...] = ()
    sets: tuple[float, ...] = ()


@final
class How(StrEnum):
    """How a decider comes to its outcomes."""

    FIRST = "first"
    """Of rules, the first that holds: one outcome."""
    ALL = "all"
    """Of rules, all that hold."""
    NUMBERS = "numbers"
    """An outcome holds where its code is above 0."""
    CONDITION = "condition"
    """An outcome holds where its code is not 0."""
    ONE = "one"
    """One outcome; which one is its own affair (a plan's mode)."""
    ANY = "any"
    """Any outcomes: a module, a learner, competing activations."""


@final
@dataclass(frozen=True, slots=True)
class Decider:
    """An arbiter, or the condition of a node. name: of the node; what: how messages call it.

    rules: of FIRST and ALL; their `choice` is an outcome. codes: one per outcome, of NUMBERS and
    CONDITION. outcomes: their names.
    """

    name: str
    what: str
    how: How
    period: float
    response_time: float
    entries: tuple[Entry, ...]
    outcomes: tuple[str, ...]
    rules: tuple[Rule, ...] = ()
    codes: tuple[Code, ...] = ()


Outcome: TypeAlias = tuple[int, int]
"""A decider and one of its outcomes, both by place."""


@final
@dataclass(frozen=True, slots=True)
class Actor:
    """A node that may act: where of each of its `needs` at least one outcome holds.

    doubt: why it may not act even there; empty where it surely does. Of a combined behavior: where
    `first` and `second` would both act.
    """

    name: str
    needs: tuple[tuple[Outcome, ...], ...]
    doubt: str = ""


@final
@dataclass(frozen=True, slots=True)
class Question:
    """Can `first` and `second` act at one instant?

    unless: combined behaviors that act in the place of one of them, where they would act.
    """

    signals: tuple[Signal, ...]
    deciders: tuple[Decider, ...]
    first: Actor
    second: Actor
    unless: tuple[Actor, ...] = ()

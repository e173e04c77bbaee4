"""The architecture: behaviors and control modules wired together, as the compiler emits it.

Everything that one node tells another, and everything that a sensor says, is a *signal*: a number
in SI with a place in one table, the board. A node reads signals at its ticks and nothing else, so
that a behavior can't look into the world (thesis, section 2.4, principle 1h).
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import final

from runtime.arbiter import Arbiter
from runtime.code import Code
from runtime.program import Kind, Origin, Program, Unit


@final
class Outside(StrEnum):
    """What becomes of a reading that is outside the domain of what it is wired to."""

    CLIP = "clip"
    INHIBIT = "inhibit"


@final
@dataclass(frozen=True, slots=True)
class Signal:
    """A number on the board: `sensor.value`, `node.output`, or `arbiter.choice`."""

    name: str
    unit: Unit
    low: float
    high: float
    kind: Kind
    values: tuple[str, ...]
    origin: str

    @property
    def unsaid(self) -> float:
        """What is read of it before it was said: 0, or the edge of its domain that is nearest.

        A choice (or what else has labels) is none of its values then, where it may be none: -1.
        """
        return self.low if self.values else min(max(0.0, self.low), self.high)


@final
@dataclass(frozen=True, slots=True)
class Input:
    """What one register entry of a node is at its ticks: a signal, or a value (SI).

    signal: its place on the board, or -1 for a value. scale: the entry is scale * signal.
    A clip takes it to the entry's domain.
    """

    entry: str
    signal: int
    value: float
    scale: float
    outside: Outside
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Command:
    """How a behavior acts on a channel: `sign` times an entry, taken as `mode`.

    entry: a driven state (mode `rate`: its rate; `set-point`: its value one period on;
    `acceleration`: its rate, as the rate of the channel), or an output or control (`set-point`).
    """

    channel: int
    mode: str
    entry: str
    sign: float
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Setting:
    """A control (or read) of a node that a choice sets, in SI, while it holds."""

    node: int
    entry: str
    value: float
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Choice:
    """What a choice of an arbiter means: the nodes that act, and what is set."""

    name: str
    acts: tuple[int, ...]
    sets: tuple[Setting, ...]
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Node:
    """A behavior or a control module that runs in parallel with all others.

    At every multiple of `period` it samples its inputs; what it says and does takes effect
    `response_time` later, and holds until the next takes effect (all seconds).
    level: 0 for a base behavior; else one above the highest node that it controls.
    behavior, arbiter: the index of its program or arbiter, one of them -1; a node of user code has
    both -1 and `module` set. controls: the controls that nobody sets are entries of `inputs` too,
    with their default. outputs: places on the board that it writes, in the order of its outputs;
    an arbiter's choices stand behind them (one signal per choice, 0 or more), then `choice`.
    commands: of a behavior. acts_when: over its own register, None for always: it acts only where
    this is not zero at its tick. choices: of an arbiter. replaces: nodes in whose place it acts
    where they would all act at once (thesis, section 3.2.2).
    """

    name: str
    period: float
    response_time: float
    level: int
    inputs: tuple[Input, ...]
    outputs: tuple[int, ...]
    behavior: int
    arbiter: int
    module: str
    commands: tuple[Command, ...]
    acts_when: Code | None
    choices: tuple[Choice, ...]
    replaces: tuple[int, ...]
    origin: str


@final
class Way(StrEnum):
    """How a channel is resolved that several behaviors reach (thesis, section 3.2.2)."""

    SINGLE = "single"
    EXCLUSIVE = "exclusive"
    SUM = "sum"
    BLEND = "blend"
    PRIORITY = "priority"
    FUNCTION = "function"


@final
@dataclass(frozen=True, slots=True)
class Resolution:
    """What a channel gets from the nodes that act on it.

    nodes: those that reach it; for PRIORITY the highest first. arbiter: the node whose choices
    weigh a BLEND or keep an EXCLUSIVE, or -1. function: of FUNCTION, `package.module:function`.
    proof: of EXCLUSIVE, in a sentence, why no two of them ever act at once.
    """

    way: Way
    nodes: tuple[int, ...]
    arbiter: int
    function: str
    proof: str
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Channel:
    """A channel of the body: what can be commanded. rest: `stop`, `hold` or `coast`."""

    name: str
    unit: Unit
    low: float
    high: float
    rest: str
    resolution: Resolution
    origin: str


@final
@dataclass(frozen=True, eq=False, slots=True)
class Architecture:
    """Compiled behaviors and arbiters, wired to one another and to a body.

    board: signals; the first ones are the body's sensor values, in the order of its sensors.
    programs, arbiters: what nodes run; two nodes may run the same one.
    order: nodes so that one with response time 0 stands before those that read it.
    """

    name: str
    about: str
    body: str
    board: tuple[Signal, ...]
    nodes: tuple[Node, ...]
    channels: tuple[Channel, ...]
    programs: tuple[Program, ...]
    arbiters: tuple[Arbiter, ...]
    order: tuple[int, ...]
    source: Origin

    def spec_of(self, node: Node) -> Program | Arbiter | None:
        """What a node runs; None of code."""
        if node.behavior >= 0:
            return self.programs[node.behavior]
        return self.arbiters[node.arbiter] if node.arbiter >= 0 else None

"""What a run tells whoever records it, watches it, or tests it.

Every array is the scheduler's own: it is read during the call, and copied by who wants to keep it.
Robots, nodes, sensors and channels are numbers, in the order of their tuples.
"""

from enum import StrEnum
from typing import NamedTuple, Protocol, final

from runtime.arrays import Array, Booleans
from runtime.scheduler.environment import Delivery


@final
class Tick(NamedTuple):
    """A node sampled the board; what it says takes effect its response time later.

    register: all entries as sampled: of a behavior states, controls, constants; of an arbiter or
    module its inputs in their order. outputs: (q,) in the order of `Node.outputs`: of an arbiter
    its outputs, then the number of each choice, then the choice. commands: (c,) of a behavior.
    allowed: nothing outside it kept it from acting at its sample. acts: nor did anything of
    its own (`acts_when`, a reading outside): it had its way, and its own states went on.
    """

    robot: int
    node: int
    register: Array
    outputs: Array
    commands: Array
    allowed: bool
    acts: bool


@final
class What(StrEnum):
    """What may happen that a record should not keep silent about."""

    CONFLICT = "conflict"  # two nodes act on an exclusive channel
    OUTSIDE = "outside"  # a reading is outside its domain, and inhibits its node
    BROKEN = "broken"  # a field has no finite value where its behavior is
    CHATTERING = "chattering"  # modes switch without end
    AT_THE_EDGE = "at the edge"  # an own state would leave its domain, and is kept at its edge
    LIMITED = "limited"  # a channel is commanded beyond its domain


@final
class Event(NamedTuple):
    """Something began to happen; it is told again only after it has ended.

    node: who, or -1; channel: where, or -1.
    """

    robot: int
    what: What
    node: int
    channel: int


@final
class Resolved(NamedTuple):
    """Who has their way on a channel.

    weights: for each node of the robot how much what it wants counts. Of a blend they add up to 1;
    else 1 for each that has its way. All 0 where nobody drives the channel.
    is_limited: what was wanted is beyond the channel's domain. is_in_conflict: two nodes act that
    never should at once.
    """

    weights: tuple[float, ...]
    is_limited: bool
    is_in_conflict: bool


class Observer(Protocol):
    """Gets what happens, in the order in which it happens."""

    def sensed(self, instant: int, delivery: Delivery) -> None:
        """Readings went on the board."""
        ...

    def ticked(self, instant: int, tick: Tick) -> None:
        """A node sampled the board."""
        ...

    def acting(self, instant: int, robot: int, acts: Booleans, weights: Array) -> None:
        """Who acts changed: (nodes,) who does, and how strongly choices in effect name each."""
        ...

    def commanded(self, instant: int, robot: int, channels: Array, driven: Booleans) -> None:
        """The channels (c,) were set anew; see `Environment.command`."""
        ...

    def resolved(self, instant: int, robot: int, channel: int, how: Resolved) -> None:
        """Another has its way on a channel, or with another weight."""
        ...

    def happened(self, instant: int, event: Event) -> None:
        """Something that should not pass in silence."""
        ...


class Silent:
    """An observer that keeps nothing; those that keep little are made from it."""

    def sensed(self, instant: int, delivery: Delivery) -> None:
        """Do nothing."""

    def ticked(self, instant: int, tick: Tick) -> None:
        """Do nothing."""

    def acting(self, instant: int, robot: int, acts: Booleans, weights: Array) -> None:
        """Do nothing."""

    def commanded(self, instant: int, robot: int, channels: Array, driven: Booleans) -> None:
        """Do nothing."""

    def resolved(self, instant: int, robot: int, channel: int, how: Resolved) -> None:
        """Do nothing."""

    def happened(self, instant: int, event: Event) -> None:
        """Do nothing."""

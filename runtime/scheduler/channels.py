"""Channels: what the nodes that act want of each, resolved to one set-point."""

import math
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple, final

from runtime.architecture import Architecture, Channel, Way
from runtime.arrays import Array
from runtime.scheduler.acting import Acting
from runtime.scheduler.observer import Resolved
from runtime.user_code import Callee, UserCodeError, call


@final
class _Member(NamedTuple):
    """A node that reaches the channel: the place of its command among its commands."""

    node: int
    name: str
    column: int


@final
class Resolver:
    """One channel: its set-point now, and how it comes to it.

    value: the set-point. is_driven: False where it rolls freely. rate: of change of the set-point
    per second, of channels that are accelerated; else 0. how: who has their way.
    """

    def __init__(
        self, architecture: Architecture, place: int, code: Callable[[str], Callee]
    ) -> None:
        self._channel: Channel = architecture.channels[place]
        resolution = self._channel.resolution
        self._members = _members(architecture, place)
        modes = {member.node: _mode(architecture, member) for member in self._members}
        self._accelerates = {node for node, mode in modes.items() if mode == "acceleration"}
        self._way, self._arbiter = resolution.way, resolution.arbiter
        if self._way in {Way.SUM, Way.BLEND, Way.FUNCTION} and 0 < len(self._accelerates) < len(
            modes
        ):
            raise ValueError(
                f"{self._channel.name}: set-points and accelerations cannot be put together"
            )
        self._text = resolution.function
        self._function = code(resolution.function) if self._way is Way.FUNCTION else None
        self.value = min(max(0.0, self._channel.low), self._channel.high)
        self.is_driven = self._channel.rest != "coast"
        self.rate = 0.0
        nobody = (0.0,) * len(architecture.nodes)
        self.how = self._resting = Resolved(nobody, is_limited=False, is_in_conflict=False)
        self._takes_first = self._way in {Way.SINGLE, Way.EXCLUSIVE, Way.PRIORITY}
        self._must_be_one = self._way in {Way.SINGLE, Way.EXCLUSIVE}
        self._alone = {member.node: _alone(member.node, nobody) for member in self._members}

    def resolve(self, acting: Acting, commands: Sequence[Array]) -> None:
        """Take what the nodes that act want, by the channel's own way.

        Raises:
            UserCodeError: the user's function did not give a number.
        """
        does = acting.does
        mine = [member for member in self._members if does[member.node]]
        self.rate = 0.0
        self.how = self._resting
        self.is_driven = bool(mine) or self._channel.rest != "coast"
        if not mine:
            if self._channel.rest == "stop":
                self.value = self._limited(0.0)
            return
        if self._takes_first:
            first = mine[0]
            wanted = float(commands[first.node][first.column])
            alone, disputed = self._alone[first.node]
            self.how = disputed if self._must_be_one and len(mine) > 1 else alone
        else:
            wants = [float(commands[member.node][member.column]) for member in mine]
            wanted, weights = self._put_together(mine, wants, acting)
            self._note(mine, weights)
        if mine[0].node in self._accelerates:
            self.rate = wanted
        else:
            self._set(wanted)

    def accelerate(self, step: float) -> None:
        """Let the set-point change by its rate for one step."""
        if self.rate != 0.0:
            self._set(self.value + self.rate * step)

    def _put_together(
        self, mine: Sequence[_Member], wants: Sequence[float], acting: Acting
    ) -> tuple[float, Sequence[float]]:
        """What they come to, and how much each of them counts."""
        match self._way:
            case Way.BLEND:
                by = acting.by.get(self._arbiter)
                weights = [by[member.node] if by else 1.0 for member in mine]
                total = math.fsum(weights)
                if total <= 0.0:  # none of them is named by this arbiter
                    weights, total = [1.0] * len(mine), float(len(mine))
                mean = math.fsum(w * x for w, x in zip(weights, wants, strict=True)) / total
                return mean, [weight / total for weight in weights]
            case Way.FUNCTION:
                names = [member.name for member in mine]
                called = self._called(dict(zip(names, wants, strict=True)))
                return called, (1.0,) * len(mine)
            case _:  # a sum; the others take the first
                return math.fsum(wants), (1.0,) * len(mine)

    def _note(self, mine: Sequence[_Member], weights: Sequence[float]) -> None:
        """Keep how much each counts."""
        counts = [*self._resting.weights]
        for member, weight in zip(mine, weights, strict=True):
            counts[member.node] = weight
        self.how = Resolved(tuple(counts), is_limited=False, is_in_conflict=False)

    def _called(self, wants: Mapping[str, float]) -> float:
        assert self._function is not None, "found at the beginning"
        answer = call(self._text, self._function, MappingProxyType(wants))
        if isinstance(answer, int | float) and math.isfinite(answer):
            return float(answer)
        raise UserCodeError(f"{self._text} gave {answer!r:.60}, which is no finite number")

    def _set(self, wanted: float) -> None:
        self.value = self._limited(wanted)
        is_limited = self.value != wanted
        if is_limited != self.how.is_limited:
            self.how = self.how._replace(is_limited=is_limited)

    def _limited(self, wanted: float) -> float:
        return min(max(wanted, self._channel.low), self._channel.high)


def _alone(node: int, nobody: tuple[float, ...]) -> tuple[Resolved, Resolved]:
    """How it is where one node has its way, without and with a conflict."""
    weights = (*nobody[:node], 1.0, *nobody[node + 1 :])
    return (
        Resolved(weights, is_limited=False, is_in_conflict=False),
        Resolved(weights, is_limited=False, is_in_conflict=True),
    )


def _members(architecture: Architecture, place: int) -> tuple[_Member, ...]:
    """The nodes that reach a channel, as its resolution orders them; combined ones come first."""
    ordered = architecture.channels[place].resolution.nodes
    members = [
        _Member(i, node.name, column)
        for i, node in enumerate(architecture.nodes)
        for column, command in enumerate(node.commands)
        if command.channel == place
    ]
    return tuple(
        sorted(
            members,
            key=lambda m: (ordered.index(m.node) if m.node in ordered else -1, m.node),
        )
    )


def _mode(architecture: Architecture, member: _Member) -> str:
    return architecture.nodes[member.node].commands[member.column].mode

"""How an architecture is wired, as it is drawn, printed and recorded: boxes, ports and nets."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Final, final

from runtime.arbiter import Read
from runtime.architecture import Architecture, Channel, Input, Node, Outside, Way
from runtime.program import Control, Kind, State
from runtime.world.model import Body
from specc.figures.quantities import number, quantity, seconds

ACTS: Final = "acts"
"""The port of a node by which a choice lets it act."""


@final
class Sort(StrEnum):
    """What a net carries."""

    READING = "reading"
    OUTPUT = "output"
    CHOICE = "choice"
    COMMAND = "command"


@final
@dataclass(frozen=True, slots=True)
class Port:
    """A place on a box where a wire may end: its name, and in small what it is set to or does."""

    name: str
    note: str = ""


@final
@dataclass(frozen=True, slots=True)
class Box:
    """A node. senses and tells stand below, controls (`acts` among them) and outputs above."""

    name: str
    level: int
    what: str
    clock: str
    senses: tuple[Port, ...]
    tells: tuple[Port, ...]
    controls: tuple[Port, ...]
    outputs: tuple[Port, ...]
    notes: tuple[str, ...]


@final
@dataclass(frozen=True, slots=True)
class Eye:
    """A sensor with those of its readings that nodes read: none where nobody does."""

    name: str
    what: str
    clock: str
    readings: tuple[str, ...]


@final
@dataclass(frozen=True, slots=True)
class Mouth:
    """A channel of the body: `claims` are its ports, in the order of its resolution."""

    name: str
    what: str
    rest: str
    claims: tuple[Port, ...]
    proof: str

    @property
    def is_contested(self) -> bool:
        """Whether several nodes reach it."""
        return len(self.claims) > 1


@final
@dataclass(frozen=True, slots=True)
class Net:
    """From one port to others; a port is (box, port name), on a box, a sensor or a channel."""

    sort: Sort
    source: tuple[str, str]
    targets: tuple[tuple[str, str], ...]


@final
@dataclass(frozen=True, slots=True)
class Wired:
    """A whole architecture."""

    name: str
    about: str
    body: str
    boxes: tuple[Box, ...]
    eyes: tuple[Eye, ...]
    mouths: tuple[Mouth, ...]
    nets: tuple[Net, ...]


def wired(architecture: Architecture, body: Body) -> Wired:
    """What is to be seen of an architecture."""
    nets = _nets(architecture)
    read = {net.source for net in nets if net.sort is Sort.READING}
    eyes = tuple(
        Eye(
            sensor.name,
            sensor.kind.value,
            _clock(sensor.every, sensor.latency, "late by"),
            tuple(r.name for r in sensor.readings if (sensor.name, r.name) in read),
        )
        for sensor in body.sensors
    )
    boxes = tuple(_box(architecture, node) for node in architecture.nodes)
    mouths = tuple(_mouth(architecture, channel) for channel in architecture.channels)
    return Wired(
        architecture.name, architecture.about, architecture.body, boxes, eyes, mouths, nets
    )


def _clock(period: float, delay: float, word: str) -> str:
    return f"every {_ms(period)}" + (f", {word} {_ms(delay)}" if delay else "")


def _ms(value: float) -> str:
    return f"{number(value * 1e3)} ms" if value < 1.0 else seconds(value)


def _what(architecture: Architecture, node: Node) -> str:
    if node.behavior >= 0:
        return f"behavior {architecture.programs[node.behavior].name}"
    if node.arbiter >= 0:
        arbiter = architecture.arbiters[node.arbiter]
        return f"{arbiter.way}{':' if arbiter.learner else ''} {arbiter.name}"
    return f"module {node.module}"


def _controls(architecture: Architecture, node: Node) -> tuple[str, ...]:
    """The names of what may be set: the node's control interface."""
    if node.behavior >= 0:
        return tuple(c.name for c in architecture.programs[node.behavior].controls)
    if node.arbiter >= 0:
        return tuple(c.name for c in architecture.arbiters[node.arbiter].controls)
    return ()


def _told(architecture: Architecture, node: Node) -> tuple[str, ...]:
    """The names of outputs; the choices of an arbiter, and `choice`, are not among them."""
    choices = {f"{node.name}.{choice.name}" for choice in node.choices}
    names = (architecture.board[place].name for place in node.outputs)
    kept = (n for n in names if n not in choices and not (node.choices and n.endswith(".choice")))
    return tuple(name.partition(".")[2] for name in kept)


def _box(architecture: Architecture, node: Node) -> Box:
    settable = _controls(architecture, node)
    governed = any(
        node.name == architecture.nodes[place].name
        for other in architecture.nodes
        for choice in other.choices
        for place in choice.acts
    )
    by_choice = _set_by_choices(architecture, node)
    controls = [
        Port(one.entry, by_choice.get(one.entry) or _note(architecture, node, one))
        for one in node.inputs
        if one.entry in settable
    ]
    notes = []
    if node.acts_when is not None:
        notes.append("acts where its own condition holds")
    if node.replaces:
        parts = " and ".join(architecture.nodes[place].name for place in node.replaces)
        notes.append(f"in place of {parts}")
    return Box(
        name=node.name,
        level=node.level,
        what=_what(architecture, node),
        clock=_clock(node.period, node.response_time, "responds in"),
        senses=tuple(
            Port(one.entry, _note(architecture, node, one))
            for one in node.inputs
            if one.entry not in settable
        ),
        tells=_tells(architecture, node),
        controls=((Port(ACTS),) if governed else ()) + tuple(controls),
        outputs=tuple(Port(name) for name in _told(architecture, node)),
        notes=tuple(notes),
    )


def _tells(architecture: Architecture, node: Node) -> tuple[Port, ...]:
    """What stands below at the right: choices, or commands by the name of the channel."""
    if node.choices:
        return tuple(Port(choice.name) for choice in node.choices)
    return tuple(
        Port(architecture.channels[c.channel].name, f"{'−' if c.sign < 0 else ''}{c.entry}")
        for c in node.commands
    )


def _set_by_choices(architecture: Architecture, node: Node) -> dict[str, str]:
    """For each control that choices set the values that it gets."""
    found: dict[str, list[str]] = {}
    for other in architecture.nodes:
        for choice in other.choices:
            for one in choice.sets:
                if architecture.nodes[one.node] is node:
                    part = _part(architecture, node, one.entry)
                    text = quantity(one.value, part.unit) if part else number(one.value)
                    found.setdefault(one.entry, []).append(text)
    return {entry: " or ".join(dict.fromkeys(values)) for entry, values in found.items()}


def _part(architecture: Architecture, node: Node, entry: str) -> State | Control | Read | None:
    """What an entry of a node's register is; None of a module, which has no specification."""
    parts: tuple[State | Control | Read, ...] = ()
    if node.behavior >= 0:
        program = architecture.programs[node.behavior]
        parts = (*program.states, *program.controls)
    elif node.arbiter >= 0:
        arbiter = architecture.arbiters[node.arbiter]
        parts = (*arbiter.reads, *arbiter.controls)
    return next((part for part in parts if part.name == entry), None)


def _note(architecture: Architecture, node: Node, one: Input) -> str:
    """In small: the value of what no signal sets; of a wire its scale, and what it does outside."""
    part = _part(architecture, node, one.entry)
    if one.signal < 0:
        if part is None:
            return number(one.value)
        if not isinstance(part, Control) and part.kind is Kind.DISCRETE:
            return part.values[int(one.value)]
        return quantity(one.value, part.unit)
    scale = "" if one.scale == 1.0 else f"×{number(one.scale)}"
    if one.outside is Outside.INHIBIT:
        return " ".join(filter(None, (scale, "inhibits")))
    if part is None or (not isinstance(part, Control) and part.kind is not Kind.CONTINUOUS):
        return scale
    signal = architecture.board[one.signal]
    low, high = sorted((one.scale * signal.low, one.scale * signal.high))
    return " ".join(filter(None, (scale, "clipped" * (low < part.low or high > part.high))))


def _mouth(architecture: Architecture, channel: Channel) -> Mouth:
    resolution = channel.resolution
    names = [architecture.nodes[place].name for place in resolution.nodes]
    ranked = resolution.way is Way.PRIORITY
    claims = (
        Port(name, f"{place}." if ranked else "") for place, name in enumerate(names, start=1)
    )
    what = resolution.way.value if names else "nobody"
    if resolution.arbiter >= 0:
        what += f" by {architecture.nodes[resolution.arbiter].name}"
    if resolution.function:
        what += f" {resolution.function}"
    return Mouth(channel.name, what, channel.rest, tuple(claims), resolution.proof)


def _nets(architecture: Architecture) -> tuple[Net, ...]:
    """Every wire: those from one source make one net."""
    targets: dict[tuple[str, str], list[tuple[str, str]]] = {}
    sorts: dict[tuple[str, str], Sort] = {}
    choices = {(n.name, c.name) for n in architecture.nodes for c in n.choices}
    nodes = {node.name for node in architecture.nodes}

    def add(source: tuple[str, str], target: tuple[str, str], sort: Sort) -> None:
        sorts.setdefault(source, sort)
        known = targets.setdefault(source, [])
        if target not in known:
            known.append(target)

    for node in architecture.nodes:
        for one in node.inputs:
            if one.signal >= 0:
                box, _, name = architecture.board[one.signal].name.partition(".")
                sort = Sort.OUTPUT if box in nodes else Sort.READING
                add((box, name), (node.name, one.entry), sort)
        for choice in node.choices:
            for place in choice.acts:
                other = architecture.nodes[place].name
                add((node.name, choice.name), (other, ACTS), Sort.CHOICE)
            for setting in choice.sets:
                target = (architecture.nodes[setting.node].name, setting.entry)
                add((node.name, choice.name), target, Sort.CHOICE)
        for command in node.commands:
            channel = architecture.channels[command.channel]
            add((node.name, channel.name), (channel.name, node.name), Sort.COMMAND)
    return tuple(
        Net(Sort.CHOICE if source in choices else sorts[source], source, tuple(found))
        for source, found in targets.items()
    )

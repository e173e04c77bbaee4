"""What fields the messages of a channel have, and whether a path leads to a number.

JSON messages have no binding definition, so their shape is taken from the first of them, in the
same form as a definition.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

from verifier.traces.faults import nearest_help
from verifier.traces.messages.channel import Channel
from verifier.traces.messages.definitions import (
    DefinitionError,
    Many,
    Node,
    Number,
    Struct,
    Text,
    definition,
)
from verifier.traces.messages.json_messages import Json, parse
from verifier.traces.messages.paths import DERIVED, MessagePath, Steps, steps_text

EXAMPLES = 20
_STAMPS: tuple[Steps, ...] = (("header", "stamp"), ("stamp",), ("timestamp",))
_SECONDS = frozenset({"sec", "secs"})
_NANOSECONDS = frozenset({"nanosec", "nsec", "nsecs"})
_QUATERNION = frozenset("xyzw")


@final
class FieldError(Exception):
    """Why a path finds no number in a channel: a code of `faults`, a message, help.

    depth: which of the path's steps is at fault, where it is one of them.
    """

    def __init__(
        self,
        code: str,
        message: str,
        help: str = "",  # noqa: A002  # as in Diagnostic
        depth: int | None = None,
    ) -> None:
        self.code = code
        self.message = message
        self.help = help
        self.depth = depth
        super().__init__(message)


@final
@dataclass(frozen=True, slots=True)
class StampLeaves:
    """Where the sensor's stamp stands: seconds and nanoseconds."""

    seconds: Steps
    nanoseconds: Steps


def shape(channel: Channel, examples: Sequence[bytes]) -> Struct:
    """The fields of a channel's messages; raises FieldError V307 or V311.

    examples: the first messages, which show it where nothing defines it.
    """
    if channel.encoding in {"cdr", "ros1"}:
        return _defined(channel)
    if channel.encoding == "json":
        return _shown(channel, examples)
    message = f"messages of {channel.topic} are encoded as {channel.encoding!r}"
    raise FieldError("V307", message, "specc reads cdr (ROS 2), ros1 and json")


def check(root: Struct, path: MessagePath) -> Node:
    """The node at the end of the path, a number or a text; raises FieldError V304 or V305."""
    node: Node = root
    for depth, step in enumerate(path.steps):
        above = steps_text(path.steps[:depth]) or path.topic
        try:
            node = _item(node, step, above) if isinstance(step, int) else _field(node, step, above)
        except FieldError as error:
            raise FieldError(error.code, error.message, error.help, depth) from error
    at = steps_text(path.steps)
    if path.derived:
        if not is_quaternion(node):
            message = f"@{path.derived} needs a quaternion, {at} is {_kind(node)}"
            raise FieldError("V305", message, _inside_help(node))
    elif isinstance(node, Struct | Many):
        raise FieldError("V305", f"{at} is {_kind(node)}, not a number", _inside_help(node))
    return node


def is_quaternion(node: Node) -> bool:
    """Whether the node has exactly the numbers x, y, z and w."""
    if not isinstance(node, Struct) or frozenset(node.names) != _QUATERNION:
        return False
    return all(isinstance(child, Number) for _, child in node.fields)


def is_stamp(node: Node) -> bool:
    """Whether the node is a time of seconds and nanoseconds."""
    names = set(node.names) if isinstance(node, Struct) else set()
    return len(names) == 2 and bool(names & _SECONDS) and bool(names & _NANOSECONDS)


def stamp_leaves(root: Struct) -> StampLeaves | None:
    """The stamp in a header or at the top of the message, if it has one."""
    for steps in _STAMPS:
        node: Node | None = root
        for step in steps:
            node = node.field(str(step)) if isinstance(node, Struct) else None
        if node is not None and is_stamp(node):
            assert isinstance(node, Struct), "a stamp is a struct"
            seconds = next(name for name in node.names if name in _SECONDS)
            rest = next(name for name in node.names if name in _NANOSECONDS)
            return StampLeaves((*steps, seconds), (*steps, rest))
    return None


def _defined(channel: Channel) -> Struct:
    if not channel.message_type:
        message = f"the log names no message type for {channel.topic}"
        raise FieldError("V311", message, "record again with the message definitions")
    try:
        text = channel.schema.decode("utf-8", errors="replace")
        return definition(channel.message_type, channel.schema_encoding, text)
    except DefinitionError as error:
        message = f"messages of {channel.topic} can't be decoded: {error}"
        raise FieldError("V311", message, "record again with the message definitions") from error


def _shown(channel: Channel, examples: Sequence[bytes]) -> Struct:
    fields: dict[str, Node] = {}
    for payload in examples[:EXAMPLES]:
        try:
            message = parse(payload)
        except ValueError:
            continue
        node = _shape_of(message)
        if isinstance(node, Struct):
            fields |= dict(node.fields)
    return Struct(channel.message_type or "message", tuple(fields.items()))


def _shape_of(message: Json) -> Node:
    if isinstance(message, dict):
        return Struct("object", tuple((name, _shape_of(value)) for name, value in message.items()))
    if isinstance(message, list):
        return Many(_shape_of(message[0] if message else None), None)
    return Text() if isinstance(message, str) else Number("f8")


def _field(node: Node, name: str, above: str) -> Node:
    if isinstance(node, Many):
        raise FieldError(
            "V304", f"{above} is a list and has no field '{name}'", f"write {above}[0]"
        )
    if not isinstance(node, Struct):
        raise FieldError("V304", f"{above} is {_kind(node)} and has no field '{name}'")
    found = node.field(name)
    if found is None:
        help_text = nearest_help(name, node.names, "fields")
        raise FieldError("V304", f"{above} ({node.name}) has no field '{name}'", help_text)
    return found


def _item(node: Node, index: int, above: str) -> Node:
    if not isinstance(node, Many):
        raise FieldError("V304", f"{above} is {_kind(node)}, not a list")
    if node.count is not None and not -node.count <= index < node.count:
        raise FieldError("V304", f"{above} has {node.count} items, no item {index}")
    return node.item


def _kind(node: Node) -> str:
    match node:
        case Number():
            return "a number"
        case Text():
            return "a text"
        case Many():
            return "a list"
        case Struct():
            return f"a {node.name}"


def _inside_help(node: Node) -> str:
    if is_quaternion(node):
        return "of a quaternion: " + ", ".join(f".@{name}" for name in DERIVED)
    if isinstance(node, Struct):
        return f"fields: {', '.join(node.names)}"
    return "write [0] for its first item" if isinstance(node, Many) else ""

"""Whether a path leads to a number in the messages of a channel, and where stamps stand."""

from dataclasses import dataclass
from typing import final

from verifier.traces.faults import nearest_help
from verifier.traces.messages.definitions import Many, Node, Number, Struct, Text
from verifier.traces.messages.paths import DERIVED, MessagePath, Steps, steps_text
from verifier.traces.messages.ulog_formats import FAMILY

_STAMPS: tuple[Steps, ...] = (("header", "stamp"), ("stamp",), ("timestamp",))
_SECONDS = frozenset({"sec", "secs", "seconds"})
_NANOSECONDS = frozenset({"nanosec", "nsec", "nsecs", "nanos"})
_QUATERNION = frozenset("xyzw")
_PX4 = ("px4_msgs/", FAMILY)


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
        if not is_quaternion(node, root):
            message = f"@{path.derived} needs a quaternion, {at} is {_kind(node)}"
            raise FieldError("V305", message, _inside_help(node, root))
    elif isinstance(node, Struct | Many):
        raise FieldError("V305", f"{at} is {_kind(node)}, not a number", _inside_help(node, root))
    return node


def is_quaternion(node: Node, root: Struct) -> bool:
    """Whether the node of a message `root` has exactly the numbers x, y, z and w.

    In PX4's messages also a list of four floats.
    """
    if isinstance(node, Many):
        return root.name.startswith(_PX4) and node.count == 4 and node.item == Number("f4")
    if not isinstance(node, Struct) or frozenset(node.names) != _QUATERNION:
        return False
    return all(isinstance(child, Number) for _, child in node.fields)


def leaves(root: Struct, path: MessagePath) -> tuple[Steps, ...]:
    """The numbers that have to be read for a path: one, or x, y, z and w of a quaternion.

    PX4's quaternions are lists of w, x, y and z.
    """
    if not path.derived:
        return (path.steps,)
    node = check(root, path)
    keys: Steps = (1, 2, 3, 0) if isinstance(node, Many) else ("x", "y", "z", "w")
    return tuple((*path.steps, key) for key in keys)


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


def _inside_help(node: Node, root: Struct) -> str:
    if is_quaternion(node, root):
        return "of a quaternion: " + ", ".join(f".@{name}" for name in DERIVED)
    if isinstance(node, Struct):
        return f"fields: {', '.join(node.names)}"
    return "write [0] for its first item" if isinstance(node, Many) else ""

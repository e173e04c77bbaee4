"""The fields of a message that a user may want to bind, listed."""

from collections.abc import Iterator
from itertools import islice

from verifier.traces.messages.definitions import Many, Node, Struct
from verifier.traces.messages.fields import is_quaternion, is_stamp
from verifier.traces.messages.paths import DERIVED, MessagePath, Steps, path_text

MOST_FIELDS = 400
MOST_NODES = 20_000
"""Looked at. Types within types, each many times in the next, may hold no leaf for ever."""
MOST_ITEMS = 8
DEEPEST = 16


def list_fields(root: Struct) -> tuple[Steps, ...]:
    """The leaves of a message: all items of short lists, the first of long ones; no stamps."""
    nodes = islice(_walk(root, (), DEEPEST), MOST_NODES)
    found = (steps for steps, node in nodes if not isinstance(node, Struct | Many))
    return tuple(islice(found, MOST_FIELDS))


def list_quaternions(root: Struct) -> tuple[Steps, ...]:
    """Where quaternions stand among the first fields of a message."""
    nodes = islice(_walk(root, (), DEEPEST), MOST_FIELDS)
    return tuple(steps for steps, node in nodes if is_quaternion(node, root))


def all_paths(root: Struct, topic: str) -> tuple[MessagePath, ...]:
    """The paths to the leaves of a message, and to the angles of its quaternions."""
    paths = [MessagePath(path_text(topic, steps), topic, steps, "") for steps in list_fields(root)]
    for steps in list_quaternions(root):
        start = path_text(topic, steps)
        paths += [MessagePath(f"{start}.@{name}", topic, steps, name) for name in DERIVED]
    return tuple(paths)


def _walk(node: Node, above: Steps, depth: int) -> Iterator[tuple[Steps, Node]]:
    """The structs, lists and leaves at and below a node."""
    if isinstance(node, Many):
        yield above, node
        for index in range(_items(node) if depth else 0):
            yield from _walk(node.item, (*above, index), depth - 1)
        return
    if isinstance(node, Struct):
        if is_stamp(node) or not depth:
            return
        yield above, node
        for name, child in node.fields:
            yield from _walk(child, (*above, name), depth - 1)
    else:
        yield above, node


def _items(node: Many) -> int:
    """How many items of a list are shown: a covariance has 36, a joint state perhaps six."""
    if isinstance(node.item, Struct) or (node.count or 0) > MOST_ITEMS:
        return 1
    return MOST_ITEMS if node.count is None else node.count

"""Message paths as Foxglove writes them: `/odom.pose.pose.position.x`, `/scan.ranges[0]`.

A topic name holds slashes and no dots, so the first dot ends it; a name with dots or blanks is put
in double quotes. After the fields may stand a value that is derived from a quaternion: `.@yaw`,
`.@pitch`, `.@roll` (radians; `.@rpy.yaw` says the same).
"""

import re
from dataclasses import dataclass
from typing import TypeAlias, final

Step: TypeAlias = str | int
Steps: TypeAlias = tuple[Step, ...]

DERIVED = ("yaw", "pitch", "roll")

_NAME = re.compile(r'"[^"]*"|[^.\[\]{}"@\s]+')
_TOPIC = re.compile(r'"[^"]+"|[^.\[\]{}"@\s]+')
_INDEX = re.compile(r"-?\d{1,9}\Z")
_SLICE = re.compile(r"(-?\d{1,9})?:(-?\d{1,9})?\Z")


@final
class PathError(Exception):
    """What is wrong with a path: `start` to `end` are character offsets into its text."""

    def __init__(self, message: str, start: int, end: int, help: str = "") -> None:  # noqa: A002  # as in Diagnostic
        self.message = message
        self.start = start
        self.end = end
        self.help = help
        super().__init__(message)


@final
@dataclass(frozen=True, slots=True)
class MessagePath:
    """Where a number stands in the messages of a topic.

    steps: field names and indices, from the message down; a negative index counts from the end.
    derived: one of `DERIVED` where the steps lead to a quaternion, else empty.
    """

    text: str
    topic: str
    steps: Steps
    derived: str

    def part(self, depth: int) -> tuple[int, int] | None:
        """From where to where in the text the step stands; None where it is written unusually."""
        above, whole = (path_text(self.topic, self.steps[:end]) for end in (depth, depth + 1))
        if not self.text.startswith(whole):
            return None
        dot = isinstance(self.steps[depth], str)
        return len(above) + dot, len(whole)


def parse_path(text: str) -> MessagePath:
    """The path that `text` writes; raises PathError.

    >>> parse_path("/odom.pose.pose.orientation.@yaw").steps
    ('pose', 'pose', 'orientation')
    """
    head = _TOPIC.match(text)
    if not head:
        raise PathError("a path begins with a topic", 0, len(text), "write /topic.field")
    steps: list[Step] = []
    derived, position = "", head.end()
    while position < len(text):
        if text[position] == "[":
            index, position = _read_index(text, position)
            steps.append(index)
        elif text.startswith(".@", position):
            derived = _read_derived(text, position)
            position = len(text)
        elif text[position] == ".":
            name, position = _read_field(text, position)
            steps.append(name)
        else:
            raise _unexpected(text, position)
    if not steps:
        raise PathError("the path names a topic but no field", 0, len(text), f"write {text}.field")
    return MessagePath(text, head.group().strip('"'), tuple(steps), derived)


def parse_column(text: str) -> str:
    """The column of a CSV file that `text` names; quotes round an odd name are taken off."""
    for quote in "\"'`":
        if len(text) > 1 and text.startswith(quote) and text.endswith(quote):
            return text[1:-1]
    return text


def column_text(name: str) -> str:
    """The column's name as a path, quoted where it begins with a quote itself."""
    return name if parse_column(name) == name else f'"{name}"'


def steps_text(steps: Steps) -> str:
    """`pose.position[0].x`, as it stands after the topic and its dot."""
    return _below(steps).removeprefix(".")


def path_text(topic: str, steps: Steps) -> str:
    """The whole path, quoted where the topic needs it."""
    name = topic if _TOPIC.fullmatch(topic) else f'"{topic}"'
    return name + _below(steps)


def _below(steps: Steps) -> str:
    parts = [f"[{step}]" if isinstance(step, int) else f".{_quoted(step)}" for step in steps]
    return "".join(parts)


def _quoted(name: str) -> str:
    return name if _NAME.fullmatch(name) else f'"{name}"'


def _read_field(text: str, position: int) -> tuple[str, int]:
    found = _NAME.match(text, position + 1)
    if not found:
        raise PathError("a field name is missing after the dot", position, position + 1)
    return found.group().strip('"'), found.end()


def _read_index(text: str, position: int) -> tuple[int, int]:
    close = text.find("]", position)
    if close < 0:
        raise PathError("the bracket is not closed", position, len(text), "write [0]")
    inner = text[position + 1 : close].strip()
    end = close + 1
    if _INDEX.match(inner):
        return int(inner), end
    found = _SLICE.match(inner)
    if not found:
        raise PathError(f"an index is a whole number (got {inner!r})", position, end, "write [0]")
    first, last = found.groups()
    if first is None or first != last:
        message = "the slice gives several values, a variable needs one"
        raise PathError(message, position, end, f"write [{first or 0}]")
    return int(first), end


def _read_derived(text: str, position: int) -> str:
    asked = text[position + 2 :]
    name = asked.removeprefix("rpy.")
    if name in DERIVED:
        return name
    known = ", ".join(f".@{name}" for name in DERIVED)
    message = f"no derived value is named '@{asked}'"
    raise PathError(message, position + 1, len(text), f"known: {known}, each of a quaternion")


def _unexpected(text: str, position: int) -> PathError:
    if text[position] == "{":
        message = "filters are not supported: a variable needs a value from every message"
        return PathError(message, position, len(text), "write an index such as [0]")
    if text[position] == "@":
        return PathError("a dot is missing before the '@'", position, len(text), "write .@yaw")
    return PathError(f"{text[position]!r} is not expected here", position, position + 1)

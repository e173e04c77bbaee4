"""Message formats of ULog, PX4's log: `name:type field;type[n] field;...`, one a line.

https://docs.px4.io/main/en/dev_log/ulog_file_format.html
"""

import re
from collections.abc import Mapping

from verifier.traces.messages.definitions import DefinitionError, Many, Node, Number, Struct

FAMILY = "ulog/"
"""Begins the names of all these types."""

_DEEPEST = 8
_CODES = {
    "int8_t": "i1",
    "uint8_t": "u1",
    "int16_t": "i2",
    "uint16_t": "u2",
    "int32_t": "i4",
    "uint32_t": "u4",
    "int64_t": "i8",
    "uint64_t": "u8",
    "float": "f4",
    "double": "f8",
    "bool": "u1",
    "char": "u1",
}
_FIELD = re.compile(r"(?P<kind>\w+)(?:\[(?P<count>\d{1,5})\])? (?P<name>\w+)\Z")


def ulog_definition(name: str, text: str) -> Struct:
    """The tree of the format `name`; raises DefinitionError."""
    formats = dict(line.partition(":")[::2] for line in text.splitlines())
    root = _struct(name, formats, 0)
    fields = list(root.fields)
    # Padding at the end is not logged.
    while fields and fields[-1][0].startswith("_padding"):
        fields.pop()
    return Struct(root.name, tuple(fields))


def _struct(name: str, formats: Mapping[str, str], depth: int) -> Struct:
    if name not in formats:
        raise DefinitionError(f"the format of {name} is not in the file")
    if depth > _DEEPEST:
        raise DefinitionError(f"the format of {name} contains itself")
    fields = [_field(text, formats, depth) for text in formats[name].split(";") if text]
    return Struct(FAMILY + name, tuple(fields))


def _field(text: str, formats: Mapping[str, str], depth: int) -> tuple[str, Node]:
    found = _FIELD.match(text)
    if not found:
        raise DefinitionError(f"{text[:40]!r} is no field of a format")
    kind, count = found["kind"], found["count"]
    node: Node = Number(_CODES[kind]) if kind in _CODES else _struct(kind, formats, depth + 1)
    return found["name"], Many(node, int(count)) if count else node

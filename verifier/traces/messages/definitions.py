"""Message definitions (.msg and IDL texts) as trees that a walk over the bytes can follow.

The texts come out of the log, from strangers: they are parsed, never executed.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias, final

from rosbags.interfaces import Nodetype
from rosbags.interfaces.typing import Fielddefs, FieldDesc, Typesdict
from rosbags.typesys import (
    Stores,
    TypesysError,
    get_types_from_idl,
    get_types_from_msg,
    get_typestore,
)

MOST_CHARACTERS = 200_000

# ROS 1 `byte` is int8 and `char` uint8; ROS 2 has both unsigned. Nobody measures with them.
_CODES = {
    "bool": "u1",
    "byte": "u1",
    "char": "u1",
    "int8": "i1",
    "uint8": "u1",
    "int16": "i2",
    "uint16": "u2",
    "int32": "i4",
    "uint32": "u4",
    "int64": "i8",
    "uint64": "u8",
    "float32": "f4",
    "float64": "f8",
}

_INT32: FieldDesc = (Nodetype.BASE, ("int32", 0))
_UINT32: FieldDesc = (Nodetype.BASE, ("uint32", 0))
# ROS 1 texts use `time` without defining it; rosbags calls it by ROS 2's name. Its seconds are
# unsigned there, which differs from 2038 on.
_TIMES: Typesdict = {
    "builtin_interfaces/msg/Time": ([], [("sec", _INT32), ("nanosec", _UINT32)]),
    "builtin_interfaces/msg/Duration": ([], [("sec", _INT32), ("nanosec", _INT32)]),
}


@final
class DefinitionError(Exception):
    """A definition that can't be used; the message says why."""


@final
@dataclass(frozen=True, slots=True)
class Number:
    """A number of a fixed size; `code` is numpy's, without byte order (`f8`)."""

    code: str

    @property
    def size(self) -> int:
        """Bytes."""
        return int(self.code[1:])


@final
@dataclass(frozen=True, slots=True)
class Text:
    """A string: a length and its bytes."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Many:
    """An array of `count` items, or a sequence whose length stands before it (None)."""

    item: "Node"
    count: int | None


@final
@dataclass(frozen=True, eq=False, slots=True)
class Struct:
    """A message type: its fields in order."""

    name: str
    fields: tuple[tuple[str, "Node"], ...]

    def field(self, name: str) -> "Node | None":
        """The field of that name."""
        return next((node for key, node in self.fields if key == name), None)

    @property
    def names(self) -> tuple[str, ...]:
        """The fields' names."""
        return tuple(name for name, _ in self.fields)


Node: TypeAlias = Number | Text | Many | Struct


@lru_cache(maxsize=256)
def definition(message_type: str, schema_encoding: str, text: str) -> Struct:
    """The tree of a message type; raises DefinitionError.

    An empty text stands for the definition that ROS 2 Humble ships under that name: bags from
    before ROS 2 Iron hold no definitions.
    """
    name = _full_name(message_type)
    types = _parsed(name, schema_encoding, text)
    if name not in types:
        raise DefinitionError(f"the definition of {message_type} is not in the file")
    return _resolve(name, types, {}, ())


def _full_name(name: str) -> str:
    parts = name.split("/")
    return name if len(parts) != 2 else f"{parts[0]}/msg/{parts[1]}"


def _parsed(name: str, schema_encoding: str, text: str) -> Mapping[str, tuple[object, Fielddefs]]:
    if not text.strip():
        return get_typestore(Stores.ROS2_HUMBLE).fielddefs
    if len(text) > MOST_CHARACTERS:
        raise DefinitionError(f"the definition of {name} has {len(text)} characters")
    return {**_TIMES, **_parse(name, schema_encoding, text)}


def _parse(name: str, schema_encoding: str, text: str) -> Typesdict:
    text = text.replace("\r\n", "\n")
    try:
        if schema_encoding in {"ros1msg", "ros2msg"}:
            return get_types_from_msg(text, name)
        if schema_encoding == "ros2idl":
            # Several files, each after a line of `=` and one that names it.
            parts = re.split(r"^=+\n(?:IDL: .*\n)?", text, flags=re.MULTILINE)
            parsed = [get_types_from_idl(part) for part in parts if part.strip()]
            return {key: value for types in parsed for key, value in types.items()}
    except (TypesysError, ValueError, KeyError, IndexError, TypeError, RecursionError) as error:
        raise DefinitionError(f"the definition of {name} can't be read") from error
    raise DefinitionError(f"definitions written as {schema_encoding!r} are not supported")


def _resolve(
    name: str,
    types: Mapping[str, tuple[object, Fielddefs]],
    done: dict[str, Struct],
    above: tuple[str, ...],
) -> Struct:
    if name in done:
        return done[name]
    if name in above or len(above) > 40:
        raise DefinitionError(f"the definition of {name} contains itself")
    if name not in types:
        raise DefinitionError(f"the definition of {name} is not in the file")
    fields = tuple(
        (field, _node(described, types, done, (*above, name)))
        for field, described in types[name][1]
    )
    done[name] = Struct(name, fields)
    return done[name]


def _node(
    described: FieldDesc,
    types: Mapping[str, tuple[object, Fielddefs]],
    done: dict[str, Struct],
    above: tuple[str, ...],
) -> Node:
    match described:
        case (Nodetype.BASE, ("string", _)):
            return Text()
        case (Nodetype.BASE, (base, _)) if base in _CODES:
            return Number(_CODES[base])
        case (Nodetype.NAME, str(name)):
            return _resolve(name, types, done, above)
        case (Nodetype.ARRAY, (item, count)):
            return Many(_node(item, types, done, above), int(count))
        case (Nodetype.SEQUENCE, (item, _)):
            return Many(_node(item, types, done, above), None)
    raise DefinitionError(f"a field of type {described[1]!r} is not supported")

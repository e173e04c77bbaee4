"""Values out of protobuf messages, by the descriptors that the log itself holds."""

from collections.abc import Callable, Sequence
from typing import Any, final

import numpy as np
from google.protobuf.descriptor import Descriptor, FieldDescriptor
from google.protobuf.descriptor_pb2 import FileDescriptorProto, FileDescriptorSet
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.message import DecodeError, Message
from google.protobuf.message_factory import GetMessageClass

from verifier.traces.messages.channel import Channel
from verifier.traces.messages.columns import Cell, Decoded, column
from verifier.traces.messages.definitions import (
    DefinitionError,
    Many,
    Node,
    Number,
    Struct,
    Text,
)
from verifier.traces.messages.paths import Steps

DEEPEST = 12
MOST_BYTES = 1 << 22

_TEXTS = frozenset({FieldDescriptor.CPPTYPE_STRING, FieldDescriptor.CPPTYPE_ENUM})


@final
class Protobuf:
    """The messages of one channel: their shape, and their values. Raises DefinitionError."""

    def __init__(self, channel: Channel) -> None:
        self._descriptor = _descriptor(channel)
        self._message: type[Message] = GetMessageClass(self._descriptor)
        self.root = _struct(self._descriptor, 0, {})

    def decode(self, payloads: Sequence[bytes], asked: Sequence[Steps]) -> Decoded:
        """The asked-for leaves in all messages; one that is no such message is not readable.

        A field that a message lacks has its default value, as protobuf means it; what stands in a
        message that is lacking has none.
        """
        getters = [_getter(self._descriptor, steps) for steps in asked]
        cells: list[list[Cell]] = [[] for _ in asked]
        readable = np.ones(len(payloads), dtype=np.bool_)
        reason = ""
        message = self._message()
        for row, payload in enumerate(payloads):
            try:
                message.ParseFromString(payload)
            except DecodeError as error:
                readable[row] = False
                reason = reason or f"it is no {self._descriptor.full_name}: {error}"
                message.Clear()
            for one, getter in zip(cells, getters, strict=True):
                one.append(getter(message))
        return Decoded(tuple(column(one) for one in cells), readable, reason)


def _descriptor(channel: Channel) -> Descriptor:
    name = channel.message_type
    if len(channel.schema) > MOST_BYTES:
        raise DefinitionError(f"the definition of {name} has {len(channel.schema)} bytes")
    pool = DescriptorPool()
    try:
        files = {file.name: file for file in FileDescriptorSet.FromString(channel.schema).file}
        for file in list(files):
            _add(pool, files, file)
        return pool.FindMessageTypeByName(name)
    except (DecodeError, TypeError, KeyError, ValueError, RecursionError) as error:
        raise DefinitionError(f"the definition of {name} can't be read") from error


def _add(pool: DescriptorPool, files: dict[str, FileDescriptorProto], name: str) -> None:
    """Adds a file after those that it needs."""
    file = files.pop(name, None)
    if file is not None:
        for needed in file.dependency:
            _add(pool, files, needed)
        pool.Add(file)


def _struct(descriptor: Descriptor, depth: int, known: dict[tuple[str, int], Struct]) -> Struct:
    """The tree of a type; `known` shares what stands in many places, or it would grow without end.

    Three fields of the type itself would make 3 ** 12 structs of it.
    """
    key = (descriptor.full_name, depth)
    if key not in known:
        fields = tuple((field.name, _node(field, depth, known)) for field in descriptor.fields)
        known[key] = Struct(descriptor.full_name, fields)
    return known[key]


def _node(field: FieldDescriptor, depth: int, known: dict[tuple[str, int], Struct]) -> Node:
    node: Node
    if field.cpp_type == FieldDescriptor.CPPTYPE_MESSAGE:
        # A type may contain itself; nobody measures that deep.
        deep = depth >= DEEPEST
        node = Struct(field.name, ()) if deep else _struct(field.message_type, depth + 1, known)
    else:
        node = Text() if field.cpp_type in _TEXTS else Number("f8")
    return Many(node, None) if field.is_repeated else node


def _getter(descriptor: Descriptor, steps: Steps) -> Callable[[Message], Cell]:
    """What reads the leaf at these steps out of a message."""
    names: dict[int, str] = {}
    field: FieldDescriptor | None = None
    below: Descriptor | None = descriptor
    for step in steps:
        if isinstance(step, str) and below is not None:
            field = below.fields_by_name.get(step)
            below = field.message_type if field is not None else None
    if field is not None and field.cpp_type == FieldDescriptor.CPPTYPE_ENUM:
        names = {number: value.name for number, value in field.enum_type.values_by_number.items()}

    def get(message: Message) -> Cell:
        value: object = _at(message, steps)
        if names and isinstance(value, int):
            return names.get(int(value), str(value))
        return value if isinstance(value, str) else _number(value)

    return get


def _at(message: Any, steps: Steps) -> object:
    """What stands at these steps; None where a message or an item on the way is lacking."""
    value = message
    for step in steps:
        if isinstance(step, int):
            if not -len(value) <= step < len(value):
                return None
            value = value[step]
            continue
        inner = getattr(value, step)
        if isinstance(inner, Message) and not value.HasField(step):
            return None
        value = inner
    return value


def _number(value: object) -> Cell:
    return float(value) if isinstance(value, bool | int | float) else None

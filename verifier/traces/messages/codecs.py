"""How the messages of a channel are read: the shape that they have, and what decodes them.

JSON messages have no binding definition, so their shape is taken from the first of them, in the
same form as a definition.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias, final

from verifier.traces.messages import json_messages, wire
from verifier.traces.messages.channel import Channel
from verifier.traces.messages.columns import Decoded
from verifier.traces.messages.definitions import (
    DefinitionError,
    Many,
    Node,
    Number,
    Struct,
    Text,
    definition,
)
from verifier.traces.messages.fields import FieldError
from verifier.traces.messages.json_messages import Json
from verifier.traces.messages.paths import Steps
from verifier.traces.messages.protobuf_messages import Protobuf
from verifier.traces.messages.ulog_formats import ulog_definition

EXAMPLES = 20

Decode: TypeAlias = Callable[[Sequence[bytes], Sequence[Steps]], Decoded]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Codec:
    """root: the fields of the messages. decode: the asked-for leaves in many of them."""

    root: Struct
    decode: Decode


def find_codec(channel: Channel, examples: Sequence[bytes]) -> Codec:
    """What reads the channel's messages; raises FieldError V307 or V311.

    examples: the first messages, which show their shape where nothing defines it.
    """
    if channel.encoding == "json":
        return Codec(_shown(channel, examples), json_messages.decode)
    if channel.encoding not in {"cdr", "ros1", "ulog", "protobuf"}:
        message = f"messages of {channel.topic} are encoded as {channel.encoding!r}"
        raise FieldError("V307", message, "specc reads cdr (ROS 2), ros1, json, protobuf and ulog")
    if not channel.message_type:
        message = f"the log names no message type for {channel.topic}"
        raise FieldError("V311", message, "record again with the message definitions")
    try:
        return _defined(channel)
    except DefinitionError as error:
        message = f"messages of {channel.topic} can't be decoded: {error}"
        raise FieldError("V311", message, "record again with the message definitions") from error


def _defined(channel: Channel) -> Codec:
    if channel.encoding == "protobuf":
        messages = Protobuf(channel)
        return Codec(messages.root, messages.decode)
    text = channel.schema.decode("utf-8", errors="replace")
    if channel.encoding == "ulog":
        root = ulog_definition(channel.message_type, text)
    else:
        root = definition(channel.message_type, channel.schema_encoding, text)
    return Codec(root, partial(_walk, channel.encoding, root))


def _walk(
    encoding: str, root: Struct, payloads: Sequence[bytes], asked: Sequence[Steps]
) -> Decoded:
    return wire.decode(payloads, encoding, root, asked)


def _shown(channel: Channel, examples: Sequence[bytes]) -> Struct:
    fields: dict[str, Node] = {}
    for payload in examples[:EXAMPLES]:
        try:
            message = json_messages.parse(payload)
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

"""Recordings of scenarios in which one thing is altered, whose checksums fit again."""

import copy
import io
import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

ODD: tuple[Any, ...] = (
    0, 1, -1, 2**70, 0.0, -1.0, 1e-300, 1e300, -5.0, 0.0037, float("nan"), float("inf"),
    "", "add add", "x", "r", "always", "predicate", None, True, [], {}, [1], [[0.0, 0.0]], {"a": 1},
)  # fmt: skip
"""What stands in the place of something."""


@dataclass(frozen=True)
class Content:
    """A recording in parts: schemas and channels by number, messages, attachments."""

    schemas: dict[int, Any]
    channels: dict[int, Any]
    messages: list[Any]
    attachments: dict[str, bytes]


def content_of(path: Path) -> Content:
    """What a recording holds."""
    reader = make_reader(io.BytesIO(path.read_bytes()))
    summary = reader.get_summary()
    assert summary is not None
    messages = [message for _, _, message in reader.iter_messages()]
    attachments = {each.name: each.data for each in reader.iter_attachments()}
    return Content(summary.schemas, summary.channels, messages, attachments)


def written(
    content: Content,
    path: Path,
    attachments: dict[str, bytes],
    light: Callable[[bytes], bytes] = lambda data: data,
) -> Path:
    """The recording with these attachments, and each message of the light on the floor changed."""
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.NONE)
        writer.start()
        schemas = {
            number: writer.register_schema(each.name, each.encoding, each.data)
            for number, each in content.schemas.items()
        }
        channels = {
            number: writer.register_channel(
                each.topic, each.message_encoding, schemas[each.schema_id], each.metadata
            )
            for number, each in content.channels.items()
        }
        for each in content.messages:
            is_light = content.channels[each.channel_id].topic == "/world/light"
            data = light(each.data) if is_light else each.data
            writer.add_message(
                channels[each.channel_id], each.log_time, data, each.publish_time, each.sequence
            )
        for name, data in attachments.items():
            writer.add_attachment(0, 0, name, "application/json", data)
        writer.finish()
    return path


def places_in(value: Any, at: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """The way to everything in a JSON document."""
    keys = value.keys() if isinstance(value, dict) else range(len(value))
    for key in keys:
        yield (*at, key)
        if isinstance(value[key], dict | list):
            yield from places_in(value[key], (*at, key))


def replaced(document: bytes, at: tuple[Any, ...], value: Any) -> bytes:
    """The document with something else at one place."""
    whole = copy.deepcopy(json.loads(document))
    inner = whole
    for key in at[:-1]:
        inner = inner[key]
    inner[at[-1]] = value
    return json.dumps(whole).encode()


def without(document: bytes, at: tuple[Any, ...]) -> bytes:
    """The document without what stands at one place."""
    whole = json.loads(document)
    inner = whole
    for key in at[:-1]:
        inner = inner[key]
    del inner[at[-1]]
    return json.dumps(whole).encode()

"""A channel: one stream of messages of one type, and how they are written."""

from dataclasses import dataclass
from typing import final


@final
@dataclass(frozen=True, slots=True)
class Channel:
    """One stream of messages and how they are written.

    encoding: of the messages: `cdr` (ROS 2), `ros1`, `json`, `protobuf`, `ulog`, or what the
    file says. schema_encoding: of `schema`: `ros2msg`, `ros2idl`, `ros1msg`, `jsonschema`, ...
    """

    topic: str
    message_type: str
    encoding: str
    schema_encoding: str
    schema: bytes

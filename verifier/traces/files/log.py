"""What the readers of files hand on: messages as they were written, or a sheet of columns."""

from dataclasses import dataclass
from pathlib import PurePath
from typing import TypeAlias, final

from runtime.arrays import Integers
from verifier.traces.trace import Loss

LATEST = 4 * 10**18
"""Nanoseconds since 1970, in 2096. Later times are garbage; earlier ones can be subtracted from
one another in 64 bits."""


@final
@dataclass(frozen=True, slots=True)
class Channel:
    """One stream of messages and how they are written.

    encoding: of the messages: `cdr` (ROS 2), `ros1`, `json`, or what the file says.
    schema_encoding: of `schema`: `ros2msg`, `ros2idl`, `ros1msg`, `jsonschema`, ...
    """

    topic: str
    message_type: str
    encoding: str
    schema_encoding: str
    schema: bytes


@final
@dataclass(frozen=True, eq=False, slots=True)
class Messages:
    """The messages of one channel, in the order of the file.

    times: (count,) log times in nanoseconds, of all messages. places: (count,) their places among
    all messages of the log. payloads: (k,) the first k of them, k <= count; all where the channel
    was asked for.
    """

    channel: Channel
    times: Integers
    places: Integers
    payloads: tuple[bytes, ...]


@final
@dataclass(frozen=True, eq=False, slots=True)
class MessageLog:
    """A log of messages: MCAP, or a ROS bag."""

    source: str
    kind: str
    streams: tuple[Messages, ...]
    losses: tuple[Loss, ...]
    notes: tuple[str, ...]

    @property
    def topics(self) -> tuple[str, ...]:
        """All topics, sorted."""
        return tuple(sorted({stream.channel.topic for stream in self.streams}))


@final
@dataclass(frozen=True, eq=False, slots=True)
class Sheet:
    """A CSV file: `columns` of cells as text, `times` (rows,) in nanoseconds.

    time_column: which column the times came from.
    """

    source: str
    columns: dict[str, tuple[str, ...]]
    times: Integers
    time_column: str
    losses: tuple[Loss, ...]
    notes: tuple[str, ...]

    @property
    def name(self) -> str:
        """The file's name, which stands for a topic."""
        return PurePath(self.source).name


LogFile: TypeAlias = MessageLog | Sheet


@final
@dataclass(frozen=True, slots=True)
class Wanted:
    """Which payloads a reader shall keep: of `topics` (None: all), `limit` bytes each."""

    topics: frozenset[str] | None
    limit: int | None = None

    def has(self, topic: str) -> bool:
        """Whether payloads of the topic are wanted."""
        return self.topics is None or topic in self.topics

"""What the readers of files hand on: the values of messages, or a sheet of columns."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import PurePath
from typing import TypeAlias, final

import numpy as np
import numpy.typing as npt

from runtime.arrays import Integers
from verifier.traces.messages.channel import Channel
from verifier.traces.messages.columns import Column
from verifier.traces.messages.paths import MessagePath
from verifier.traces.messages.reading import Values
from verifier.traces.trace import Loss

LATEST = 4 * 10**18
"""Nanoseconds since 1970, in 2096. Later times are garbage; earlier ones can be subtracted from
one another in 64 bits."""

Places: TypeAlias = npt.NDArray[np.uint32]
"""Of messages among all of a log; 32 bits, since there are many of them."""

Progress: TypeAlias = Callable[[int, int], None]
"""Told now and then how many bytes of how many were read."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Messages:
    """The messages of one channel, in the order of the file.

    count: how many there are. times: (count,) log times in nanoseconds, and places: (count,)
    their places among all messages of the log; both empty where the channel was not asked for.
    places is None where no other channel has the same topic: then nobody needs them.
    values: what was read of the first of them; None where nothing was.
    """

    channel: Channel
    count: int
    times: Integers
    places: Places | None
    values: Values | None


@final
@dataclass(frozen=True, eq=False, slots=True)
class MessageLog:
    """A log of messages: MCAP, a ROS bag, or ULog."""

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
    """A CSV file: all its `columns`, empty where not asked for, `times` (rows,) in nanoseconds.

    time_column: which column the times came from.
    """

    source: str
    columns: dict[str, Column]
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
    """What a reader shall read.

    paths: of which topics, and what in their messages; None: all that there is. columns: of a
    CSV file; None: all. limit: the messages' bytes of a channel after which no more values are
    read, only times.
    """

    paths: Mapping[str, tuple[MessagePath, ...]] | None
    columns: frozenset[str] | None
    limit: int | None = None

    def has(self, topic: str) -> bool:
        """Whether anything of the topic is wanted."""
        return self.paths is None or topic in self.paths

    def of(self, topic: str) -> tuple[MessagePath, ...] | None:
        """What is wanted in the topic's messages; None: all that there is."""
        return None if self.paths is None else self.paths[topic]

"""Messages gathered channel by channel while a file is read."""

from collections.abc import Hashable
from typing import Generic, TypeVar, final

import numpy as np

from verifier.traces.files.log import LATEST, Channel, MessageLog, Messages, Wanted
from verifier.traces.trace import Loss

UNBOUNDED = 1 << 62

Key = TypeVar("Key", bound=Hashable)


@final
class Gathering(Generic[Key]):
    """What was read so far of one file. `Key` is how the file numbers its channels.

    A channel may be declared after its messages: some writers put it into the summary only.
    """

    def __init__(self, wanted: Wanted) -> None:
        self._wanted = wanted
        self._channels: dict[Key, Channel] = {}
        self._times: dict[Key, list[int]] = {}
        self._places: dict[Key, list[int]] = {}
        self.count = 0
        self._payloads: dict[Key, list[bytes]] = {}
        self._room: dict[Key, int] = {}
        self._losses: dict[tuple[str, str], int] = {}
        self.notes: list[str] = []

    def declare(self, key: Key, channel: Channel) -> None:
        """A channel; declaring it again changes nothing but its description."""
        self._channels[key] = channel
        room = self._wanted.limit or UNBOUNDED
        self._room.setdefault(key, room if self._wanted.has(channel.topic) else 0)

    def add(self, key: Key, log_time: int, payload: bytes) -> None:
        """A message at `log_time` >= 0 nanoseconds."""
        if log_time > LATEST:
            self.lose("impossible log time", "after the year 2096")
            return
        self._times.setdefault(key, []).append(log_time)
        self._places.setdefault(key, []).append(self.count)
        self.count += 1
        room = self._room.get(key, UNBOUNDED)
        if room > 0:
            self._payloads.setdefault(key, []).append(payload)
            self._room[key] = room - len(payload)

    def lose(self, cause: str, detail: str, count: int = 1) -> None:
        """Something that could not be read."""
        self._losses[cause, detail] = self._losses.get((cause, detail), 0) + count

    def finished(self, source: str, kind: str) -> MessageLog:
        """The log, its channels in the order in which they were declared."""
        for key, times in self._times.items():
            if key not in self._channels:
                self.lose(
                    "messages without a channel", f"channel {key} is not declared", len(times)
                )
        streams = tuple(
            Messages(
                channel,
                np.array(self._times.get(key, []), dtype=np.int64),
                np.array(self._places.get(key, []), dtype=np.int64),
                tuple(self._payloads.get(key, ())) if self._wanted.has(channel.topic) else (),
            )
            for key, channel in self._channels.items()
        )
        losses = tuple(Loss(cause, n, detail) for (cause, detail), n in self._losses.items())
        return MessageLog(source, kind, streams, losses, tuple(dict.fromkeys(self.notes)))

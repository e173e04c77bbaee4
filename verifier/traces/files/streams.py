"""Messages taken channel by channel while a file is read, and decoded in batches."""

import mmap
from array import array
from collections import Counter
from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from typing import Generic, TypeVar, final

import numpy as np

from verifier.traces.files.log import LATEST, MessageLog, Messages, Wanted
from verifier.traces.messages.channel import Channel
from verifier.traces.messages.reading import Reader
from verifier.traces.trace import Loss

BATCH_BYTES = 1 << 22
"""Messages of one channel are decoded when so many bytes of them are held."""

MOST_WAITING = 1 << 26
"""Bytes of messages that are held for a channel whose description has not been seen yet."""

UNBOUNDED = 1 << 62

Key = TypeVar("Key", bound=Hashable)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Run:
    """Some messages of one channel: times, places and payloads, the latter two where wanted."""

    times: list[int]
    places: list[int]
    payloads: list[bytes]
    wanted: bool


@final
class _Stream:
    """One channel's messages. They are told apart by whether the channel is described yet."""

    __slots__ = ("channel", "count", "held", "payloads", "places", "reader", "room", "times")

    def __init__(self) -> None:
        self.channel: Channel | None = None
        self.reader: Reader | None = None
        self.count = 0
        self.times = array("q")
        self.places = array("I")
        self.payloads: list[bytes] = []
        self.held = 0
        self.room = MOST_WAITING

    def take(self, run: Run) -> None:
        """The next messages; where enough are held, all of them are decoded."""
        self.count += len(run.times)
        if not run.wanted:
            return
        self.times.extend(run.times)
        self.places.extend(run.places)
        if self.room <= 0:
            return
        size = sum(map(len, run.payloads))
        self.payloads += run.payloads
        self.held += size
        self.room -= size
        if self.held >= BATCH_BYTES and self.reader:
            self.digest()

    def digest(self) -> None:
        """Decodes what is held."""
        if self.reader and self.payloads:
            self.reader.feed(self.payloads)
        self.payloads = []
        self.held = 0


@final
class Gathering(Generic[Key]):
    """What was read so far of one file. `Key` is how the file numbers its channels.

    A channel may be declared after its messages: some writers put it into the summary only.
    """

    def __init__(self, wanted: Wanted) -> None:
        self._wanted = wanted
        self._streams: dict[Key, _Stream] = {}
        self._closed: list[_Stream] = []
        self._losses: dict[tuple[str, str], int] = {}
        self.count = 0
        self.notes: list[str] = []

    def declare(self, key: Key, channel: Channel) -> None:
        """A channel. One that is declared anew with another description begins anew."""
        stream = self._streams.get(key)
        if stream is None:
            stream = self._streams[key] = _Stream()
        elif stream.channel == channel:
            return
        elif stream.channel is not None and stream.count:
            self._closed.append(stream)
            stream = self._streams[key] = _Stream()
        stream.channel = channel
        if self._wanted.has(channel.topic):
            stream.reader = Reader(channel, self._wanted.of(channel.topic))
            stream.room = (self._wanted.limit or UNBOUNDED) - stream.held
        else:
            stream.reader, stream.room = None, 0
            stream.times, stream.places, stream.payloads = array("q"), array("I"), []

    def add(self, key: Key, log_time: int, data: bytes | mmap.mmap, begin: int, end: int) -> None:
        """A message at `log_time` >= 0 nanoseconds, whose payload is `data[begin:end]`."""
        self.count += 1
        run = self.run(key)
        run.times.append(log_time)
        if run.wanted:
            run.places.append(self.count)
            run.payloads.append(data[begin:end])
        self.take({key: run})

    def run(self, key: Key) -> Run:
        """An empty run of messages of a channel, to be filled and then taken."""
        stream = self._streams.get(key)
        if stream is None:
            stream = self._streams[key] = _Stream()
        return Run([], [], [], wanted=stream.channel is None or stream.reader is not None)

    def take(self, runs: Mapping[Key, Run]) -> None:
        """The runs' messages; the caller has counted them."""
        for key, run in runs.items():
            possible = not run.times or max(run.times) <= LATEST
            self._streams[key].take(run if possible else self._possible(run))

    def _possible(self, run: Run) -> Run:
        """The run without messages of impossible times, which are lost."""
        rows = [row for row, log_time in enumerate(run.times) if log_time <= LATEST]
        lost = len(run.times) - len(rows)
        self.count -= lost
        self.lose("impossible log time", "after the year 2096", lost)
        times = [run.times[row] for row in rows]
        if not run.wanted:
            return Run(times, [], [], wanted=False)
        places = [run.places[row] for row in rows]
        return Run(times, places, [run.payloads[row] for row in rows], wanted=True)

    def lose(self, cause: str, detail: str, count: int = 1) -> None:
        """Something that could not be read."""
        self._losses[cause, detail] = self._losses.get((cause, detail), 0) + count

    def begin_anew(self) -> None:
        """From here on the channels' numbers mean others."""
        self._closed += self._all()
        self._streams = {}

    def finished(self, source: str, kind: str) -> MessageLog:
        """The log, its channels in the order in which they were declared."""
        streams = (*self._closed, *self._all())
        of_topic = Counter(stream.channel.topic for stream in streams if stream.channel)
        described: list[Messages] = []
        for stream in streams:
            stream.digest()
            if stream.channel is not None:
                shared = of_topic[stream.channel.topic] > 1
                described.append(
                    Messages(
                        channel=stream.channel,
                        count=stream.count,
                        times=np.frombuffer(stream.times, dtype=np.int64),
                        places=np.frombuffer(stream.places, dtype=np.uint32) if shared else None,
                        values=stream.reader.finished() if stream.reader else None,
                    )
                )
        losses = tuple(Loss(cause, n, detail) for (cause, detail), n in self._losses.items())
        notes = tuple(dict.fromkeys(self.notes))
        return MessageLog(source, kind, tuple(described), losses, notes)

    def _all(self) -> list[_Stream]:
        """The open channels' messages; those of no channel are lost."""
        for key, stream in self._streams.items():
            if stream.channel is None:
                detail = f"channel {key} is not declared"
                self.lose("messages without a channel", detail, stream.count)
        return [stream for stream in self._streams.values() if stream.channel is not None]

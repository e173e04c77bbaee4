"""What was read so far of one MCAP file: its declarations and its messages."""

from dataclasses import dataclass
from typing import Generic, TypeVar, final

from mcap.records import Channel, Schema

from verifier.traces.files.log import MessageLog, Wanted
from verifier.traces.files.streams import Gathering
from verifier.traces.messages import channel as messages

Told = TypeVar("Told", Schema, Channel)


@final
@dataclass(frozen=True, slots=True)
class _Declared(Generic[Told]):
    """sure: a checksum covers it. foretold: so far only the index at the end has it."""

    record: Told
    sure: bool
    foretold: bool


@final
class Reading:
    """The declarations and messages of one file.

    chunked: whether a chunk was met or is indexed. in_summary: whether the walk is behind the
    data. promised: how many messages the index counts. chunks: where the index says that chunks
    are. index_sure: whether the index declares channels, and its checksum is right.
    """

    def __init__(self, wanted: Wanted) -> None:
        self.gathering: Gathering[int] = Gathering(wanted)
        self.promised: int | None = None
        self.chunked = False
        self.in_summary = False
        self.index_sure = False
        self.chunks: set[int] = set()
        self._schemas: dict[int, _Declared[Schema]] = {}
        self._channels: dict[int, _Declared[Channel]] = {}
        self._before = 0

    def foretell(self, schemas: list[Schema], channels: list[Channel], *, sure: bool) -> None:
        """What the index declares; data that declare it too come later and count more."""
        self._schemas = {one.id: _Declared(one, sure, foretold=True) for one in schemas}
        self._channels = {one.id: _Declared(one, sure, foretold=True) for one in channels}
        self.index_sure = sure and bool(channels)
        for channel in channels:
            self._describe(channel)

    def add_schema(self, schema: Schema | None, place: int, *, sure: bool) -> None:
        """A schema that is declared in the data, or None where its record is corrupt."""
        if schema is None:
            self.gathering.lose("corrupt record", f"a schema at byte {place}")
        elif schema.id == 0:
            self.gathering.lose("corrupt record", "a schema with number 0, which stands for none")
        elif self._accepts(self._schemas, schema, f"schema {schema.id}", sure=sure):
            for declared in list(self._channels.values()):
                if declared.record.schema_id == schema.id:
                    self._describe(declared.record)

    def add_channel(self, channel: Channel | None, place: int, *, sure: bool) -> None:
        """A channel that is declared in the data, or None where its record is corrupt."""
        if channel is None:
            self.gathering.lose("corrupt record", f"a channel at byte {place}")
        elif self._accepts(self._channels, channel, f"channel {channel.id}", sure=sure):
            self._describe(channel)

    def begin_anew(self) -> None:
        """Another file begins in the same bytes."""
        self._close()
        self.gathering.begin_anew()
        self.promised, self.in_summary, self.index_sure = None, False, False
        self.chunks = set()
        self._schemas, self._channels = {}, {}

    def finished(self, source: str) -> MessageLog:
        """The log, and all that it lacks."""
        self._close()
        return self.gathering.finished(source, "MCAP")

    def _accepts(
        self, known: dict[int, _Declared[Told]], record: Told, what: str, *, sure: bool
    ) -> bool:
        """Keeps the better one of two declarations; whether that changes anything."""
        before = known.get(record.id)
        if before is None:
            if self.index_sure:
                self.gathering.lose("index disagrees", f"it does not have {what}")
            known[record.id] = _Declared(record, sure, foretold=False)
            return True
        if before.record == record:
            known[record.id] = _Declared(record, sure or before.sure, foretold=False)
            return False
        told = "index disagrees" if before.foretold or self.in_summary else "declared twice"
        self.gathering.lose(told, f"{what} is described differently")
        if self.in_summary or (before.sure and not sure):
            return False
        known[record.id] = _Declared(record, sure, foretold=False)
        return True

    def _describe(self, channel: Channel) -> None:
        declared = self._schemas.get(channel.schema_id)
        schema = declared.record if declared else None
        self.gathering.declare(
            channel.id,
            messages.Channel(
                topic=channel.topic,
                message_type=schema.name if schema else "",
                encoding=channel.message_encoding,
                schema_encoding=schema.encoding if schema else "",
                schema=schema.data if schema else b"",
            ),
        )

    def _close(self) -> None:
        """Compares what was read with what the index says."""
        gathering = self.gathering
        read = gathering.count - self._before
        self._before = gathering.count
        if self.promised is not None and self.promised > read:
            detail = f"the file's index counts {self.promised}"
            gathering.lose("messages missing", detail, self.promised - read)
        elif self.promised is not None and self.promised < read:
            detail = f"it counts {self.promised} messages, {read} were read"
            gathering.lose("index disagrees", detail)
        if self.chunks:
            detail = "no readable chunk stands where it says"
            gathering.lose("index disagrees", detail, len(self.chunks))
        for declared in self._channels.values():
            number = declared.record.schema_id
            if number and number not in self._schemas:
                topic = declared.record.topic
                gathering.notes.append(f"{topic} names schema {number}, which is not in the file")

"""MCAP files: records walked one by one, checksums compared, what is torn counted.

The index at the end is not trusted: a file that was cut, or whose index lies, gives all the
chunks that are whole. https://mcap.dev/spec
"""

import io
import mmap
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import TypeVar, final

import lz4.frame
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Chunk, Schema, Statistics

from verifier.traces.files import log
from verifier.traces.files.streams import Gathering

MAGIC = b"\x89MCAP0\r\n"
LARGEST_CHUNK = 1 << 31

_HEAD = struct.Struct("<BQ")
_MESSAGE = struct.Struct("<HIQQ")
_OPCODES = frozenset(int(opcode) for opcode in Opcode) | frozenset(range(0x80, 0x100))

Record = TypeVar("Record", Attachment, Channel, Chunk, Schema, Statistics)

# What the library raises on bytes that are not the record they claim to be.
_MALFORMED = (McapError, struct.error, ValueError, KeyError, OverflowError, EOFError)


def is_mcap(head: bytes) -> bool:
    """Whether a file that begins with `head` is an MCAP file."""
    return head.startswith(MAGIC)


def read_mcap(path: Path, wanted: log.Wanted) -> log.MessageLog:
    """All that can be read of the file, and what could not; raises OSError."""
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        reading = _Reading(wanted)
        _read_file(data, reading)
        return reading.finished(str(path))


def find_attachment(path: Path, suffix: str) -> tuple[str, bytes] | None:
    """Name and bytes of the last attachment whose name ends in `suffix`; raises OSError.

    Only heads of records are read on the way, no message. One whose checksum is wrong is not
    returned.
    """
    found = None
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        for opcode, begin, end in _records(data, len(MAGIC)):
            if opcode != Opcode.ATTACHMENT or end > len(data):
                continue
            body = data[begin:end]
            attachment = _parse(Attachment, body)
            whole = _crc_fits(int.from_bytes(body[-4:], "little"), body[:-4])
            if attachment and attachment.name.endswith(suffix) and whole:
                found = (attachment.name, attachment.data)
    return found


@final
class _Reading:
    """What was read so far of one file."""

    def __init__(self, wanted: log.Wanted) -> None:
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        self.gathering: Gathering[int] = Gathering(wanted)
        self.promised: int | None = None

    def add_channel(self, channel: Channel) -> None:
        self.channels[channel.id] = channel
        self.gathering.declare(channel.id, _described(channel, None))

    def finished(self, source: str) -> log.MessageLog:
        gathering = self.gathering
        if self.promised is not None and self.promised > gathering.count:
            missing = self.promised - gathering.count
            gathering.lose("messages missing", f"the file's index counts {self.promised}", missing)
        for channel in self.channels.values():
            schema = self.schemas.get(channel.schema_id)
            if schema is None and channel.schema_id:
                gathering.notes.append(
                    f"{channel.topic} names schema {channel.schema_id}, which is not in the file"
                )
            gathering.declare(channel.id, _described(channel, schema))
        return gathering.finished(source, "MCAP")


def _described(channel: Channel, schema: Schema | None) -> log.Channel:
    return log.Channel(
        topic=channel.topic,
        message_type=schema.name if schema else "",
        encoding=channel.message_encoding,
        schema_encoding=schema.encoding if schema else "",
        schema=schema.data if schema else b"",
    )


def _read_file(data: mmap.mmap, reading: _Reading) -> None:
    size = len(data)
    unchunked = False
    for opcode, begin, end in _records(data, len(MAGIC)):
        if opcode == Opcode.CHUNK:
            _read_chunk(data[begin:end], begin, end - begin, reading)
        elif end > size or opcode not in _OPCODES:
            reading.gathering.lose(
                "file cut or overwritten", f"nothing readable from byte {begin - 9} on"
            )
            return
        elif opcode == Opcode.DATA_END:
            _check_data_section(data, begin, unchunked=unchunked, reading=reading)
        elif opcode == Opcode.FOOTER:
            _check_end(data[end:], reading)
            return
        else:
            unchunked |= opcode == Opcode.MESSAGE
            _read_record(opcode, data[begin:end], reading)
    reading.gathering.lose("file cut", f"it ends at byte {size} without a footer")


def _records(data: mmap.mmap | bytes, position: int) -> Iterator[tuple[int, int, int]]:
    """Opcode, begin and end of each record's body; the last one may end beyond the data."""
    size = len(data)
    while position + 9 <= size:
        opcode, length = _HEAD.unpack_from(data, position)
        position += 9
        yield opcode, position, position + length
        position += length


def _read_record(opcode: int, body: bytes, reading: _Reading) -> None:
    if opcode == Opcode.MESSAGE and len(body) >= _MESSAGE.size:
        channel, _, log_time, _ = _MESSAGE.unpack_from(body)
        reading.gathering.add(channel, log_time, body[_MESSAGE.size :])
    elif opcode == Opcode.SCHEMA:
        if schema := _parse(Schema, body):
            reading.schemas[schema.id] = schema
    elif opcode == Opcode.CHANNEL:
        if channel_record := _parse(Channel, body):
            reading.add_channel(channel_record)
    elif opcode == Opcode.STATISTICS and (statistics := _parse(Statistics, body)):
        reading.promised = statistics.message_count


def _read_chunk(body: bytes, place: int, claimed: int, reading: _Reading) -> None:
    chunk = _parse(Chunk, body)
    if chunk is None:
        reading.gathering.lose("corrupt chunk", f"at byte {place}: it has no readable head")
        return
    try:
        inside = _inside(chunk, torn=len(body) < claimed)
    except (*_MALFORMED, RuntimeError, MemoryError, zstandard.ZstdError) as error:
        reading.gathering.lose("corrupt chunk", f"at byte {place}: {error}")
        return
    if len(body) < claimed:
        reading.gathering.lose(
            "torn chunk", f"at byte {place}: {len(body)} of {claimed} bytes; no checksum to compare"
        )
    elif not chunk.uncompressed_crc:
        reading.gathering.notes.append("chunks carry no checksum: damage in them may go unseen")
    elif not _crc_fits(chunk.uncompressed_crc, inside):
        reading.gathering.lose("corrupt chunk", f"at byte {place}: its checksum is wrong")
        return
    for opcode, begin, end in _records(inside, 0):
        if end > len(inside):
            break
        _read_record(opcode, inside[begin:end], reading)


def _inside(chunk: Chunk, *, torn: bool) -> bytes:
    """The chunk's records, decompressed; of a torn chunk what can be had."""
    if chunk.uncompressed_size > LARGEST_CHUNK:
        raise ValueError(f"it claims {chunk.uncompressed_size} bytes")
    limit = chunk.uncompressed_size
    if chunk.compression == "zstd":
        reader = zstandard.ZstdDecompressor().stream_reader(io.BytesIO(chunk.data))
        return _read_at_most(reader, limit, torn=torn)
    if chunk.compression == "lz4":
        return bytes(lz4.frame.LZ4FrameDecompressor().decompress(chunk.data, max_length=limit))
    if chunk.compression:
        raise ValueError(f"compression {chunk.compression!r} is not supported")
    return chunk.data


def _read_at_most(reader: zstandard.ZstdDecompressionReader, limit: int, *, torn: bool) -> bytes:
    parts: list[bytes] = []
    while limit > 0:
        try:
            part = reader.read(min(limit, 1 << 20))
        except zstandard.ZstdError:
            if not torn:
                raise
            break
        if not part:
            break
        parts.append(part)
        limit -= len(part)
    return b"".join(parts)


def _check_data_section(data: mmap.mmap, begin: int, *, unchunked: bool, reading: _Reading) -> None:
    """Messages outside chunks have no checksum of their own but that of the whole section."""
    expected = int.from_bytes(data[begin : begin + 4], "little")
    if unchunked and expected and zlib.crc32(memoryview(data)[: begin - 9]) != expected:
        reading.gathering.lose("checksum wrong", "some message outside the chunks may be corrupt")


def _check_end(rest: bytes, reading: _Reading) -> None:
    if len(rest) < len(MAGIC) or not rest.startswith(MAGIC):
        reading.gathering.lose(
            "file end torn", f"{len(MAGIC)} closing bytes expected, found {len(rest)}"
        )
    elif len(rest) > len(MAGIC):
        extra = len(rest) - len(MAGIC)
        reading.gathering.lose("trailing bytes", "after the end of the log; not read", extra)


def _crc_fits(expected: int, data: bytes) -> bool:
    return expected == 0 or zlib.crc32(data) == expected


def _parse(kind: type[Record], body: bytes) -> Record | None:
    """The record, or None where the bytes are not one."""
    try:
        return kind.read(ReadDataStream(io.BytesIO(body)))  # type: ignore[no-any-return]  # untyped
    except _MALFORMED:
        return None

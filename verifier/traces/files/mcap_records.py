"""Records of MCAP files: their heads, what makes one believable, and the next one after damage.

https://mcap.dev/spec
"""

import io
import mmap
import re
import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias, TypeVar, final

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Footer, Schema, Statistics

MAGIC = b"\x89MCAP0\r\n"
HEAD = struct.Struct("<BQ")
MESSAGE = struct.Struct("<HIQQ")
_CHUNK_HEAD = struct.Struct("<QQQII")

COMPRESSIONS = frozenset({"", "lz4", "zstd"})
KNOWN = frozenset(int(opcode) for opcode in Opcode)
FIXED: dict[int, int] = {Opcode.DATA_END: 4, Opcode.FOOTER: 20, Opcode.SUMMARY_OFFSET: 17}
# A record's head: an opcode, and a length below 2^40.
_CANDIDATE = re.compile(rb"(?=[\x01-\x0f].{5}\x00\x00\x00)", re.DOTALL)

# What the library raises on bytes that are not the record they claim to be.
_MALFORMED = (McapError, struct.error, ValueError, KeyError, OverflowError, EOFError, MemoryError)

Bytes: TypeAlias = bytes | mmap.mmap
Record = TypeVar("Record", Attachment, Channel, Footer, Schema, Statistics)


@final
@dataclass(frozen=True, slots=True)
class ChunkHead:
    """What stands before a chunk's records, which begin at `begin` and end at `end`."""

    size: int
    crc: int
    compression: str
    begin: int
    end: int


def parse(kind: type[Record], body: bytes) -> Record | None:
    """The record, or None where the bytes are not one."""
    try:
        return kind.read(ReadDataStream(io.BytesIO(body)))  # type: ignore[no-any-return]  # untyped
    except _MALFORMED:
        return None


def chunk_head(data: Bytes, begin: int, end: int) -> ChunkHead | None:
    """The head of the chunk whose body is claimed to be `begin` to `end`; None if it is none.

    The chunk says its own length twice: where only the outer one was damaged, the head's end is
    where the inner one puts it.
    """
    if begin + _CHUNK_HEAD.size > len(data):
        return None
    _, _, size, crc, letters = _CHUNK_HEAD.unpack_from(data, begin)
    place = begin + _CHUNK_HEAD.size
    if letters > 64 or place + letters + 8 > len(data):
        return None
    compression = bytes(data[place : place + letters]).decode("latin-1")
    if not compression.isprintable():
        return None
    inside = place + letters + 8
    whole = inside + int.from_bytes(data[inside - 8 : inside], "little")
    if whole != end and not (compression in COMPRESSIONS and _follows(data, whole)):
        return None
    return ChunkHead(size, crc, compression, inside, whole)


def follows(data: Bytes, position: int) -> bool:
    """Whether a record can begin at `position`, or the log end there."""
    return position == len(data) or _follows(data, position)


def next_record(data: Bytes, position: int, *, loose: bool) -> int:
    """The first place from `position` on at which a believable record begins; -1 if none does.

    loose: messages, schemas and channels outside chunks count.
    """
    while found := _CANDIDATE.search(data, position):
        position = found.start()
        if is_record(data, position, loose=loose):
            return position
        position += 1
    return -1


def is_record(data: Bytes, position: int, *, loose: bool) -> bool:
    """Whether the bytes at `position` are a record, by all that they say of themselves."""
    opcode, length = HEAD.unpack_from(data, position)
    begin = position + HEAD.size
    end = begin + length
    if opcode == Opcode.CHUNK:
        head = chunk_head(data, begin, end)
        return head is not None and head.compression in COMPRESSIONS
    if end > len(data) or not follows(data, end):
        return False
    if opcode in FIXED:
        return bool(length == FIXED[opcode])
    if opcode == Opcode.MESSAGE:
        return loose and length >= MESSAGE.size and _is_chain(data, end)
    return is_filled(data, opcode, begin, end) and (loose or opcode not in _INNER)


def is_filled(data: Bytes, opcode: int, begin: int, end: int, *, unknown: bool = False) -> bool:
    """Whether the parts of the record take just the bytes that it claims.

    unknown: the answer for records whose parts are not read here.
    """
    reader = _READERS.get(opcode)
    return unknown if reader is None else reader(bytes(data[begin:end]))


def _follows(data: Bytes, position: int) -> bool:
    if data[position : position + len(MAGIC)] == MAGIC:
        return True
    if position + HEAD.size > len(data):
        return False
    opcode, length = HEAD.unpack_from(data, position)
    whole = position + HEAD.size + int(length) <= len(data)
    return opcode in KNOWN and (whole or opcode == Opcode.CHUNK)


def _is_chain(data: Bytes, position: int) -> bool:
    """Whether two more records stand in a row; one message may look like another by chance."""
    if position == len(data):
        return True
    _, length = HEAD.unpack_from(data, position)
    return follows(data, position + HEAD.size + length)


def _is_index(body: bytes) -> bool:
    return len(body) >= 6 and len(body) - 6 == int.from_bytes(body[2:6], "little")


def _is(kind: type[Record]) -> Callable[[bytes], bool]:
    return lambda body: _fills(kind, body)


def _fills(kind: type[Record], body: bytes) -> bool:
    """Whether the record takes all of the bytes."""
    stream = ReadDataStream(io.BytesIO(body))
    try:
        kind.read(stream)
    except _MALFORMED:
        return False
    return bool(stream.count == len(body))


_INNER = frozenset({Opcode.MESSAGE, Opcode.SCHEMA, Opcode.CHANNEL})
_READERS: dict[int, Callable[[bytes], bool]] = {
    Opcode.SCHEMA: _is(Schema),
    Opcode.CHANNEL: _is(Channel),
    Opcode.MESSAGE_INDEX: _is_index,
    Opcode.ATTACHMENT: _is(Attachment),
    Opcode.STATISTICS: _is(Statistics),
}

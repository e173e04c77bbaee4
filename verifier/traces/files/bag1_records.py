"""Records of ROS 1 bags: a header of `name=value` fields and a body, each with its length.

http://wiki.ros.org/Bags/Format/2.0
"""

import mmap
import re
from dataclasses import dataclass
from typing import TypeAlias, final

MESSAGE, BAG, INDEX, CHUNK, CHUNK_INFO, CONNECTION = 2, 3, 4, 5, 6, 7

Bytes: TypeAlias = bytes | mmap.mmap
Header: TypeAlias = dict[bytes, bytes]

LONGEST_HEADER = 1 << 16
_OPERATION = re.compile(rb"\x04\x00\x00\x00op=[\x02-\x07]", re.DOTALL)


@final
@dataclass(frozen=True, slots=True)
class Record:
    """A record whose body is `begin` to `end`, which may lie behind the data's end."""

    header: Header
    begin: int
    end: int

    @property
    def kind(self) -> int:
        """Its operation."""
        return number(self.header[b"op"])


def number(data: bytes) -> int:
    """Little-endian."""
    return int.from_bytes(data[:4], "little")


def fields(data: bytes) -> Header | None:
    """The fields of a header; None where the bytes are not one."""
    header: Header = {}
    position = 0
    while position < len(data):
        size = number(data[position : position + 4])
        name, equals, value = data[position + 4 : position + 4 + size].partition(b"=")
        position += 4 + size
        if not equals or position > len(data):
            return None
        header[name] = value
    return header


def record_at(data: Bytes, position: int) -> Record | None:
    """The record at `position`; None where there is none."""
    size = number(data[position : position + 4])
    begin = position + 8 + size
    if size > LONGEST_HEADER or begin > len(data):
        return None
    header = fields(data[position + 4 : position + 4 + size])
    if header is None or len(header.get(b"op", b"")) != 1:
        return None
    return Record(header, begin, begin + number(data[begin - 4 : begin]))


def next_record(data: Bytes, position: int) -> int:
    """The first place from `position` on at which a believable record begins; -1 if none does."""
    start = position
    while found := _OPERATION.search(data, position):
        # The other fields of the header may stand before the operation.
        for place in range(found.start() - 4, max(start, found.start() - 4 - 512) - 1, -1):
            record = record_at(data, place)
            if record and record.begin - 4 >= found.end() and _follows(data, record):
                return place
        position = found.start() + 1
    return -1


def _follows(data: Bytes, record: Record) -> bool:
    """Whether the record ends where the data do, or another begins there, or it is the last."""
    if not MESSAGE <= record.kind <= CONNECTION:
        return False
    if record.end >= len(data):
        return record.end == len(data) or record.kind == CHUNK
    return record_at(data, record.end) is not None

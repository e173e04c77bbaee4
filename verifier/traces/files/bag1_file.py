"""ROS 1 bags, format 2.0, record by record: a bag without its index gives its messages too.

A record is a header of `name=value` fields and a body, each with its length before it.
http://wiki.ros.org/Bags/Format/2.0
"""

import bz2
import mmap
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import TypeAlias

import lz4.frame

from verifier.traces.files.log import MessageLog, Progress, Wanted
from verifier.traces.files.streams import Gathering
from verifier.traces.messages.channel import Channel

MAGIC = b"#ROSBAG V2.0\n"
LARGEST_CHUNK = 1 << 31

_MESSAGE, _BAG, _CHUNK, _CONNECTION = 2, 3, 5, 7

Header: TypeAlias = dict[bytes, bytes]


def is_bag1(head: bytes) -> bool:
    """Whether a file that begins with `head` is a ROS 1 bag."""
    return head.startswith(b"#ROSBAG V")


def read_bag1(path: Path, wanted: Wanted, tell: Progress) -> MessageLog:
    """All that can be read of the bag, and what could not; raises OSError."""
    gathering: Gathering[int] = Gathering(wanted)
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        if data[: len(MAGIC)] != MAGIC:
            gathering.lose("bag version", f"{bytes(data[:12])!r} is read as version 2.0")
        _read_file(data, gathering)
    return gathering.finished(str(path), "ROS 1 bag")


def _read_file(data: mmap.mmap, gathering: Gathering[int]) -> None:
    end = start = data.find(b"\n") + 1
    for header, begin, end in _records(data, start):
        body = data[begin : min(end, len(data))]
        kind = _number(header.get(b"op", b""))
        if kind == _CHUNK:
            _read_chunk(header, body, begin, end - begin, gathering)
        elif end <= len(data):
            _read_record(kind, header, body, gathering)
    if end > len(data):
        gathering.lose("file cut", f"it ends at byte {len(data)}, in the middle of a record")
    elif end < len(data):
        gathering.lose("file cut or overwritten", f"nothing readable from byte {end} on")


def _records(data: mmap.mmap | bytes, position: int) -> Iterator[tuple[Header, int, int]]:
    """Header, begin and end of the body of each record; the last may end beyond the data."""
    while position + 4 <= len(data):
        size = _number(data[position : position + 4])
        fields = data[position + 4 : position + 4 + size]
        if len(fields) < size or position + 8 + size > len(data):
            return
        header = _fields(fields)
        begin = position + 8 + size
        if header is None:
            return
        position = begin + _number(data[begin - 4 : begin])
        yield header, begin, position


def _fields(data: bytes) -> Header | None:
    """The fields of a header; None where the bytes are not one."""
    header: Header = {}
    position = 0
    while position < len(data):
        size = _number(data[position : position + 4])
        name, equals, value = data[position + 4 : position + 4 + size].partition(b"=")
        position += 4 + size
        if not equals or position > len(data):
            return None
        header[name] = value
    return header


def _read_chunk(
    header: Header, body: bytes, place: int, claimed: int, gathering: Gathering[int]
) -> None:
    torn = len(body) < claimed
    try:
        inside = _inside(header, body, torn=torn)
    except (ValueError, OSError, EOFError, RuntimeError, MemoryError) as error:
        gathering.lose("corrupt chunk", f"at byte {place}: {error}")
        return
    if torn:
        gathering.lose("torn chunk", f"at byte {place}: {len(body)} of {claimed} bytes")
    position = 0
    for fields, begin, end in _records(inside, 0):
        position = end
        if end <= len(inside):
            _read_record(_number(fields.get(b"op", b"")), fields, inside[begin:end], gathering)
    if position != len(inside) and not torn:
        gathering.lose("corrupt chunk", f"at byte {place}: unreadable from its byte {position} on")


def _inside(header: Header, body: bytes, *, torn: bool) -> bytes:
    """The chunk's records, decompressed; of a torn chunk what can be had."""
    compression = header.get(b"compression", b"none")
    size = _number(header.get(b"size", b""))
    if size > LARGEST_CHUNK:
        raise ValueError(f"it claims {size} bytes")
    if compression == b"none":
        return body
    if compression == b"bz2":
        inside = bz2.BZ2Decompressor().decompress(body, max_length=size)
    elif compression == b"lz4":
        inside = bytes(lz4.frame.LZ4FrameDecompressor().decompress(body, max_length=size))
    else:
        raise ValueError(f"compression {compression.decode(errors='replace')!r} is not supported")
    if len(inside) < size and not torn:
        raise ValueError(f"{size} bytes expected, {len(inside)} decompressed")
    return inside


def _read_record(kind: int, header: Header, body: bytes, gathering: Gathering[int]) -> None:
    if kind == _CONNECTION:
        about = _fields(body) or {}
        topic = header.get(b"topic", about.get(b"topic", b"")).decode(errors="replace")
        channel = Channel(
            topic=topic,
            message_type=about.get(b"type", b"").decode(errors="replace"),
            encoding="ros1",
            schema_encoding="ros1msg",
            schema=about.get(b"message_definition", b""),
        )
        gathering.declare(_number(header.get(b"conn", b"")), channel)
    elif kind == _MESSAGE and len(header.get(b"time", b"")) == 8:
        seconds, nanoseconds = struct.unpack("<II", header[b"time"])
        log_time = seconds * 1_000_000_000 + nanoseconds
        gathering.add(_number(header.get(b"conn", b"")), log_time, body, 0, len(body))


def _number(data: bytes) -> int:
    return int.from_bytes(data[:4], "little")

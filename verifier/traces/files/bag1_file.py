"""ROS 1 bags, format 2.0, record by record: a bag without its index gives its messages too.

http://wiki.ros.org/Bags/Format/2.0
"""

import mmap
import struct
from dataclasses import replace
from pathlib import Path

from verifier.traces.files.bag1_records import (
    CHUNK,
    CONNECTION,
    MESSAGE,
    Bytes,
    Record,
    fields,
    next_record,
    number,
    record_at,
)
from verifier.traces.files.log import MessageLog, Progress, Wanted
from verifier.traces.files.streams import Gathering
from verifier.traces.files.unpacking import UnpackError, check_packed, unpack, unpack_torn
from verifier.traces.messages.channel import Channel

MAGIC = b"#ROSBAG V2.0\n"


def is_bag1(head: bytes) -> bool:
    """Whether a file that begins with `head` is a ROS 1 bag."""
    return head.startswith(b"#ROSBAG V")


def read_bag1(path: Path, wanted: Wanted, tell: Progress) -> MessageLog:
    """All that can be read of the bag, and what could not; raises OSError."""
    gathering: Gathering[int] = Gathering(wanted)
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        if data[: len(MAGIC)] != MAGIC:
            gathering.lose("bag version", f"{bytes(data[:12])!r} is read as version 2.0")
        _read_file(data, gathering, tell)
    return gathering.finished(str(path), "ROS 1 bag")


def _read_file(data: mmap.mmap, gathering: Gathering[int], tell: Progress) -> None:
    position = data.find(b"\n") + 1
    size = len(data)
    while position < size:
        record = record_at(data, position)
        if record is None or (record.end > size and record.kind != CHUNK):
            position = _skip(data, position, gathering)
            continue
        position = record.end
        if record.kind == CHUNK:
            position = _end(data, record)
            if position != record.end:
                detail = f"the length of the chunk at byte {record.begin} is wrong"
                gathering.lose("damaged record", detail)
            _read_chunk(data, replace(record, end=position), gathering)
        else:
            _read_record(record, data, gathering)
        tell(min(position, size), size)
    if position > size:
        gathering.lose("file cut", f"it ends at byte {size}, in the middle of a record")


def _end(data: Bytes, chunk: Record) -> int:
    """Where the chunk ends: where its length says, or else where another record begins."""
    if chunk.end == len(data) or record_at(data, chunk.end):
        return chunk.end
    if chunk.header.get(b"compression", b"none") != b"none":
        found = next_record(data, chunk.begin)
        return found if found >= 0 else chunk.end
    unpacked = chunk.begin + number(chunk.header.get(b"size", b""))
    return unpacked if unpacked < len(data) and record_at(data, unpacked) else chunk.end


def _skip(data: Bytes, start: int, gathering: Gathering[int]) -> int:
    """The place of the next believable record; the bytes between are counted."""
    found = next_record(data, start + 1)
    if found < 0:
        detail = f"nothing readable from byte {start} on"
        gathering.lose("file cut or overwritten", detail)
        return len(data)
    detail = f"skipped from byte {start} to {found}"
    gathering.lose("damaged bytes", detail, found - start)
    return found


def _read_chunk(data: Bytes, chunk: Record, gathering: Gathering[int]) -> None:
    """The messages of one chunk; of a damaged one, those before the damage."""
    compression = chunk.header.get(b"compression", b"none").decode(errors="replace")
    compression = "" if compression == "none" else compression
    claimed = number(chunk.header.get(b"size", b""))
    torn = chunk.end > len(data)
    place = f"at byte {chunk.begin}"
    before = gathering.count
    try:
        check_packed(min(chunk.end, len(data)) - chunk.begin)
        body = data[chunk.begin : chunk.end]
        inside, fault = _unpacked(compression, body, claimed, torn=torn)
    except UnpackError as error:
        gathering.lose("corrupt chunk", f"{place}: {error}")
        return
    read = _walk(inside, gathering)
    if torn:
        whole = chunk.end - chunk.begin
        gathering.lose("torn chunk", f"{place}: {len(body)} of {whole} bytes")
    elif fault or read != len(inside):
        fault = fault or f"unreadable from its byte {read} on"
        gathering.lose("corrupt chunk", f"{place}: {fault}")
    elif len(inside) != claimed:
        gathering.lose("corrupt chunk", f"{place}: {claimed} bytes expected, found {len(inside)}")
    else:
        return
    if (compression or not torn) and (found := gathering.count - before):
        gathering.lose("unverified messages", f"read of the damaged chunk {place}", found)


def _unpacked(compression: str, body: bytes, size: int, *, torn: bool) -> tuple[bytes, str]:
    """What can be had of the chunk, and what was wrong with it; raises UnpackError."""
    if torn:
        return unpack_torn(compression, body, size), ""
    try:
        return unpack(compression, body, size), ""
    except UnpackError as error:
        return unpack_torn(compression, body, size), str(error)


def _walk(inside: bytes, gathering: Gathering[int]) -> int:
    """Reads the records of a chunk; returns where the last whole one ends."""
    position = 0
    while position < len(inside):
        record = record_at(inside, position)
        if record is None or record.end > len(inside):
            break
        _read_record(record, inside, gathering)
        position = record.end
    return position


def _read_record(record: Record, data: Bytes, gathering: Gathering[int]) -> None:
    header = record.header
    if record.kind == CONNECTION:
        about = fields(data[record.begin : record.end]) or {}
        topic = header.get(b"topic", about.get(b"topic", b"")).decode(errors="replace")
        channel = Channel(
            topic=topic,
            message_type=about.get(b"type", b"").decode(errors="replace"),
            encoding="ros1",
            schema_encoding="ros1msg",
            schema=about.get(b"message_definition", b""),
        )
        gathering.declare(number(header.get(b"conn", b"")), channel)
    elif record.kind == MESSAGE and len(header.get(b"time", b"")) == 8:
        seconds, nanoseconds = struct.unpack("<II", header[b"time"])
        log_time = seconds * 1_000_000_000 + nanoseconds
        key = number(header.get(b"conn", b""))
        gathering.add(key, log_time, data, record.begin, record.end)
    elif record.kind == MESSAGE:
        gathering.lose("corrupt record", "a message without a time")

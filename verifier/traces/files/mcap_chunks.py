"""Chunks of MCAP files: unpacked, compared with their checksums, and walked."""

import zlib

from mcap.opcode import Opcode
from mcap.records import Channel, Schema

from verifier.traces.files.mcap_reading import Reading
from verifier.traces.files.mcap_records import HEAD, MESSAGE, Bytes, ChunkHead, parse
from verifier.traces.files.streams import Run
from verifier.traces.files.unpacking import UnpackError, check_packed, unpack, unpack_torn

_MOST_UNTAKEN = 1 << 24
"""Bytes of messages that are copied out of a chunk before they are handed on."""


def read_chunk(data: Bytes, head: ChunkHead, reading: Reading) -> None:
    """The messages of one chunk; of a torn one, those before the tear."""
    reading.chunked = True
    torn = head.end > len(data)
    try:
        check_packed(min(head.end, len(data)) - head.begin)
        body = bytes(data[head.begin : head.end])
        unpacked = (unpack_torn if torn else unpack)(head.compression, body, head.size)
    except UnpackError as error:
        reading.gathering.lose("corrupt chunk", f"at byte {head.begin}: {error}")
        return
    if torn:
        _read_torn(unpacked, len(body), head, reading)
    elif head.crc and zlib.crc32(unpacked) != head.crc:
        reading.gathering.lose("corrupt chunk", f"at byte {head.begin}: its checksum is wrong")
    else:
        if not head.crc:
            reading.gathering.notes.append("chunks carry no checksum: damage in them may go unseen")
        read = _walk(unpacked, head.begin, reading, sure=head.crc != 0)
        if read != len(unpacked) or len(unpacked) != head.size:
            detail = f"at byte {head.begin}: unreadable from its byte {read} on"
            reading.gathering.lose("corrupt chunk", detail)


def _read_torn(unpacked: bytes, size: int, head: ChunkHead, reading: Reading) -> None:
    before = reading.gathering.count
    _walk(unpacked, head.begin, reading, sure=False)
    whole = head.end - head.begin
    detail = f"at byte {head.begin}: {size} of {whole} bytes; no checksum to compare"
    reading.gathering.lose("torn chunk", detail)
    if found := reading.gathering.count - before:
        reading.gathering.lose(
            "unverified messages", f"read of the torn chunk at {head.begin}", found
        )


def _walk(inside: bytes, place: int, reading: Reading, *, sure: bool) -> int:
    """Reads the records; returns where the last whole one ends."""
    position, size = 0, len(inside)
    head, message = HEAD.unpack_from, MESSAGE.unpack_from
    gathering = reading.gathering
    runs: dict[int, Run] = {}
    taken = 0
    while position + 9 <= size:
        opcode, length = head(inside, position)
        begin = position + 9
        end = begin + length
        if end > size or opcode == 0:
            break
        if begin - taken > _MOST_UNTAKEN:
            gathering.take(runs)
            runs, taken = {}, position
        if opcode == 5 and length >= 22:
            channel, _, log_time, _ = message(inside, begin)
            run = runs.get(channel)
            if run is None:
                run = runs[channel] = gathering.run(channel)
            gathering.count += 1
            run.times.append(log_time)
            if run.wanted:
                run.places.append(gathering.count)
                run.payloads.append(inside[begin + 22 : end])
        else:
            # What is declared from here on holds for what follows only.
            gathering.take(runs)
            runs = {}
            _other(opcode, inside[begin:end], place, reading, sure=sure)
        position = end
    gathering.take(runs)
    return position


def _other(opcode: int, body: bytes, place: int, reading: Reading, *, sure: bool) -> None:
    if opcode == Opcode.SCHEMA:
        reading.add_schema(parse(Schema, body), place, sure=sure)
    elif opcode == Opcode.CHANNEL:
        reading.add_channel(parse(Channel, body), place, sure=sure)
    elif opcode == Opcode.MESSAGE:
        reading.gathering.lose("corrupt record", f"a message of {len(body)} bytes")
    elif opcode == Opcode.CHUNK:
        reading.gathering.lose("nested chunk", f"in the chunk at byte {place}; not read")
    elif opcode < 0x80:
        reading.gathering.lose("corrupt record", f"opcode {opcode} in the chunk at byte {place}")

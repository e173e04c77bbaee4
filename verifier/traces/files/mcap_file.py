"""MCAP files: records walked one by one, checksums compared, what is torn counted.

The index at the end is not trusted: a file that was cut, or whose index lies, gives all the
chunks that are whole. After damage the walk goes on at the next believable record.
https://mcap.dev/spec
"""

import mmap
import zlib
from pathlib import Path
from typing import final

from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Schema, Statistics

from verifier.traces.files.log import MessageLog, Progress, Wanted
from verifier.traces.files.mcap_chunks import read_chunk
from verifier.traces.files.mcap_reading import Reading
from verifier.traces.files.mcap_records import (
    COMPRESSIONS,
    FIXED,
    HEAD,
    KNOWN,
    MAGIC,
    MESSAGE,
    chunk_head,
    follows,
    is_filled,
    next_record,
    parse,
)
from verifier.traces.files.mcap_summary import read_summary

_PIECE = 1 << 24
_PRIVATE = 0x80
"""From here on opcodes are for whoever wants them."""


def is_mcap(head: bytes) -> bool:
    """Whether a file that begins with `head` is an MCAP file."""
    return head.startswith(MAGIC)


def read_mcap(path: Path, wanted: Wanted, tell: Progress) -> MessageLog:
    """All that can be read of the file, and what could not; raises OSError."""
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        reading = Reading(wanted)
        read_summary(data, reading)
        _Walk(data, reading, tell).run()
        return reading.finished(str(path))


def find_attachments(path: Path, suffix: str) -> list[tuple[str, bytes]]:
    """Names and bytes of attachments whose names end in `suffix`, in order; raises OSError.

    Only heads of records are read on the way, no message. One whose checksum is wrong is not
    returned.
    """
    bodies = _attachment_bodies(path)
    found = [each for each in map(_attachment, bodies) if each is not None]
    return [(each.name, each.data) for each in found if each.name.endswith(suffix)]


def find_damaged_attachments(path: Path) -> list[str]:
    """The names of attachments whose checksum is wrong, as far as they can be read."""
    return [_name_in(body) for body in _attachment_bodies(path) if _attachment(body) is None]


def _attachment_bodies(path: Path) -> list[bytes]:
    bodies = []
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        position = len(MAGIC)
        while position + HEAD.size <= len(data):
            opcode, length = HEAD.unpack_from(data, position)
            begin = position + HEAD.size
            position = begin + length
            if opcode == Opcode.ATTACHMENT and position <= len(data):
                bodies.append(data[begin:position])
    return bodies


def _name_in(body: bytes) -> str:
    """The name that stands behind two times of 8 bytes, after its length."""
    size = int.from_bytes(body[16:20], "little")
    return body[20 : 20 + size].decode("utf-8", "replace")


@final
class _Walk:
    """A position in a file, moved from record to record."""

    def __init__(self, data: mmap.mmap, reading: Reading, tell: Progress) -> None:
        self.data = data
        self.reading = reading
        self.tell = tell
        self.position = len(MAGIC)
        self.loose = 0
        self.damaged = False
        self.ended = False

    def run(self) -> None:
        """Reads the file to its end."""
        size = len(self.data)
        gathering = self.reading.gathering
        if self.data[: len(MAGIC)] != MAGIC:
            gathering.lose("file head damaged", "it does not begin as an MCAP file")
            self.position = 0
            self._resync()
        while not self.ended and self.position + HEAD.size <= size:
            if not self._step():
                self._resync()
            self.tell(min(self.position, size), size)
        if not self.ended:
            gathering.lose("file cut", f"it ends at byte {size} without a footer")
            self.damaged = True
        if self.damaged and self.loose:
            detail = "read outside chunks of a damaged file"
            gathering.lose("unverified messages", detail, self.loose)

    def _step(self) -> bool:
        """Reads the record here and moves behind it; False where there is none."""
        opcode, length = HEAD.unpack_from(self.data, self.position)
        begin = self.position + HEAD.size
        end = begin + length
        if opcode == Opcode.CHUNK:
            return self._chunk(begin, end)
        if opcode not in KNOWN and self._disguised(begin, end):
            return True
        if end > len(self.data) or not self._believable(opcode, begin, end):
            return self._disguised(begin, end)
        self.position = end
        if opcode == Opcode.MESSAGE:
            self.loose += 1
            channel, _, log_time, _ = MESSAGE.unpack_from(self.data, begin)
            self.reading.gathering.add(channel, log_time, self.data, begin + MESSAGE.size, end)
        elif opcode == Opcode.FOOTER:
            self._end(end)
        else:
            self._other(opcode, begin, end)
        return True

    def _believable(self, opcode: int, begin: int, end: int) -> bool:
        """Whether the record can be taken for one. A wrong length leads into other bytes."""
        if opcode == Opcode.MESSAGE:
            return end - begin >= MESSAGE.size and follows(self.data, end)
        if opcode in FIXED:
            return end - begin == FIXED[opcode]
        return is_filled(self.data, opcode, begin, end, unknown=follows(self.data, end))

    def _disguised(self, begin: int, end: int) -> bool:
        """Reads a chunk whose opcode was damaged, but nothing else; False where this is none."""
        head = chunk_head(self.data, begin, end)
        if head is None or head.end != end or end > len(self.data):
            return False
        if not head.crc or head.compression not in COMPRESSIONS:
            return False
        self.reading.gathering.lose("damaged record", f"the opcode of the chunk at byte {begin}")
        return self._chunk(begin, end)

    def _chunk(self, begin: int, claimed: int) -> bool:
        head = chunk_head(self.data, begin, claimed)
        if head is None:
            return False
        if head.end != claimed:
            detail = f"the length of the chunk at byte {begin} is wrong, but stands in it again"
            self.reading.gathering.lose("damaged record", detail)
        self.reading.chunks.discard(begin - HEAD.size)
        read_chunk(self.data, head, self.reading)
        self.position = head.end
        return True

    def _other(self, opcode: int, begin: int, end: int) -> None:
        reading, body = self.reading, self.data[begin:end]
        if opcode == Opcode.SCHEMA:
            reading.add_schema(parse(Schema, body), begin, sure=False)
        elif opcode == Opcode.CHANNEL:
            reading.add_channel(parse(Channel, body), begin, sure=False)
        elif opcode == Opcode.ATTACHMENT:
            if _attachment(body) is None:
                reading.gathering.lose("corrupt attachment", f"at byte {begin}")
        elif opcode == Opcode.STATISTICS:
            if statistics := parse(Statistics, body):
                reading.promised = statistics.message_count
        elif opcode == Opcode.DATA_END:
            reading.in_summary = True
            self._check_data(begin)
        elif opcode not in KNOWN and opcode < _PRIVATE:
            detail = f"of kind {opcode}, at byte {begin}; not read"
            reading.gathering.lose("unknown record", detail)

    def _check_data(self, begin: int) -> None:
        """Records outside chunks have no checksum of their own but that of the whole section."""
        expected = int.from_bytes(self.data[begin : begin + 4], "little")
        if not expected:
            if self.loose:
                self.reading.gathering.notes.append(
                    "messages carry no checksum: damage in them may go unseen"
                )
            return
        found = 0
        for start in range(0, begin - HEAD.size, _PIECE):
            found = zlib.crc32(self.data[start : min(start + _PIECE, begin - HEAD.size)], found)
        if found != expected:
            detail = "of the data section: what stands outside its chunks may be corrupt"
            self.reading.gathering.lose("checksum wrong", detail)

    def _end(self, end: int) -> None:
        """After a footer: the closing bytes, and perhaps another file that was put behind it."""
        rest = len(self.data) - end
        gathering = self.reading.gathering
        self.ended = True
        if self.data[end : end + len(MAGIC)] != MAGIC:
            closing = min(rest, len(MAGIC))
            gathering.lose("file end torn", f"{len(MAGIC)} closing bytes expected, found {closing}")
            return
        more = end + len(MAGIC)
        extra = len(self.data) - more
        if self.data[more : more + len(MAGIC)] == MAGIC:
            gathering.notes.append("several MCAP files stand one behind the other; all are read")
            self.reading.begin_anew()
            self.position = more + len(MAGIC)
            self.ended = False
        elif extra:
            gathering.lose("trailing bytes", "after the end of the log; not read", extra)

    def _resync(self) -> None:
        """Moves to the next believable record, and counts the bytes between."""
        self.damaged = True
        start, size = self.position, len(self.data)
        found = next_record(self.data, start, loose=self.loose > 0 or not self.reading.chunked)
        gathering = self.reading.gathering
        if found < 0:
            gathering.lose("file cut or overwritten", f"nothing readable from byte {start} on")
            self.position = size
            self.ended = True
            return
        gathering.lose("damaged bytes", f"skipped from byte {start} to {found}", found - start)
        self.position = found


def _attachment(body: bytes) -> Attachment | None:
    """The attachment, if its checksum fits or it has none."""
    expected = int.from_bytes(body[-4:], "little")
    if expected and zlib.crc32(body[:-4]) != expected:
        return None
    return parse(Attachment, body)

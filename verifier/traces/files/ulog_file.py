"""ULog, PX4's log: messages of fixed layouts behind one another, each with its size.

https://docs.px4.io/main/en/dev_log/ulog_file_format.html
"""

import mmap
import struct
from pathlib import Path
from typing import Final, final

from verifier.traces.files.log import MessageLog, Progress, Wanted
from verifier.traces.files.streams import Gathering
from verifier.traces.messages.channel import Channel

MAGIC = b"ULog\x01\x12\x35"
SYNC = b"\x2f\x73\x13\x20\x25\x0c\xbb\x12"

MOST_FORMATS: Final = 1 << 27
"""Bytes of formats that all subscriptions of a file are given, at most; PX4's own take 2e7."""

_HEAD = struct.Struct("<HB")
_FIRST = 16
_KINDS = frozenset(b"BFIMPQADRLCSO")
_TELL_EVERY = 1 << 12


def is_ulog(head: bytes) -> bool:
    """Whether a file that begins with `head` is a ULog file."""
    return head.startswith(MAGIC)


def read_ulog(path: Path, wanted: Wanted, tell: Progress) -> MessageLog:
    """All that can be read of the log, and what could not; raises OSError."""
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        walk = _Walk(data, Gathering(wanted))
        walk.run(tell)
    return walk.gathering.finished(str(path), "ULog")


@final
class _Walk:
    """A position in a log, moved from message to message."""

    def __init__(self, data: mmap.mmap, gathering: Gathering[int]) -> None:
        self.data = data
        self.gathering = gathering
        self.formats: list[bytes] = []
        self.schema: bytes | None = None
        self.formats_bytes = 0
        self.room = MOST_FORMATS
        self.appended: list[int] = []
        self.lengths: dict[bytes, int] = {}
        self.position = _FIRST

    def run(self, tell: Progress) -> None:
        """Reads the log to its end."""
        size = len(self.data)
        steps = 0
        while self.position + _HEAD.size <= size:
            length, kind = _HEAD.unpack_from(self.data, self.position)
            begin = self.position + _HEAD.size
            end = begin + length
            jump = next((at for at in self.appended if self.position < at < end), None)
            if jump is not None:
                self.position = jump
            elif kind not in _KINDS or not (self._follows(end) or self._usual(kind, begin, end)):
                self._resync()
            else:
                self._read(kind, begin, end)
                self.position = end
            steps += 1
            if steps % _TELL_EVERY == 0:
                tell(min(self.position, size), size)
        if self.position != size:
            detail = f"it ends at byte {size}, in the middle of a message"
            self.gathering.lose("file cut", detail)

    def _follows(self, position: int) -> bool:
        """Whether a message can begin at `position`, or the log end there."""
        if position + _HEAD.size > len(self.data):
            return position <= len(self.data)
        _, kind = _HEAD.unpack_from(self.data, position)
        return kind in _KINDS or position in self.appended

    def _usual(self, kind: int, begin: int, end: int) -> bool:
        """Whether this is data, as long as the data of its channel before."""
        key = self.data[begin : begin + 2]
        return kind == ord("D") and end <= len(self.data) and self.lengths.get(key) == end - begin

    def _read(self, kind: int, begin: int, end: int) -> None:
        data, gathering = self.data, self.gathering
        if kind == ord("D") and end - begin >= 10:
            key, microseconds = struct.unpack_from("<HQ", data, begin)
            gathering.add(key, microseconds * 1000, data, begin + 2, end)
            self.lengths[data[begin : begin + 2]] = end - begin
        elif kind == ord("F"):
            self.formats.append(data[begin:end])
            self.schema = None
            self.formats_bytes += end - begin + 1
        elif kind == ord("A") and end - begin >= 4:
            instance, key = struct.unpack_from("<BH", data, begin)
            self._subscribe(key, instance, data[begin + 3 : end])
        elif kind == ord("O") and end - begin >= 2:
            milliseconds = int.from_bytes(data[begin : begin + 2], "little")
            gathering.lose("dropouts of the logger", "in milliseconds", milliseconds)
        elif kind == ord("B") and end - begin >= 40 and data[begin + 8] & 1:
            self.appended = [at for at in struct.unpack_from("<3Q", data, begin + 16) if at]
        elif kind in b"DAOB":
            gathering.lose("corrupt record", f"a message {chr(kind)} of {end - begin} bytes")

    def _subscribe(self, key: int, instance: int, raw: bytes) -> None:
        name = raw.decode("utf-8", errors="replace")
        self.gathering.declare(
            key,
            Channel(
                topic=f"{name}/{instance}" if instance else name,
                message_type=name,
                encoding="ulog",
                schema_encoding="ulog",
                schema=self._known_formats(),
            ),
        )

    def _known_formats(self) -> bytes:
        """All formats so far, for one subscription; none where they take too much together."""
        self.room -= self.formats_bytes
        if self.room < 0:
            detail = f"of subscriptions after the first {MOST_FORMATS} bytes of formats"
            self.gathering.lose("formats left out", detail)
            return b""
        if self.schema is None:
            # Joined once for all that subscribe after it: thousands of channels share these bytes.
            self.schema = b"\n".join(self.formats)
        return self.schema

    def _resync(self) -> None:
        """Moves behind the next mark that the logger sets for this, or to the end."""
        start, size = self.position, len(self.data)
        found = self.data.find(SYNC, start)
        if found < 0:
            detail = f"nothing readable from byte {start} on"
            self.gathering.lose("file cut or overwritten", detail)
            self.position = size
            return
        self.position = found + len(SYNC)
        detail = f"skipped from byte {start} to {self.position}"
        self.gathering.lose("damaged bytes", detail, self.position - start)

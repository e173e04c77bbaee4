"""Logs that were packed as a whole (`.gz`, `.zst`, `.bz2`, `.xz`, `.lz4`): unpacked beside."""

import bz2
import gzip
import lzma
import shutil
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import BinaryIO, Final, Protocol, TypeAlias, final

import lz4.frame
import zstandard

from spec_schema.diagnostics import SpecError
from verifier.traces.faults import file_fault
from verifier.traces.files.unpacking import MOST_TIMES

LARGEST_FILE: Final = 1 << 37
"""Bytes. What unpacks to more is taken for a trap, as is what grows `MOST_TIMES`, ..."""

BELIEVED_OF_FILES: Final = 1 << 28
"""... but not below so many bytes."""

KEPT_FREE: Final = 0.1
"""Share of a disk's free bytes that is left to others."""

ELSEWHERE: Final = "set TMPDIR to a folder on a larger disk, or unpack the log yourself"

_PIECE = 1 << 16
_FAULTS = (
    OSError, EOFError, MemoryError, RuntimeError, ValueError,
    lzma.LZMAError, zlib.error, zstandard.ZstdError,
)  # fmt: skip


class _Readable(Protocol):
    def read1(self, size: int, /) -> bytes: ...


Opener: TypeAlias = Callable[[BinaryIO], _Readable]


def _zstd(file: BinaryIO) -> _Readable:
    return zstandard.ZstdDecompressor().stream_reader(file, read_across_frames=True)


_OPENERS: dict[bytes, Opener] = {
    b"\x1f\x8b": lambda file: gzip.GzipFile(fileobj=file),
    b"\x28\xb5\x2f\xfd": _zstd,
    b"BZh": bz2.BZ2File,
    b"\xfd7zXZ\0": lzma.LZMAFile,
    b"\x04\x22\x4d\x18": lz4.frame.LZ4FrameFile,
}


def is_packed(head: bytes) -> bool:
    """Whether a file that begins with `head` is packed in a way that can be undone."""
    return any(head.startswith(magic) for magic in _OPENERS)


def unpack_file(path: Path, target: Path) -> str:
    """Unpacks as much as can be had into `target`; what stopped it early, or an empty text.

    `target` stands in a folder of its own, in the system's temporary one.

    Raises:
        SpecError: the folder of `target` has no room for it (V301).
    """
    with path.open("rb") as file:
        head = file.read(8)
        magic = next(magic for magic in _OPENERS if head.startswith(magic))
        file.seek(0)
        pieces = _Pieces(_OPENERS[magic](file))
        most = min(LARGEST_FILE, max(BELIEVED_OF_FILES, MOST_TIMES * path.stat().st_size))
        room = min(most, _room(target.parent))
        done = 0
        try:
            with target.open("wb") as out:
                for piece in pieces:
                    done += len(piece)
                    if done > room:
                        break
                    out.write(piece)
        except OSError as error:
            raise _no_room(path, target.parent, done, reason(error)) from error
    if done <= room:
        return pieces.fault
    if room < most:
        raise _no_room(path, target.parent, room, "more is not free there")
    return f"it unpacks to more than {most} bytes, as a trap does; the rest is left"


@final
class _Pieces:
    """What is inside, piece by piece, until its end or until a `fault` stops it."""

    def __init__(self, reader: _Readable) -> None:
        self._reader = reader
        self.fault = ""

    def __iter__(self) -> Iterator[bytes]:
        """The pieces; none is empty."""
        try:
            # What `read` has gathered when it meets the damage is lost; `read1` gathers nothing.
            while piece := self._reader.read1(_PIECE):
                yield piece
        except _FAULTS as error:
            self.fault = str(error) or type(error).__name__


def reason(error: OSError) -> str:
    """What the system says of it."""
    return (error.strerror or str(error)).lower()


def _room(folder: Path) -> int:
    """Bytes that may be written into the folder; a share of what is free stays free."""
    return int((1.0 - KEPT_FREE) * shutil.disk_usage(folder).free)


def _no_room(path: Path, folder: Path, size: int, why: str) -> SpecError:
    message = (
        f"it unpacks to more than {size / 1e6:.0f} MB, which {folder.parent} can't hold: {why}"
    )
    return file_fault(path, "V301", message, ELSEWHERE)

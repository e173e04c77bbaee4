"""Logs that were packed as a whole (`.gz`, `.zst`, `.bz2`, `.xz`, `.lz4`): unpacked beside."""

import bz2
import gzip
import lzma
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import BinaryIO, Protocol, TypeAlias

import lz4.frame
import zstandard

LARGEST = 1 << 37
"""Bytes. What unpacks to more is taken for a trap."""

_PIECE = 1 << 20
_FAULTS = (OSError, EOFError, lzma.LZMAError, zstandard.ZstdError, RuntimeError, ValueError)


class _Readable(Protocol):
    def read(self, size: int, /) -> bytes: ...


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
    """Unpacks as much as can be had into `target`; what stopped it early, or an empty text."""
    with ExitStack() as stack:
        file = stack.enter_context(path.open("rb"))
        head = file.read(8)
        magic = next(magic for magic in _OPENERS if head.startswith(magic))
        file.seek(0)
        out = stack.enter_context(target.open("wb"))
        reader = _OPENERS[magic](file)
        done = 0
        while done < LARGEST:
            try:
                piece = reader.read(_PIECE)
            except _FAULTS as error:
                return str(error) or type(error).__name__
            if not piece:
                return ""
            out.write(piece)
            done += len(piece)
    return f"it unpacks to more than {LARGEST} bytes"

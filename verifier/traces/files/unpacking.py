"""Compressed blocks of bytes: whole ones at once, torn ones as far as they go."""

import bz2
import io
from collections.abc import Callable
from typing import Final, Protocol, TypeAlias, final

import lz4.frame
import zstandard

LARGEST_BLOCK: Final = 1 << 29
"""Bytes. Blocks that are larger, packed or not, are not read: recorders make them of a few MB."""

MOST_TIMES: Final = 1000
"""What unpacks to more than so many times its size is taken for a trap, ..."""

BELIEVED_OF_BLOCKS: Final = 1 << 26
"""... but not below so many bytes: camera images may be black for hours."""

PIECE = 1 << 14
_ZSTD_PIECE = 1 << 17
_FAULTS = (zstandard.ZstdError, RuntimeError, OSError, EOFError, ValueError, MemoryError)

Unpack: TypeAlias = Callable[[bytes, int], bytes]


@final
class UnpackError(Exception):
    """A block that can't be unpacked; the message says why."""


class _Decompressor(Protocol):
    @property
    def needs_input(self) -> bool: ...

    def decompress(self, data: bytes, max_length: int) -> bytes: ...


def most_unpacked(packed: int) -> int:
    """Bytes that `packed` ones may unpack to."""
    return min(LARGEST_BLOCK, max(BELIEVED_OF_BLOCKS, MOST_TIMES * packed))


def check_packed(size: int) -> None:
    """Refuses a block that is too large to be copied out of a file; raises UnpackError."""
    if size > LARGEST_BLOCK:
        raise UnpackError(f"it is {size} bytes long, blocks of up to {LARGEST_BLOCK} are read")


def unpack(compression: str, data: bytes, size: int) -> bytes:
    """The block's `size` bytes, or fewer or other ones where it is damaged; raises UnpackError."""
    return _bounded(_WHOLE, compression, data, size)


def unpack_torn(compression: str, data: bytes, size: int) -> bytes:
    """What can be had of a block that was cut or damaged, from its start; raises UnpackError."""
    return _bounded(_TORN, compression, data, size)


def unpack_zstd(data: bytes) -> bytes:
    """A zstd frame that says its size itself, or doesn't; raises UnpackError."""
    most = most_unpacked(len(data))
    try:
        size = zstandard.frame_content_size(data)
        if size > most:
            raise UnpackError(_trap(len(data)))
        if size >= 0:
            return zstandard.ZstdDecompressor().decompress(data)
        with zstandard.ZstdDecompressor().stream_reader(io.BytesIO(data)) as reader:
            unpacked = reader.read(most + 1)
    except _FAULTS as error:
        raise UnpackError(str(error)) from error
    if len(unpacked) > most:
        raise UnpackError(_trap(len(data)))
    return unpacked


def _trap(packed: int) -> str:
    return f"its {packed} bytes unpack to more than {most_unpacked(packed)}, as a trap does"


def _bounded(known: dict[str, Unpack], compression: str, data: bytes, size: int) -> bytes:
    """No more than may be; a claim of more is damage where there is less, and else a trap."""
    if not compression:
        return data
    most = most_unpacked(len(data))
    try:
        unpacked = _kind(compression, known)(data, min(size, most))
    except _FAULTS as error:
        raise UnpackError(str(error)) from error
    if size > most and len(unpacked) >= most:
        raise UnpackError(_trap(len(data)))
    return unpacked


def _kind(compression: str, known: dict[str, Unpack]) -> Unpack:
    if compression not in known:
        raise UnpackError(f"compression {compression[:20]!r} is not supported")
    return known[compression]


def _zstd(data: bytes, size: int) -> bytes:
    # The size that stands in the frame is not believed either: it decides what is allocated.
    found = zstandard.frame_content_size(data)
    if found > most_unpacked(len(data)):
        raise UnpackError(_trap(len(data)))
    if found not in {-1, size}:
        raise UnpackError(f"its frame does not hold the {size} bytes that are claimed")
    return zstandard.ZstdDecompressor().decompress(data, max_output_size=max(size, 1))


def _lz4(data: bytes, size: int) -> bytes:
    return bytes(lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=size))


def _bz2(data: bytes, size: int) -> bytes:
    return bz2.BZ2Decompressor().decompress(data, max_length=size)


def _torn_zstd(data: bytes, size: int) -> bytes:
    reader = zstandard.ZstdDecompressor().stream_reader(io.BytesIO(data))
    parts: list[bytes] = []
    while size > 0:
        try:
            part = reader.read(min(size, _ZSTD_PIECE))
        except zstandard.ZstdError:
            break
        if not part:
            break
        parts.append(part)
        size -= len(part)
    return b"".join(parts)


def _piecewise(decompressor: _Decompressor, data: bytes, size: int) -> bytes:
    """Fed in pieces, so that what stands before the damage has come out when it is met."""
    parts: list[bytes] = []
    begin = 0
    while size > 0 and begin < len(data):
        piece = data[begin : begin + PIECE] if decompressor.needs_input else b""
        begin += len(piece)
        try:
            part = bytes(decompressor.decompress(piece, max_length=size))
        except _FAULTS:
            break
        parts.append(part)
        size -= len(part)
    return b"".join(parts)


def _torn_lz4(data: bytes, size: int) -> bytes:
    return _piecewise(lz4.frame.LZ4FrameDecompressor(), data, size)


def _torn_bz2(data: bytes, size: int) -> bytes:
    return _piecewise(bz2.BZ2Decompressor(), data, size)


_WHOLE: dict[str, Unpack] = {"zstd": _zstd, "lz4": _lz4, "bz2": _bz2}
_TORN: dict[str, Unpack] = {"zstd": _torn_zstd, "lz4": _torn_lz4, "bz2": _torn_bz2}

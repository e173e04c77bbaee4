"""Compressed blocks of bytes: whole ones at once, torn ones as far as they go."""

import bz2
import io
from collections.abc import Callable
from typing import Protocol, TypeAlias

import lz4.frame
import zstandard

LARGEST = 1 << 31
"""Bytes. What claims to unpack to more is not believed."""

PIECE = 1 << 14
_ZSTD_PIECE = 1 << 17
_FAULTS = (zstandard.ZstdError, RuntimeError, OSError, EOFError, ValueError, MemoryError)

Unpack: TypeAlias = Callable[[bytes, int], bytes]


class UnpackError(Exception):
    """A block that can't be unpacked; the message says why."""


class _Decompressor(Protocol):
    def decompress(self, data: bytes, max_length: int) -> bytes: ...


def unpack(compression: str, data: bytes, size: int) -> bytes:
    """The block's `size` bytes, or fewer or other ones where it is damaged; raises UnpackError."""
    if size > LARGEST:
        raise UnpackError(f"it claims {size} bytes")
    if not compression:
        return data
    try:
        return _kind(compression, _WHOLE)(data, size)
    except _FAULTS as error:
        raise UnpackError(str(error)) from error


def unpack_torn(compression: str, data: bytes, size: int) -> bytes:
    """What can be had of a block that was cut or damaged, from its start; raises UnpackError."""
    if size > LARGEST:
        raise UnpackError(f"it claims {size} bytes")
    return _kind(compression, _TORN)(data, size) if compression else data


def _kind(compression: str, known: dict[str, Unpack]) -> Unpack:
    if compression not in known:
        raise UnpackError(f"compression {compression[:20]!r} is not supported")
    return known[compression]


def _zstd(data: bytes, size: int) -> bytes:
    # The size that stands in the frame is not believed either: it decides what is allocated.
    if zstandard.frame_content_size(data) not in {-1, size}:
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
    for begin in range(0, len(data), PIECE):
        try:
            part = bytes(decompressor.decompress(data[begin : begin + PIECE], max_length=-1))
        except _FAULTS:
            break
        parts.append(part)
        size -= len(part)
        if size <= 0:
            break
    return b"".join(parts)


def _torn_lz4(data: bytes, size: int) -> bytes:
    return _piecewise(lz4.frame.LZ4FrameDecompressor(), data, size)


def _torn_bz2(data: bytes, size: int) -> bytes:
    return _piecewise(bz2.BZ2Decompressor(), data, size)


_WHOLE: dict[str, Unpack] = {"zstd": _zstd, "lz4": _lz4, "bz2": _bz2}
_TORN: dict[str, Unpack] = {"zstd": _torn_zstd, "lz4": _torn_lz4, "bz2": _torn_bz2}

"""The container of an artifact: an uncompressed zip of which every byte is determined.

Any zip program can open it. Members begin at multiples of 64 bytes, so that they can be mapped
into memory; the first one, `sha256`, holds the digest over the names and contents of the others.
Reading accepts exactly what writing produces: contents by the digest, and everything around them
(headers, padding, directory) by making it again and comparing. So no byte can be altered unnoticed.

Format: PKWARE APPNOTE.TXT 6.3.10, sections 4.3.7, 4.3.12, 4.3.16.
"""

import hashlib
import struct
import zlib
from collections.abc import Iterator
from typing import Final, NamedTuple, final

ALIGNMENT: Final = 64
DIGEST: Final = "sha256"
LOCAL, CENTRAL, END = b"PK\x03\x04", b"PK\x01\x02", b"PK\x05\x06"
LOCAL_HEADER: Final = struct.Struct("<4s5H3I2H")
CENTRAL_HEADER: Final = struct.Struct("<4s6H3I5H2I")
END_RECORD: Final = struct.Struct("<4s4H2IH")
EXTRA_HEADER: Final = struct.Struct("<2H")
PADDING: Final = 0xD935
"""Id of the extra field that holds padding, as Android's zipalign writes it."""
VERSION: Final = 20
DATE: Final = (1 << 5) + 1
"""1980-01-01, the earliest date that a zip can state: the same bytes on every day."""
LARGEST: Final = 2**30
"""Bytes of all members: far below 4 GiB, where zip files would need other headers."""
FRAME: Final = 2**20
"""Bytes of everything around the members, at most."""
MOST_MEMBERS: Final = 4096
LONGEST_NAME: Final = 64


@final
class ArtifactError(Exception):
    """A file that is not a whole, unaltered artifact of this version; the text says why."""


class Member(NamedTuple):
    """A named part of the container."""

    name: str
    content: memoryview


def join(members: list[Member]) -> bytes:
    """The container's bytes, which depend on nothing but the members.

    Raises:
        ArtifactError: the members are too large for one file.
    """
    if sum(len(member.content) for member in members) > LARGEST:
        raise ArtifactError(f"the tables have more than {LARGEST} bytes")
    digest = Member(DIGEST, memoryview(digest_of(members).encode("ascii")))
    return b"".join(_pieces([digest, *members]))


def split(data: memoryview) -> list[Member]:
    """The members of a container, without the digest, after every byte was checked.

    Raises:
        ArtifactError: the data is not exactly what `join` makes.
    """
    if len(data) > LARGEST + FRAME:
        raise ArtifactError(f"the file has {len(data)} bytes, more than an artifact can have")
    digest, *members = _members(data) or [Member("", memoryview(b""))]
    if digest.name != DIGEST:
        raise ArtifactError("the file is not a compiled spec")
    if digest.content != digest_of(members).encode("ascii"):
        raise ArtifactError("the file was cut or altered: its digest does not fit its contents")
    at = 0
    for piece in _pieces([digest, *members]):
        # The contents are the very bytes that the digest was taken of.
        if isinstance(piece, bytes) and data[at : at + len(piece)] != piece:
            raise ArtifactError(f"the file was altered: it has foreign bytes after byte {at}")
        at += len(piece)
    if at != len(data):
        raise ArtifactError(f"the file was altered: it goes on after its end at byte {at}")
    return members


def digest_of(members: list[Member]) -> str:
    """SHA-256 over names, sizes and contents, as hexadecimal text."""
    digest = hashlib.sha256()
    for name, content in members:
        digest.update(f"{name}\0{len(content)}\0".encode())
        digest.update(content)
    return digest.hexdigest()


def _members(data: memoryview) -> list[Member]:
    """What the local headers say, checked no further than that it lies within the data."""
    members: list[Member] = []
    at = 0
    while bytes(data[at : at + 4]) == LOCAL and len(members) <= MOST_MEMBERS:
        if at + LOCAL_HEADER.size > len(data):
            break
        *_, size, name_size, extra_size = LOCAL_HEADER.unpack_from(data, at)
        name_at = at + LOCAL_HEADER.size
        content_at = name_at + name_size + extra_size
        at = content_at + size
        if at > len(data) or name_size > LONGEST_NAME:
            raise ArtifactError("the file was cut or altered: a part reaches beyond its end")
        name = bytes(data[name_at : name_at + name_size]).decode("ascii", errors="replace")
        members.append(Member(name, data[content_at:at]))
    return members


def _pieces(members: list[Member]) -> Iterator[bytes | memoryview]:
    """All bytes of the container in order, contents as they are."""
    directory = b""
    at = 0
    for name, content in members:
        text = name.encode("ascii")
        checksum = zlib.crc32(content)
        sizes = (checksum, len(content), len(content), len(text))
        extra = _padding(at + LOCAL_HEADER.size + len(text))
        header = LOCAL_HEADER.pack(LOCAL, VERSION, 0, 0, 0, DATE, *sizes, len(extra))
        directory += CENTRAL_HEADER.pack(
            CENTRAL, VERSION, VERSION, 0, 0, 0, DATE, *sizes, 0, 0, 0, 0, 0, at
        )
        directory += text
        yield header + text + extra
        yield content
        at += len(header) + len(text) + len(extra) + len(content)
    yield directory
    count = len(members)
    yield END_RECORD.pack(END, 0, 0, count, count, len(directory), at, 0)


def _padding(at: int) -> bytes:
    """An extra field after which the content begins at a multiple of ALIGNMENT."""
    size = -(at + EXTRA_HEADER.size) % ALIGNMENT
    return EXTRA_HEADER.pack(PADDING, size) + bytes(size)

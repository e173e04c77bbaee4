"""Faulty MCAP files, each made here: none crashes, none is silent, what can be read is read.

Message i of the truth stands at i tenths of a second and says x = i. Whatever a faulty file
gives has to agree with that; each case says how much has to come, and what has to be said.
"""

import json
import struct
import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, final

import lz4.frame
import numpy as np
import pytest
import zstandard

from spec_schema.diagnostics import SpecError
from verifier.traces.files.mcap_records import MAGIC
from verifier.traces.inventory import inspect
from verifier.traces.trace import Trace

COUNT = 200
A_CHUNK = 10
TENTH = 100_000_000


def record(opcode: int, body: bytes) -> bytes:
    return struct.pack("<BQ", opcode, len(body)) + body


def text(value: str | bytes) -> bytes:
    raw = value.encode() if isinstance(value, str) else value
    return struct.pack("<I", len(raw)) + raw


def schema(number: int = 1, name: str = "object") -> bytes:
    return record(3, struct.pack("<H", number) + text(name) + text("jsonschema") + text("{}"))


def channel(number: int = 1, topic: str = "/a", of: int = 1, encoding: str = "json") -> bytes:
    head = struct.pack("<HH", number, of)
    return record(4, head + text(topic) + text(encoding) + struct.pack("<I", 0))


def message(i: int, number: int = 1, time: int | None = None, payload: bytes = b"") -> bytes:
    time = i * TENTH if time is None else time
    body = payload or json.dumps({"x": float(i)}).encode()
    return record(5, struct.pack("<HIQQ", number, i, time, time) + body)


PACK: dict[str, Callable[[bytes], bytes]] = {
    "": lambda data: data,
    "zstd": lambda data: zstandard.ZstdCompressor().compress(data),
    "lz4": lz4.frame.compress,
}


def chunk(inside: bytes, kind: str = "zstd", crc: int | None = None, label: str = "") -> bytes:
    packed = PACK[kind](inside)
    crc = zlib.crc32(inside) if crc is None else crc
    head = struct.pack("<QQQI", 0, COUNT * TENTH, len(inside), crc)
    return record(6, head + text(label or kind) + struct.pack("<Q", len(packed)) + packed)


def whole_chunks(kind: str = "zstd", crc: int | None = None) -> list[bytes]:
    groups = [range(i, i + A_CHUNK) for i in range(0, COUNT, A_CHUNK)]
    first = schema() + channel()
    return [
        chunk((first if group[0] == 0 else b"") + b"".join(map(message, group)), kind, crc)
        for group in groups
    ]


def ending(start: int, declared: bytes = b"", counted: int = COUNT, data: bytes = b"") -> bytes:
    """Data end, summary and footer of a file whose data section has `start` bytes."""
    data_end = record(15, struct.pack("<I", zlib.crc32(data) if data else 0))
    statistics = struct.pack("<QHIIIIQQI", counted, 1, 1, 0, 0, 20, 0, 0, 0)
    summary = declared + record(11, statistics)
    footer = struct.pack("<BQQQ", 2, 20, start + len(data_end), 0)
    return data_end + summary + footer + struct.pack("<I", zlib.crc32(summary + footer)) + MAGIC


def file(parts: Sequence[bytes], **options: Any) -> bytes:
    data = MAGIC + record(1, text("") + text("")) + b"".join(parts)
    declared = options.pop("declared", schema() + channel())
    return data + ending(len(data), declared, **options)


def flipped(data: bytes, place: int, mask: int = 0x10) -> bytes:
    changed = bytearray(data)
    changed[place] ^= mask
    return bytes(changed)


def zeroed(data: bytes, begin: int, end: int) -> bytes:
    return data[:begin] + bytes(end - begin) + data[end:]


def offset(parts: Sequence[bytes], index: int) -> int:
    """Where the part of that index begins in the file."""
    return len(MAGIC) + 17 + sum(map(len, parts[:index]))


C = whole_chunks()
PLAIN = whole_chunks("")
LOOSE = [schema(), channel(), *map(message, range(COUNT))]
W = file(C)
AT = offset(C, 5)


@final
@dataclass(frozen=True)
class Case:
    """A file; how many of its messages must come; a cause or note that must be told."""

    data: bytes
    least: int
    told: str


CASES = {
    "cut in a zstd chunk": Case(W[: AT + 60], 50, "torn chunk"),
    "cut in an lz4 chunk": Case(file(whole_chunks("lz4"))[: AT + 90], 30, "file cut|torn chunk"),
    "cut in a plain chunk": Case(file(PLAIN)[: offset(PLAIN, 5) + 250], 53, "torn chunk"),
    "cut between chunks": Case(W[:AT], 50, "file cut"),
    "cut in the head of a chunk": Case(W[: AT + 20], 50, "file cut or overwritten"),
    "cut behind the data": Case(W[: offset(C, 20) + 5], COUNT, "file cut"),
    "without its last byte": Case(W[:-1], COUNT, "file end torn"),
    "with garbage behind it": Case(W + b"garbage", COUNT, "trailing bytes"),
    "a flipped bit in a zstd chunk": Case(flipped(W, AT + 80), 190, "corrupt chunk"),
    "a flipped bit in a plain chunk": Case(
        flipped(file(PLAIN), offset(PLAIN, 5) + 100), 190, "corrupt chunk"
    ),
    "a flipped bit in the length of a chunk": Case(flipped(W, AT + 1), COUNT, "damaged record"),
    "a chunk that claims a terabyte": Case(flipped(W, AT + 6, 1), COUNT, "damaged record"),
    "a flipped bit in the opcode of a chunk": Case(flipped(W, AT), COUNT, "damaged record"),
    "a chunk's head zeroed": Case(zeroed(W, AT, AT + 49), 190, "damaged bytes"),
    "a whole chunk zeroed": Case(zeroed(W, AT, AT + len(C[5])), 190, "damaged bytes"),
    "a page zeroed across chunks": Case(zeroed(W, AT + 50, AT + 600), 150, "damaged bytes"),
    "garbage between chunks": Case(
        file([*C[:5], bytes(range(256)) * 3, *C[5:]]), COUNT, "damaged bytes"
    ),
    "the file's first bytes overwritten": Case(zeroed(W, 0, 12), COUNT, "file head damaged"),
    "a wrong size in a chunk's head": Case(flipped(W, AT + 9 + 16, 4), 190, "corrupt chunk"),
    "an unknown compression": Case(
        file([*C[:5], chunk(b"".join(map(message, range(50, 60))), label="snappy"), *C[6:]]),
        190,
        "corrupt chunk",
    ),
    "a chunk in a chunk": Case(file([*C, chunk(C[0])]), COUNT, "nested chunk"),
    "chunks without checksums": Case(file(whole_chunks(crc=0)), COUNT, "carry no checksum"),
    "a cut record in a chunk without a checksum": Case(
        file([*C[:5], chunk(b"".join(map(message, range(50, 60)))[:-5], crc=0), *C[6:]]),
        199,
        "corrupt chunk",
    ),
    "no summary": Case(
        MAGIC + record(1, text("") + text("")) + b"".join(C) + record(15, bytes(4))
        + record(2, bytes(20)) + MAGIC,
        COUNT,
        "",
    ),
    "an index that counts too many": Case(file(C, counted=205), COUNT, "messages missing"),
    "an index that counts too few": Case(file(C, counted=7), COUNT, "index disagrees"),
    "an index whose checksum is wrong": Case(flipped(W, len(W) - 60), COUNT, "checksum wrong"),
    "an index of other topics": Case(
        file(C, declared=schema() + channel(topic="/other")), COUNT, "index disagrees"
    ),
    "an index of chunks that are not there": Case(
        file(C, declared=schema() + channel() + record(8, struct.pack("<QQQ", 0, 9, 12345))),
        COUNT,
        "index disagrees",
    ),
    "a footer that points behind the file": Case(
        W[:-28] + struct.pack("<Q", 1 << 40) + W[-20:], COUNT, "index disagrees"
    ),
    "a data section whose checksum is wrong": Case(
        file(LOOSE, data=b"something else"), COUNT, "checksum wrong"
    ),
    "an attachment whose checksum is wrong": Case(
        file([*C, record(9, bytes(16) + text("a") + text("b") + bytes(8) + b"\1\2\3\4")]),
        COUNT,
        "corrupt attachment",
    ),
    "messages that come before their channel": Case(
        file([*map(message, range(10)), schema(), channel(), *map(message, range(10, COUNT))]),
        COUNT,
        "",
    ),
    "a channel that only the index declares": Case(file(LOOSE[2:]), COUNT, ""),
    "messages of no channel": Case(
        file([*C, message(0, number=9), message(1, number=9)], counted=202),
        COUNT,
        "messages without a channel",
    ),
    "a channel declared twice, as another": Case(
        file([*C[:10], channel(encoding="cbor"), *C[10:]], declared=b""), 100, "declared twice"
    ),
    "a schema declared twice, as another": Case(
        file([*LOOSE[:50], schema(name="other"), *LOOSE[50:]], declared=b""),
        COUNT,
        "declared twice",
    ),
    "a channel of a schema that is not there": Case(
        file([channel(of=7), *LOOSE[2:]], declared=b""), COUNT, "names schema 7"
    ),
    "a schema with number 0": Case(
        file([schema(0), channel(of=0), *LOOSE[2:]], declared=b""), COUNT, "corrupt record"
    ),
    "a loose message with a wrong length": Case(
        flipped(file(LOOSE), offset(LOOSE, 50) + 1), 198, "damaged bytes"
    ),
    "loose messages with a page of zeros": Case(
        zeroed(file(LOOSE), offset(LOOSE, 50), offset(LOOSE, 60)), 188, "damaged bytes"
    ),
    "an opcode that is not known": Case(
        file([*C[:5], record(0x40, b"new"), *C[5:]]), COUNT, "unknown record"
    ),
    "a message of ten bytes": Case(
        file([*C[:5], chunk(record(5, bytes(10))), *C[5:]]), COUNT, "corrupt record"
    ),
    "two files, one behind the other": Case(
        file(C[:10], counted=100) + file([schema(), channel(), *C[10:]], counted=100),
        COUNT,
        "several MCAP files",
    ),
    "times in the year 2200": Case(
        file([*C, chunk(message(0, time=1 << 63))], counted=201), COUNT, "impossible log time"
    ),
    "a chunk that stands twice": Case(file([*C, C[3]], counted=210), COUNT, "clock set back"),
    "NaN and infinity": Case(
        file([*C, chunk(message(0, time=COUNT * TENTH, payload=b'{"x": NaN}'))], counted=201),
        COUNT,
        "no finite value",
    ),
    "a payload that is cut": Case(
        file([*C, chunk(message(0, time=COUNT * TENTH, payload=b'{"x": 3'))], counted=201),
        COUNT,
        "unreadable messages",
    ),
    "a payload that is not UTF-8": Case(
        file([*C, chunk(message(0, time=COUNT * TENTH, payload=b'{"x\xff": 3}'))], counted=201),
        COUNT,
        "unreadable messages",
    ),
    "a payload nested too deeply": Case(
        file([*C, chunk(message(0, time=COUNT * TENTH, payload=b"[" * 100_000))], counted=201),
        COUNT,
        "unreadable messages",
    ),
}  # fmt: skip


def told(trace: Trace) -> str:
    losses = [f"{loss.cause}: {loss.detail}" for loss in trace.losses]
    return "\n".join([*losses, *trace.notes])


@pytest.mark.parametrize("name", list(CASES))
def test_a_faulty_file_gives_what_it_can_and_says_what_it_lacks(workshop: Any, name: str) -> None:
    case = CASES[name]
    path = workshop.text(case.data, "log.mcap")

    inspect(path)
    trace = workshop.read(path, x="/a.x")

    series = trace.series["x"]
    seen = np.round((trace.start + series.times) * 10.0)
    assert series.values.tolist() == seen.tolist(), "a value stands at a time that is not its own"
    assert case.least <= len(series.values) <= COUNT
    if case.told:
        assert any(words in told(trace) for words in case.told.split("|")), told(trace)
    else:
        assert trace.losses == ()


@pytest.mark.parametrize("name", [name for name, case in CASES.items() if case.told])
def test_what_is_lost_is_an_error_where_none_is_allowed(workshop: Any, name: str) -> None:
    path = workshop.text(CASES[name].data, "log.mcap")
    trace = workshop.read(path, x="/a.x")

    if trace.losses:
        with pytest.raises(SpecError, match="V313"):
            workshop.read(path, strict=True, x="/a.x")


def test_the_whole_file_is_whole(workshop: Any) -> None:
    trace = workshop.read(workshop.text(W, "log.mcap"), strict=True, x="/a.x")

    assert trace.series["x"].values.tolist() == list(range(COUNT))
    assert trace.losses == ()

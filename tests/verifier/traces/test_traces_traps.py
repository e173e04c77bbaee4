"""Bytes that unpack to far more than they are: refused by name, in bounded memory and time."""

import bz2
import gzip
import json
import sqlite3
import struct
import tracemalloc
import zlib
from contextlib import closing
from pathlib import Path
from typing import Any

import lz4.frame
import pytest
import zstandard
from mcap.writer import CompressionType
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2

from verifier.traces.files import packed_file, unpacking
from verifier.traces.files.unpacking import UnpackError, unpack, unpack_torn, unpack_zstd

PACK = {"bz2": bz2.compress, "lz4": lz4.frame.compress, "zstd": zstandard.compress}
INSIDE = 1 << 23


@pytest.fixture
def narrow(monkeypatch: pytest.MonkeyPatch) -> None:
    """Small traps are traps already."""
    monkeypatch.setattr(unpacking, "BELIEVED_OF_BLOCKS", 1 << 16)
    monkeypatch.setattr(unpacking, "MOST_TIMES", 50)


@pytest.mark.parametrize("kind", list(PACK))
def test_of_a_torn_block_no_more_is_unpacked_than_it_claims(kind: str) -> None:
    packed = PACK[kind](bytes(INSIDE))
    unpack_torn(kind, packed, 1)
    tracemalloc.start()

    found = unpack_torn(kind, packed, 1000)

    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert found == bytes(1000)
    assert most < INSIDE / 4


@pytest.mark.parametrize("kind", list(PACK))
def test_of_a_torn_block_everything_before_the_tear_is_unpacked(kind: str) -> None:
    inside = bytes(range(256)) * 400 + bytes(200_000)
    packed = PACK[kind](inside)

    assert unpack_torn(kind, packed, len(inside)) == inside
    assert inside.startswith(unpack_torn(kind, packed[: len(packed) // 2], len(inside)))


@pytest.mark.usefixtures("narrow")
@pytest.mark.parametrize("kind", list(PACK))
@pytest.mark.parametrize("undo", [unpack, unpack_torn])
def test_a_trap_is_refused(kind: str, undo: Any) -> None:
    with pytest.raises(UnpackError, match="as a trap does"):
        undo(kind, PACK[kind](bytes(INSIDE)), INSIDE)


@pytest.mark.usefixtures("narrow")
@pytest.mark.parametrize("kind", ["bz2", "lz4"])
def test_a_wrong_claim_of_much_is_no_trap_where_there_is_little(kind: str) -> None:
    assert unpack(kind, PACK[kind](b"x" * 500), INSIDE) == b"x" * 500


@pytest.mark.usefixtures("narrow")
@pytest.mark.parametrize("sized", [True, False])
def test_a_frame_that_is_a_trap_is_refused_whether_it_says_its_size_or_not(*, sized: bool) -> None:
    packer = zstandard.ZstdCompressor(write_content_size=sized)

    assert unpack_zstd(packer.compress(b"x" * 5000)) == b"x" * 5000
    with pytest.raises(UnpackError, match="as a trap does"):
        unpack_zstd(packer.compress(bytes(INSIDE)))


@pytest.mark.usefixtures("narrow")
@pytest.mark.parametrize("kind", [CompressionType.ZSTD, CompressionType.LZ4])
def test_a_chunk_that_is_a_trap_is_lost_and_the_others_are_read(
    workshop: Any, make: Any, kind: CompressionType
) -> None:
    notes = [make.said("/a", 0.1 * i, x=float(i)) for i in range(40)]
    notes[20] = make.said("/a", 2.0, x=20.0, ballast="0" * INSIDE)
    path = workshop.mcap(notes, compression=kind, chunk_size=200)

    trace = workshop.read(path, x="/a.x")

    (lost,) = (loss for loss in trace.losses if loss.cause == "corrupt chunk")
    assert "as a trap does" in lost.detail
    assert {loss.cause for loss in trace.losses} == {"corrupt chunk", "messages missing"}
    seen = trace.series["x"].values.tolist()
    assert 20.0 not in seen
    assert len(seen) > 30


def test_a_chunk_of_zeros_is_left_at_its_first_byte(workshop: Any, make: Any) -> None:
    path = workshop.mcap([make.said("/a", 0.1 * i, x=float(i)) for i in range(40)])
    zeros = bytes(1 << 20)
    head = struct.pack("<QQQII", 0, 0, len(zeros), zlib.crc32(zeros), 4) + b"zstd"
    packed = zstandard.compress(zeros)
    body = head + struct.pack("<Q", len(packed)) + packed
    data = path.read_bytes()
    path.write_bytes(data[:8] + struct.pack("<BQ", 6, len(body)) + body + data[8:])

    trace = workshop.read(path, x="/a.x")

    (lost,) = (loss for loss in trace.losses if loss.cause == "corrupt chunk")
    assert lost.count == 1
    assert "unreadable from its byte 0 on" in lost.detail
    assert len(trace.series["x"].values) == 40


@pytest.mark.usefixtures("narrow")
@pytest.mark.parametrize("sized", [True, False])
def test_rows_of_a_bag_that_are_traps_are_lost(workshop: Any, *, sized: bool) -> None:
    path = _zstd_rows(workshop, sized=sized)

    trace = workshop.read(path, x="/a.x")

    (lost,) = (loss for loss in trace.losses if loss.cause == "corrupt record")
    assert lost.count == 2
    assert trace.series["x"].values.tolist() == [float(i) for i in range(30) if i not in {7, 9}]


def _zstd_rows(workshop: Any, *, sized: bool) -> Path:
    """A database of 30 messages that are packed one by one; the 8th and 10th are traps."""
    packer = zstandard.ZstdCompressor(write_content_size=sized)
    kind = workshop.store.types["geometry_msgs/msg/Vector3"]
    with Writer2(workshop.folder / "b", version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
        connection = writer.add_connection("/a", kind.__msgtype__, typestore=workshop.store)
        for i in range(30):
            message = kind(x=float(i), y=0.0, z=0.0)
            payload = bytes(workshop.store.serialize_cdr(message, kind.__msgtype__))
            inside = bytes(INSIDE) if i in {7, 9} else payload
            writer.write(connection, i * 10**8, packer.compress(inside))
    (path,) = (workshop.folder / "b").glob("*.db3")
    with closing(sqlite3.connect(path)) as database:
        assert database.execute("SELECT count(*) FROM messages").fetchone() == (30,)
    return Path(path)


def test_a_packed_log_that_is_a_trap_is_not_unpacked_any_further(
    workshop: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(packed_file, "BELIEVED_OF_FILES", 1 << 21)
    monkeypatch.setattr(packed_file, "MOST_TIMES", 50)
    rows = "".join(f"{0.1 * i:.1f},{i}\n" for i in range(50))
    trap = gzip.compress(f"t,x\n{rows}".encode() + b"\n" * INSIDE)

    trace = workshop.read(workshop.text(trap, "log.csv.gz"), x="x")

    assert [loss.cause for loss in trace.losses] == ["packed file damaged"]
    assert "as a trap does" in trace.losses[0].detail
    assert trace.series["x"].values.tolist() == list(range(50))


def test_a_message_without_end_of_nesting_is_lost(workshop: Any, make: Any) -> None:
    deep = "[" * 100_000
    notes = [make.said("/a", 0.1 * i, x=float(i)) for i in range(40)]
    notes[3] = make.note("/a", 0.3, deep.encode())
    notes[5] = make.note("/a", 0.5, json.dumps({"x": int("9" * 4000)}).encode())

    trace = workshop.read(workshop.mcap(notes), x="/a.x")

    assert {loss.cause: loss.count for loss in trace.losses} == {
        "unreadable messages": 1,
        "no finite value": 1,
    }
    assert len(trace.series["x"].values) == 38

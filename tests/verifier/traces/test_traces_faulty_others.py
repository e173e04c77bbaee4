"""Faulty bags, CSV files and packed files, each made here: nothing crashes, nothing is silent."""

import bz2
import gzip
import lzma
import shutil
import sqlite3
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import lz4.frame
import numpy as np
import pytest
import zstandard
from mcap.writer import CompressionType
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2

from spec_schema.diagnostics import SpecError
from verifier.traces.files.bag1_file import MAGIC
from verifier.traces.files.bag1_records import CHUNK, record_at
from verifier.traces.files.bag2_file import read_bag2
from verifier.traces.files.log import Wanted
from verifier.traces.files.sqlite_pages import MOST_READINGS, StrayRows
from verifier.traces.inventory import inspect
from verifier.traces.trace import Trace

SECOND = 1_000_000_000
ROWS = "".join(f"{0.1 * i:.1f},{i:03d}.25\n" for i in range(100))
SHEET = "t,x\n" + ROWS
BZ2, LZ4 = Writer1.CompressionFormat.BZ2, Writer1.CompressionFormat.LZ4


def told(trace: Trace) -> str:
    losses = [f"{loss.cause}: {loss.detail}" for loss in trace.losses]
    return "\n".join([*losses, *trace.notes])


def chunk_places(data: bytes) -> list[int]:
    """Where the headers of a ROS 1 bag's chunks begin."""
    places, position = [], len(MAGIC)
    while record := record_at(data, position):
        if record.kind == CHUNK:
            places.append(position)
        position = record.end
    return places


def changed(data: bytes, place: int, new: bytes) -> bytes:
    return data[:place] + new + data[place + len(new) :]


BAGS: dict[str, tuple[Any, Callable[[bytes], bytes], int, str]] = {
    "cut in a plain chunk": (None, lambda b: b[: len(b) // 2], 150, "torn chunk"),
    "cut in a bz2 chunk": (BZ2, lambda b: b[: chunk_places(b)[2] + 400], 60, "torn chunk"),
    "cut in an lz4 chunk": (LZ4, lambda b: b[: chunk_places(b)[2] + 400], 60, "torn chunk"),
    "without its index": (None, lambda b: b[: b.rfind(b"op=\x06") - 60], 300, "file cut"),
    "garbage between chunks": (
        BZ2,
        lambda b: b[: chunk_places(b)[2]] + bytes(range(256)) + b[chunk_places(b)[2] :],
        400,
        "damaged bytes",
    ),
    "a chunk's header zeroed": (
        BZ2, lambda b: changed(b, chunk_places(b)[2], bytes(40)), 290, "damaged bytes",
    ),
    "a bz2 chunk overwritten": (
        BZ2, lambda b: changed(b, chunk_places(b)[2] + 120, bytes(50)), 290, "corrupt chunk",
    ),
    "an lz4 chunk overwritten": (
        LZ4, lambda b: changed(b, chunk_places(b)[2] + 120, b"\xff" * 50), 290, "corrupt chunk",
    ),
    "an unknown compression": (
        BZ2,
        lambda b: changed(b, b.find(b"compression=", chunk_places(b)[2]) + 12, b"xz2"),
        290,
        "corrupt chunk",
    ),
    "a wrong length of a chunk": (
        BZ2,
        lambda b: changed(b, chunk_places(b)[2] + 4 + b[chunk_places(b)[2]] + 2, b"\7"),
        290,
        "damaged record",
    ),
    "another version": (None, lambda b: b.replace(b"V2.0", b"V2.1", 1), 400, "bag version"),
}  # fmt: skip


@pytest.mark.parametrize("name", list(BAGS))
def test_a_faulty_ros_1_bag_gives_what_it_can(workshop: Any, name: str) -> None:
    compression, damage, least, cause = BAGS[name]
    path = workshop.bag1(compression, count=400, chunk=60)
    path.write_bytes(damage(path.read_bytes()))

    inspect(path)
    trace = workshop.read(path, x="/p.point.x")

    series = trace.series["x"]
    # Point i is stamped 10 + i.
    assert series.values.tolist() == np.round(trace.start + series.times - 10.0).tolist()
    assert least <= len(series.values)
    assert cause in told(trace)


def write_database(workshop: Any, count: int = 400) -> Path:
    folder: Path = workshop.folder / "bag"
    with Writer2(folder, version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
        connection = writer.add_connection("/o", "nav_msgs/msg/Odometry", typestore=workshop.store)
        for i in range(count):
            payload = workshop.store.serialize_cdr(
                workshop.odometry(10.0 + i, x=float(i)), "nav_msgs/msg/Odometry"
            )
            writer.write(connection, (10 + i) * SECOND, payload)
    (database,) = folder.glob("*.db3")
    return database


def zero_leaf(data: bytes) -> bytes:
    """A page with messages in the middle, zeroed."""
    pages = [p for p in range(0, len(data), 4096) if data[p] == 0x0D and p > len(data) // 2]
    return changed(data, pages[0], bytes(4096))


def zero_tree(data: bytes) -> bytes:
    """The page that leads to the messages, zeroed."""
    (page,) = [p for p in range(4096, len(data), 4096) if data[p] == 0x05][:1]
    return changed(data, page, bytes(4096))


@pytest.mark.parametrize(
    ("damage", "least", "cause"),
    [
        (lambda b: b[: len(b) * 3 // 4], 280, "database damaged"),
        (lambda b: b[:-10], 380, "file cut"),
        (zero_leaf, 390, "database damaged"),
        (zero_tree, 400, "database damaged"),
    ],
    ids=["cut", "without its last bytes", "a page zeroed", "its tree zeroed"],
)
def test_a_damaged_database_gives_the_rows_that_are_left(
    workshop: Any, damage: Callable[[bytes], bytes], least: int, cause: str
) -> None:
    path = write_database(workshop)
    path.write_bytes(damage(path.read_bytes()))

    trace = workshop.read(path, x="/o.pose.pose.position.x")

    series = trace.series["x"]
    assert series.values.tolist() == np.round(trace.start + series.times - 10.0).tolist()
    assert least <= len(series.values)
    assert cause in told(trace)


def test_a_database_with_values_of_other_types_loses_those_rows(workshop: Any) -> None:
    path = write_database(workshop, 20)
    with sqlite3.connect(path) as database:
        database.execute("UPDATE messages SET timestamp = 'soon' WHERE id = 3")
        database.execute("UPDATE messages SET timestamp = -5 WHERE id = 4")
        database.execute("UPDATE messages SET data = x'0001' WHERE id = 5")
    database.close()

    trace = workshop.read(path, x="/o.pose.pose.position.x")

    assert len(trace.series["x"].values) == 17
    assert {"corrupt record", "impossible log time", "unreadable messages"} == {
        loss.cause for loss in trace.losses
    }


def test_a_database_whose_schema_is_no_text_gives_its_rows(workshop: Any) -> None:
    path = write_database(workshop, 20)
    data = path.read_bytes()
    assert data.count(b"CREATE TABLE messages") == 1
    path.write_bytes(data.replace(b"CREATE TABLE messages", b"CREATE\xffTABLE messages"))

    trace = workshop.read(path, x="/o.pose.pose.position.x")

    assert trace.series["x"].values.tolist() == list(range(20))
    assert {"database damaged", "unverified messages"} <= {loss.cause for loss in trace.losses}


def test_rows_of_a_database_without_numbers_are_survived(workshop: Any) -> None:
    path = write_database(workshop, 20)
    with sqlite3.connect(path) as database:
        for table in ("topics", "messages"):
            # As damage to the schema leaves it: the number is a value like others, and lacks.
            database.execute(f"CREATE TABLE plain AS SELECT * FROM {table}")  # noqa: S608  # our own
            database.execute(f"DROP TABLE {table}")
            database.execute(f"ALTER TABLE plain RENAME TO {table}")
        database.execute("INSERT INTO topics (id, name) VALUES (NULL, '/b'), ('x', '/c')")
        database.execute("UPDATE messages SET id = NULL WHERE id = 1")
    database.close()

    trace = workshop.read(path, x="/o.pose.pose.position.x")

    assert len(trace.series["x"].values) == 20
    assert [(loss.cause, loss.count, loss.detail) for loss in trace.losses] == [
        ("corrupt record", 2, "a topic without a number")
    ]


def knot(pages: int, cells: int) -> bytes:
    """A database without a tree, in which the cells of one leaf all lead to one long chain."""
    size, payload = 4096, (pages - 3) * 4092
    head = b"\x00\x01\x06" + varint(2 * payload + 12)
    head = varint(len(head) + 1) + head
    length = len(head) + 1 + 8 + payload
    least = (size - 12) * 32 // 255 - 23
    local = least + (length - least) % (size - 4)
    local = local if local <= size - 35 else least
    body = head + b"\x01" + (10 * SECOND).to_bytes(8, "big") + bytes(payload)
    cell = varint(length) + b"\x01" + body[:local] + (3).to_bytes(4, "big")
    place = size - len(cell)
    leaf = b"\x0d\0\0" + cells.to_bytes(2, "big") + bytes(3) + cells * place.to_bytes(2, "big")
    rest = body[local:]
    chain = b"".join(
        (4 + i).to_bytes(4, "big") + rest[i * 4092 : (i + 1) * 4092].ljust(4092, b"\0")
        for i in range(pages - 2)
    )
    first = b"SQLite format 3\0" + size.to_bytes(2, "big")
    return first.ljust(size, b"\0") + leaf.ljust(place, b"\0") + cell + chain


def varint(number: int) -> bytes:
    """Seven bits a byte, the last one without its mark."""
    low = bytes([number & 0x7F])
    number >>= 7
    while number:
        low = bytes([number & 0x7F | 0x80]) + low
        number >>= 7
    return low


def test_cells_that_share_their_pages_are_not_read_again_and_again(workshop: Any) -> None:
    """A thousand cells on one chain would cost a thousand times the file, in memory and time."""
    data = knot(pages=50, cells=300)
    rows = StrayRows(data)

    bodies = [row[3] for _, _, row in rows]

    assert 1 <= len(bodies) <= MOST_READINGS
    assert sum(len(body) for body in bodies if isinstance(body, bytes)) <= MOST_READINGS * len(data)
    assert len(bodies) + rows.left_out == 300
    log = read_bag2(workshop.text(data, "a.db3"), Wanted(None, None), lambda _done, _of: None)
    assert ("rows left out", rows.left_out) in {(loss.cause, loss.count) for loss in log.losses}


def test_what_a_killed_recorder_left_in_the_write_ahead_log_is_read(workshop: Any) -> None:
    path = write_database(workshop, 20)
    database = sqlite3.connect(path)
    database.execute("PRAGMA journal_mode = WAL")
    database.execute("PRAGMA wal_autocheckpoint = 0")
    database.execute("UPDATE messages SET timestamp = ? WHERE id = 20", (100 * SECOND,))
    database.commit()
    copy = path.with_name("copy.db3")
    for suffix in ("", "-wal"):
        Path(f"{copy}{suffix}").write_bytes(Path(f"{path}{suffix}").read_bytes())
    database.close()

    trace = workshop.read(copy, "log", x="/o.pose.pose.position.x")

    assert trace.series["x"].times[-1] == 90.0


SHEETS: dict[str, tuple[bytes, int, str]] = {
    "a torn last row": (SHEET.encode() + b"10.0", 100, "missing or extra cells"),
    "a last cell that is cut": (SHEET.encode()[:-4], 99, "last row cut"),
    "ragged rows": (SHEET.replace("5.0,", "5.0,1,").encode(), 90, "missing or extra cells"),
    "zero bytes": (SHEET.replace("\n0.7,", "\n\0\0\0,").encode(), 99, "zero bytes"),
    "a byte order mark": (b"\xef\xbb\xbf" + SHEET.encode(), 100, "column 't'"),
    "UTF-16": (SHEET.encode("utf-16"), 100, "column 't'"),
    "bytes that are not UTF-8": (SHEET.replace("3.0", "3.\xff").encode("latin-1"), 95, "UTF-8"),
    "decimal commas": (SHEET.replace(",", ";").replace(".", ",").encode(), 100, "decimal commas"),
    "an open quote": (SHEET.replace("\n2.0,", '\n2.0,"').encode(), 99, "missing or extra cells"),
    "some rows of another separator": (
        SHEET.replace("\n4.1,", "\n4.1;").encode(), 99, "missing or extra cells",
    ),
    "rows without a time": (SHEET.replace("\n6.6,", "\n,").encode(), 99, "without a time"),
    "a time of the year 30000": (SHEET.replace("\n6.6,", "\n9e11,").encode(), 99, "without a time"),
    "NaN": (SHEET.replace("066.25", "nan").encode(), 99, "no finite value"),
    "two rows of one time": (SHEET.replace("\n0.4,", "\n0.3,").encode(), 99, "repeated times"),
    "a clock that is set back": (
        SHEET.replace("\n9.9,", "\n-9.9,").encode(), 99, "clock set back",
    ),
    "lines that end as on a Mac": (SHEET.replace("\n", "\r").encode(), 100, "column 't'"),
}  # fmt: skip


@pytest.mark.parametrize("name", list(SHEETS))
def test_a_faulty_csv_file_gives_what_it_can(workshop: Any, name: str) -> None:
    data, least, said = SHEETS[name]

    trace = workshop.read(workshop.text(data), x="x")

    series = trace.series["x"]
    seen = np.round((trace.start + series.times) * 10.0) + 0.25
    assert series.values.tolist() == seen.tolist()
    assert least <= len(series.values) <= 100
    assert said in told(trace)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (SHEET.replace(".", ","), "decimal commas"),
        ("t;x\n" + ROWS, "separated by ';', the rows by ','"),
        ("t,x,y,z\n" + ROWS, "2 cells, the header 4"),
        ("t\0,x\n" + ROWS, "no log that specc knows"),
        ("version https://git-lfs.github.com/spec/v1\noid sha256:0\n", "git lfs pull"),
        ("<!DOCTYPE html>\n<p>404, not found\n", "page of the web"),
        (bytes(5000), "zero bytes"),
    ],
)
def test_what_can_be_no_table_is_refused_with_the_reason(
    workshop: Any, data: str | bytes, said: str
) -> None:
    with pytest.raises(SpecError, match=f"(?s)V302.*{said}"):
        workshop.read(workshop.text(data), x="x")


PACKERS = {
    "gz": gzip.compress,
    "zst": zstandard.ZstdCompressor().compress,
    "bz2": bz2.compress,
    "xz": lzma.compress,
    "lz4": lz4.frame.compress,
}


@pytest.mark.parametrize("suffix", list(PACKERS))
def test_a_packed_log_is_unpacked_whole_or_torn(workshop: Any, make: Any, suffix: str) -> None:
    rng = np.random.default_rng(2)
    notes = [make.said("/a", 0.1 * i, x=float(i), r=rng.random()) for i in range(4000)]
    inside = workshop.mcap(notes, "inside.mcap", CompressionType.NONE, 10_000).read_bytes()
    packed = PACKERS[suffix](inside)
    whole = workshop.text(packed, f"log.mcap.{suffix}")
    trace = workshop.read(whole, x="/a.x")
    assert trace.series["x"].values.tolist() == list(range(4000))
    assert trace.losses == ()

    torn = workshop.text(packed[: len(packed) * 9 // 10], f"torn.mcap.{suffix}")
    try:
        trace = workshop.read(torn, x="/a.x")
    except SpecError as error:
        assert "torn.mcap" in str(error)  # noqa: PT017  # either is an answer
    else:
        found = trace.series["x"].values.tolist()
        assert found == list(range(len(found)))
        assert trace.losses


CHECKED = {
    "gz": gzip.compress,
    "zst": zstandard.ZstdCompressor(write_checksum=True).compress,
    "xz": partial(lzma.compress, preset=0),
    "lz4": partial(lz4.frame.compress, content_checksum=True),
}


@pytest.mark.parametrize("suffix", list(CHECKED))
def test_of_a_packed_log_that_is_damaged_what_stands_before_is_read_and_nothing_vouched_for(
    workshop: Any, suffix: str
) -> None:
    rng = np.random.default_rng(3)
    rows = "".join(f"{0.1 * i:.1f},{i},{rng.random()}\n" for i in range(10_000))
    packed = bytearray(CHECKED[suffix](f"t,x,r\n{rows}".encode()))
    middle = len(packed) * 6 // 10
    packed[middle : middle + 200] = rng.bytes(200)

    trace = workshop.read(workshop.text(bytes(packed), f"log.csv.{suffix}"), x="x")

    details = {loss.cause: loss.detail for loss in trace.losses}
    assert "no checksum vouches" in details["packed file damaged"]
    seen = np.isin(np.arange(10_000), trace.series["x"].values)
    assert seen[:1000].all()


def test_a_packed_log_of_which_nothing_is_left_is_not_called_empty(workshop: Any) -> None:
    packed = gzip.compress(b"t,x\n0,1\n1,2\n")

    with pytest.raises(SpecError, match=r"V302.*nothing of it can be unpacked"):
        workshop.read(workshop.text(packed[:10] + b"\xff" * 20, "log.csv.gz"), x="x")


@pytest.fixture
def crowded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A temporary folder of the system with 2 MB free."""
    folder = tmp_path / "crowded"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    usage = shutil._ntuple_diskusage(10_000_000, 8_000_000, 2_000_000)
    monkeypatch.setattr(shutil, "disk_usage", lambda _path: usage)
    return folder


def test_a_packed_log_does_not_fill_the_disk(workshop: Any, crowded: Path) -> None:
    path = workshop.text(gzip.compress(SHEET.encode() + bytes(10_000_000)), "log.csv.gz")

    with pytest.raises(SpecError) as caught:
        workshop.read(path, x="x")

    [said] = caught.value.diagnostics
    assert said.code == "V301"
    assert said.message == (
        f"it unpacks to more than 2 MB, which {crowded} can't hold: more is not free there"
    )
    assert "TMPDIR" in said.help
    assert list(crowded.iterdir()) == [], "what was unpacked is removed"
    small = workshop.text(gzip.compress(SHEET.encode()), "small.csv.gz")
    assert len(workshop.read(small, x="x").series["x"].values) == 100


def test_a_disk_that_is_full_while_unpacking_is_named(
    workshop: Any, crowded: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`/dev/full` takes nothing: each write to it fails as on a full disk."""
    path = workshop.text(gzip.compress(SHEET.encode()), "log.csv.gz")
    monkeypatch.setattr(Path, "open", full(Path.open))

    with pytest.raises(SpecError, match="V301") as caught:
        workshop.read(path, x="x")

    [said] = caught.value.diagnostics
    assert said.message.endswith(f"which {crowded} can't hold: no space left on device")
    assert list(crowded.iterdir()) == []


def full(opened: Callable[..., Any]) -> Callable[..., Any]:
    """`opened`, but for files that are to be written."""
    return lambda path, mode="r": opened(Path("/dev/full") if mode == "wb" else path, mode)


def test_without_a_temporary_folder_the_log_is_not_said_to_be_missing(
    workshop: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = workshop.text(gzip.compress(SHEET.encode()), "log.csv.gz")
    monkeypatch.setattr(tempfile, "tempdir", str(path.parent / "nowhere"))

    with pytest.raises(SpecError, match=r"V301.*no temporary folder can be made"):
        workshop.read(path, x="x")


def test_an_empty_part_of_a_folder_is_counted(workshop: Any, make: Any) -> None:
    folder = workshop.folder / "run"
    folder.mkdir()
    workshop.mcap([make.said("/a", 0.1 * i, x=float(i)) for i in range(9)], "run/run_0.mcap")
    workshop.text("", "run/run_1.mcap")

    trace = workshop.read(folder, x="/a.x")

    assert [(loss.cause, loss.detail) for loss in trace.losses] == [("empty file", "run_1.mcap")]

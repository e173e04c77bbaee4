"""Ten thousand logs, damaged at random: no traceback, and no wrong value where checksums are.

Bytes are flipped, overwritten, zeroed, doubled and cut out, and files are cut. Message i of the
truth stands at i tenths of a second and says x = i, so every value that is read can be checked.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

import numpy as np
import pytest
from mcap.writer import CompressionType
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2

from runtime.program import Program
from spec_schema.diagnostics import SpecError
from verifier.traces.read import read_trace
from verifier.traces.trace import Trace

SECOND = 1_000_000_000
COUNT = 16


def damaged(data: bytes, rng: np.random.Generator) -> bytes:
    """The bytes with one or a few of them changed, cut out, doubled or zeroed, or cut short."""
    changed = bytearray(data)
    for _ in range(int(rng.integers(1, 4))):
        place = int(rng.integers(0, len(changed)))
        length = int(rng.integers(1, 40))
        match int(rng.integers(0, 8)):
            case 0 | 1 | 2:
                changed[place] ^= 1 << int(rng.integers(0, 8))
            case 3:
                changed[place : place + length] = rng.bytes(len(changed[place : place + length]))
            case 4:
                del changed[place : place + length]
            case 5:
                changed[place:place] = changed[place : place + length]
            case 6:
                changed[place : place + length] = bytes(len(changed[place : place + length]))
            case _:
                del changed[place:]
        if not changed:
            break
    return bytes(changed)


def json_mcap(workshop: Any, make: Any, compression: CompressionType) -> Path:
    notes = [make.said("/a", 0.1 * i, x=float(i)) for i in range(COUNT)]
    path: Path = workshop.mcap(notes, compression=compression, chunk_size=400)
    return path


def cdr_mcap(workshop: Any, compression: CompressionType, **options: Any) -> Path:
    kind = workshop.store.types["geometry_msgs/msg/Vector3"]
    notes = [workshop.cdr("/a", 0.1 * i, kind(x=float(i), y=0.0, z=0.0)) for i in range(COUNT)]
    path: Path = workshop.mcap(notes, compression=compression, chunk_size=500, **options)
    return path


def database(workshop: Any) -> Path:
    kind = workshop.store.types["geometry_msgs/msg/Vector3"]
    with Writer2(workshop.folder / "b", version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
        connection = writer.add_connection("/a", kind.__msgtype__, typestore=workshop.store)
        for i in range(COUNT):
            payload = workshop.store.serialize_cdr(kind(x=float(i), y=0.0, z=0.0), kind.__msgtype__)
            writer.write(connection, i * SECOND // 10, payload)
    (path,) = (workshop.folder / "b").glob("*.db3")
    moved: Path = path.rename(workshop.folder / "log.db3")
    return moved


def sheet(workshop: Any) -> Path:
    path: Path = workshop.text("t,x\n" + "".join(f"{0.1 * i:.1f},{i}\n" for i in range(COUNT)))
    return path


@final
@dataclass(frozen=True)
class Kind:
    """How often a log of this kind is damaged, how it is written, and whether it is checked.

    checked: a checksum covers every value, so none that is wrong may be passed on as good.
    """

    rounds: int
    write: Callable[[Any, Any], Path]
    path: str
    checked: bool


KINDS = {
    "json in zstd": Kind(
        1700, lambda w, m: json_mcap(w, m, CompressionType.ZSTD), "/a.x", checked=True
    ),
    "json in lz4": Kind(
        1200, lambda w, m: json_mcap(w, m, CompressionType.LZ4), "/a.x", checked=True
    ),
    "json in plain chunks": Kind(
        1200, lambda w, m: json_mcap(w, m, CompressionType.NONE), "/a.x", checked=True
    ),
    "cdr in zstd": Kind(1700, lambda w, _: cdr_mcap(w, CompressionType.ZSTD), "/a.x", checked=True),
    "cdr in plain chunks": Kind(
        1200, lambda w, _: cdr_mcap(w, CompressionType.NONE), "/a.x", checked=True
    ),
    "cdr without checksums": Kind(
        500, lambda w, _: cdr_mcap(w, CompressionType.ZSTD, enable_crcs=False), "/a.x",
        checked=False,
    ),
    "cdr without chunks": Kind(
        500, lambda w, _: cdr_mcap(w, CompressionType.NONE, use_chunking=False), "/a.x",
        checked=False,
    ),
    "bag": Kind(500, lambda w, _: w.bag1(None, COUNT // 2, 4), "/p.point.x", checked=False),
    "bag in bz2": Kind(
        500,
        lambda w, _: w.bag1(Writer1.CompressionFormat.BZ2, COUNT // 2, 4),
        "/p.point.x",
        checked=False,
    ),
    "database": Kind(500, lambda w, _: database(w), "/a.x", checked=False),
    "csv": Kind(500, lambda w, _: sheet(w), "x", checked=False),
}  # fmt: skip

UNSURE = ("unverified messages", "checksum wrong", "index disagrees", "declared twice")


def write_over(path: Path, data: bytes) -> None:
    """Changes the file where it is.

    One that is cut to nothing first is flushed to the disk, and a new one costs as much as it
    takes to read it.
    """
    with path.open("r+b") as file:
        file.write(data)
        file.truncate()


def read(path: Path, program: Program) -> Trace | None:
    """The trace; None where the log is refused with a diagnostic."""
    try:
        trace = read_trace(path, program)
    except SpecError:
        return None
    series = trace.series["x"]
    assert np.isfinite(series.values).all()
    assert (np.diff(series.times) > 0.0).all()
    return trace


def wrong_values(trace: Trace) -> int:
    series = trace.series["x"]
    seen = np.round((trace.start + series.times) * 10.0)
    return int(np.count_nonzero(seen != series.values))


def test_the_cases_are_ten_thousand() -> None:
    assert sum(kind.rounds for kind in KINDS.values()) == 10_000


@pytest.mark.parametrize("name", list(KINDS))
def test_damage_at_random_is_survived_and_said(workshop: Any, make: Any, name: str) -> None:
    kind = KINDS[name]
    path = kind.write(workshop, make)
    program = make.program([make.state("x")], {"x": kind.path})
    whole = path.read_bytes()
    rng = np.random.default_rng(sum(name.encode()))
    begin = time.process_time()
    read_at_all = silent = 0

    for number in range(kind.rounds):
        data = damaged(whole, rng)
        write_over(path, data)
        trace = read(path, program)
        if trace is None:
            continue
        read_at_all += 1
        causes = {loss.cause for loss in trace.losses}
        if kind.checked:
            assert not wrong_values(trace) or causes & set(UNSURE), f"round {number}: {causes}"
            lacks = len(trace.series["x"].values) < COUNT
            assert causes or not lacks, f"round {number}: messages are lacking, and nothing is said"
        silent += data != whole and not causes

    assert read_at_all > kind.rounds // 2
    # Where a value is covered, only what nobody reads (metadata, times of writing) may go unsaid.
    assert silent < kind.rounds // 4 or not kind.checked
    # Milliseconds a round; a loop over a length that was read from garbage would take longer.
    assert time.process_time() - begin < 20.0

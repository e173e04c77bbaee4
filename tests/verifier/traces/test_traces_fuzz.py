"""Damaged bytes give a trace or a diagnostic, never anything else, and soon."""

import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import CompressionType

from spec_schema.diagnostics import SpecError
from verifier.traces.files.open_log import attached_program
from verifier.traces.inventory import inspect
from verifier.traces.trace import Trace

ROUNDS = 60


def damaged(data: bytes, rng: np.random.Generator) -> bytes:
    """The bytes with a few of them changed, cut out, doubled or zeroed."""
    changed = bytearray(data)
    for _ in range(int(rng.integers(1, 6))):
        place = int(rng.integers(0, len(changed)))
        length = int(rng.integers(1, 40))
        match int(rng.integers(0, 6)):
            case 0 | 1 | 2:
                changed[place] = int(rng.integers(0, 256))
            case 3:
                changed[place : place + 8] = b"\xff" * len(changed[place : place + 8])
            case 4:
                del changed[place : place + length]
            case _:
                changed[place:place] = changed[place : place + length]
        if not changed:
            break
    return bytes(changed)


def write(workshop: Any, make: Any, kind: str) -> Path:
    """A small whole log with the number /p.point.x, or the column x."""
    if kind == "csv":
        return workshop.text("t,x\n" + "".join(f"{0.1 * i:.1f},{i}\n" for i in range(60)))
    if kind == "bag":
        return workshop.bag1()
    if kind == "json":
        notes = [make.said("/p", 0.1 * i, point={"x": float(i)}) for i in range(60)]
        return workshop.mcap(notes, chunk_size=500)
    point = workshop.store.types["geometry_msgs/msg/Point"]
    stamped = workshop.store.types["geometry_msgs/msg/PointStamped"]
    header = workshop.store.types["std_msgs/msg/Header"]
    stamp = workshop.store.types["builtin_interfaces/msg/Time"]
    notes = [
        workshop.cdr(
            "/p",
            10.0 + i,
            stamped(
                header=header(stamp=stamp(sec=10 + i, nanosec=0), frame_id="map" * (i % 2)),
                point=point(x=float(i), y=0.0, z=0.0),
            ),
        )
        for i in range(60)
    ]
    packed = CompressionType.ZSTD if kind == "zstd" else CompressionType.NONE
    return workshop.mcap(notes, compression=packed, chunk_size=700, enable_crcs=kind == "zstd")


def read_or_refuse(workshop: Any, path: Path, x: str) -> Trace | None:
    """Everything that can be done with a log; a trace if it is still one."""
    with suppress(SpecError):
        attached_program(path)
        inspect(path)
    try:
        trace: Trace = workshop.read(path, x=x)
    except SpecError:
        return None
    assert np.isfinite(trace.series["x"].values).all()
    assert (np.diff(trace.series["x"].times) > 0.0).all()
    return trace


@pytest.mark.parametrize("kind", ["csv", "bag", "json", "zstd", "no checksums"])
def test_damaged_logs_give_a_trace_or_a_diagnostic(workshop: Any, make: Any, kind: str) -> None:
    path = write(workshop, make, kind)
    whole = path.read_bytes()
    rng = np.random.default_rng(len(kind))
    begin = time.monotonic()
    traces = 0

    for _ in range(ROUNDS):
        path.write_bytes(damaged(whole, rng))
        trace = read_or_refuse(workshop, path, "x" if kind == "csv" else "/p.point.x")
        traces += trace is not None

    assert traces > ROUNDS // 10
    # Each round takes milliseconds; a loop over a length that was read from garbage would not.
    assert time.monotonic() - begin < 20.0


@pytest.mark.parametrize("length", [0, 1, 7, 8, 9, 17, 64])
@pytest.mark.parametrize("kind", ["csv", "bag", "json"])
def test_a_stub_of_a_log_is_answered(workshop: Any, make: Any, kind: str, length: int) -> None:
    path = write(workshop, make, kind)
    path.write_bytes(path.read_bytes()[:length])

    with pytest.raises(SpecError, match=r"V30\d|V310"):
        workshop.read(path, x="/p.point.x")


@pytest.mark.parametrize("head", [b"\x89PNG\r\n\x1a\n", b"hello world\n", b"\x7fELF", bytes(100)])
def test_other_files_are_no_logs(workshop: Any, head: bytes) -> None:
    path = workshop.text(head + bytes(range(256)), "log.mcap")

    with pytest.raises(SpecError, match="V302"):
        workshop.read(path, x="/p.point.x")

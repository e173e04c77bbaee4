"""Logs are decoded while they are read: the same values from any batch, in bounded memory."""

import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import CompressionType

from runtime.program import Kind
from verifier.traces.files import csv_file, streams
from verifier.traces.inventory import inspect
from verifier.traces.read import read_trace
from verifier.traces.trace import Trace


def mixed_log(workshop: Any, make: Any) -> Path:
    """Odometry of frames of three lengths, and a JSON mode that is a text now and then."""
    notes = []
    for i in range(60):
        frame = "odom" * (i % 3)
        message = workshop.odometry(10.0 + i, x=float(i), yaw=0.1 * i, frame=frame)
        notes.append(workshop.cdr("/odom", 10.0 + i, message))
        notes.append(make.said("/mode", 10.0 + i, name=("go", "stop", None)[i % 3], n=i))
    path: Path = workshop.mcap(notes, compression=CompressionType.ZSTD, chunk_size=3000)
    return path


def read_mixed(make: Any, path: Path) -> Trace:
    states = [
        make.state("x"),
        make.state("h", Kind.PERIODIC),
        make.state("m", Kind.DISCRETE, values=("go", "stop")),
        make.state("n"),
    ]
    bindings = {
        "x": "/odom.pose.pose.position.x",
        "h": "/odom.pose.pose.orientation.@yaw",
        "m": "/mode.name",
        "n": "/mode.n",
    }
    return read_trace(path, make.program(states, bindings))


@pytest.mark.parametrize("size", [1, 500, 2000, 20_000])
def test_batches_of_any_size_give_the_same(
    workshop: Any, make: Any, monkeypatch: pytest.MonkeyPatch, size: int
) -> None:
    path = mixed_log(workshop, make)
    expected = read_mixed(make, path)

    monkeypatch.setattr(streams, "BATCH_BYTES", size)
    found = read_mixed(make, path)

    assert found.losses == expected.losses
    assert found.notes == expected.notes
    for name, series in expected.series.items():
        assert found.series[name].times.tolist() == series.times.tolist()
        assert found.series[name].values.tolist() == series.values.tolist()
    assert expected.series["x"].values.tolist() == list(range(60))


@pytest.mark.parametrize("size", [1, 40, 300])
def test_blocks_of_a_csv_file_of_any_size_give_the_same(
    workshop: Any, make: Any, monkeypatch: pytest.MonkeyPatch, size: int
) -> None:
    rows = "".join(f"{0.1 * i:.1f},{i},{'go' if i % 3 else 'stop'}\n" for i in range(200))
    path = workshop.text("t,x,do\n" + rows.replace("\n4.0,", "\n,").replace("\n5.0,", "\n5.0,7,"))
    mode = make.state("m", Kind.DISCRETE, values=("go", "stop"))
    program = make.program([make.state("x"), mode], {"x": "x", "m": "do"})
    expected = read_trace(path, program)

    monkeypatch.setattr(csv_file, "_BLOCK_BYTES", size)
    found = read_trace(path, program)

    assert found.losses == expected.losses
    for name, series in expected.series.items():
        assert found.series[name].values.tolist() == series.values.tolist()
    assert len(expected.series["x"].values) == 198


def test_memory_does_not_grow_with_the_payloads(workshop: Any, make: Any) -> None:
    # 4000 messages of 10 kB: 40 MB of payloads, of which one number each is wanted.
    ballast = "0" * 10_000
    notes = [make.said("/a", 0.1 * i, x=float(i), ballast=ballast) for i in range(4000)]
    path = workshop.mcap(notes, compression=CompressionType.ZSTD, chunk_size=1 << 18)
    del notes
    workshop.read(path, x="/a.x")

    tracemalloc.start()
    trace = workshop.read(path, x="/a.x")
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()

    assert trace.series["x"].values.tolist() == list(range(4000))
    assert most < 12e6


def test_an_inventory_reads_values_up_to_its_limit_only(
    workshop: Any, make: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    notes = [make.said("/a", 0.1 * i, x=float(i), ballast="0" * 1000) for i in range(100)]
    path = workshop.mcap(notes)
    monkeypatch.setattr("verifier.traces.inventory.BYTES_PER_TOPIC", 20_000)

    (topic,) = inspect(path).topics

    assert topic.count == 100
    assert topic.note == "values of the first 20 messages"
    assert topic.fields[0].high == 19.0


def test_progress_grows_to_the_whole(workshop: Any, make: Any) -> None:
    path = mixed_log(workshop, make)
    told: list[tuple[int, int]] = []
    bound = make.program([make.state("x")], {"x": "/odom.pose.pose.position.x"})

    read_trace(path, bound, progress=lambda done, whole: told.append((done, whole)))

    done = [one for one, _ in told]
    size = path.stat().st_size
    assert (np.diff(done) >= 0).all()
    assert {whole for _, whole in told} == {size}
    assert done[-1] > 0.95 * size

"""ROS 1 and ROS 2 bags, and the real recordings."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2

from runtime.program import Kind
from spec_schema.diagnostics import SpecError
from verifier.traces.inventory import inspect
from verifier.traces.read import read_trace
from verifier.traces.trace import Trace

RECORDINGS = Path(__file__).parents[3] / "specs" / "recordings"
ODOM = "/husky_velocity_controller/odom"
SECOND = 1_000_000_000
COUNT = 50


def write_bag2(path: Path, store: Any, plugin: StoragePlugin, odometry: Any) -> Path:
    with Writer2(path, version=9, storage_plugin=plugin) as writer:
        connection = writer.add_connection("/odom", "nav_msgs/msg/Odometry", typestore=store)
        for i in range(COUNT):
            message = odometry(10.0 + i, x=float(i), yaw=0.5 * i)
            payload = store.serialize_cdr(message, "nav_msgs/msg/Odometry")
            writer.write(connection, (10 + i) * SECOND + 5_000_000, payload)
    return path


@pytest.mark.parametrize("compression", [None, *Writer1.CompressionFormat])
def test_a_ros_1_bag_is_read(workshop: Any, compression: Any) -> None:
    path = workshop.bag1(compression)

    trace = workshop.read(path, x="/p.point.x")

    assert trace.series["x"].values.tolist() == list(range(COUNT))
    assert trace.series["x"].times.tolist() == list(range(COUNT))
    assert trace.series["x"].clock == "sensor"
    assert trace.losses == ()
    assert any("logged 5 ms after" in note for note in trace.notes)


@pytest.mark.parametrize("share", [0.4, 0.8, 0.98])
def test_a_cut_ros_1_bag_gives_what_is_before_the_cut(workshop: Any, share: float) -> None:
    path = workshop.bag1(count=500)
    data = path.read_bytes()
    path.write_bytes(data[: int(share * len(data))])

    trace = workshop.read(path, x="/p.point.x")

    found = trace.series["x"].values.tolist()
    assert found == list(range(len(found)))
    assert len(found) > 100
    assert trace.losses


def test_a_torn_chunk_of_a_ros_1_bag_is_said(workshop: Any) -> None:
    path = workshop.bag1(count=500)
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])

    trace = workshop.read(path, x="/p.point.x")

    assert {loss.cause for loss in trace.losses} == {"torn chunk", "file cut"}


def test_a_corrupt_chunk_of_a_ros_1_bag_is_said(workshop: Any) -> None:
    path = workshop.bag1(Writer1.CompressionFormat.BZ2)
    data = bytearray(path.read_bytes())
    place = data.find(b"BZh")
    data[place + 60] ^= 0xFF
    path.write_bytes(bytes(data))

    with pytest.raises(SpecError, match=r"(?s)V306.*corrupt chunk"):
        workshop.read(path, x="/p.point.x")


@pytest.mark.parametrize("plugin", list(StoragePlugin))
def test_a_ros_2_bag_is_read(workshop: Any, make: Any, plugin: StoragePlugin) -> None:
    path = write_bag2(workshop.folder / "bag", workshop.store, plugin, workshop.odometry)
    yaw = make.state("h", Kind.PERIODIC)
    bindings = {"x": "/odom.pose.pose.position.x", "h": "/odom.pose.pose.orientation.@yaw"}

    trace = read_trace(path, make.program([make.state("x"), yaw], bindings))

    assert trace.series["x"].values.tolist() == list(range(COUNT))
    # Unwrapped over four turns; the sine and cosine of half the angle went through the file.
    np.testing.assert_allclose(trace.series["h"].values, 0.5 * np.arange(COUNT), atol=1e-12)
    assert trace.losses == ()


def test_one_database_of_a_ros_2_bag_is_read_whatever_its_name(workshop: Any) -> None:
    bag = write_bag2(
        workshop.folder / "bag", workshop.store, StoragePlugin.SQLITE3, workshop.odometry
    )
    (database,) = bag.glob("*.db3")
    moved = database.rename(workshop.folder / "log.data")

    trace = workshop.read(moved, x="/odom.pose.pose.position.x")

    assert trace.series["x"].values.tolist() == list(range(COUNT))


def test_of_a_cut_database_the_rows_in_whole_pages_are_read(workshop: Any) -> None:
    bag = write_bag2(
        workshop.folder / "bag", workshop.store, StoragePlugin.SQLITE3, workshop.odometry
    )
    (database,) = bag.glob("*.db3")
    data = database.read_bytes()
    database.write_bytes(data[: len(data) * 3 // 4])

    trace = workshop.read(database, x="/odom.pose.pose.position.x")

    found = trace.series["x"].values.tolist()
    assert found == list(range(len(found)))
    assert len(found) >= COUNT // 2
    assert {"database damaged", "file cut", "unverified messages"} <= {
        loss.cause for loss in trace.losses
    }


def test_a_folder_without_a_log_is_refused(workshop: Any) -> None:
    with pytest.raises(SpecError, match="V302"):
        workshop.read(workshop.folder, x="/a.x")


def read_husky(make: Any, name: str) -> Trace:
    bindings = {
        "x": f"{ODOM}.pose.pose.position.x",
        "y": f"{ODOM}.pose.pose.position.y",
        "heading": f"{ODOM}.pose.pose.orientation.@yaw",
        "speed": make.binding("speed", f"{ODOM}.twist.twist.linear.x", delay=0.5),
        "turn": make.binding("turn", "/imu/data.angular_velocity.y", delay=0.1, scale=0.944),
    }
    states = [make.state("x"), make.state("y"), make.state("heading", Kind.PERIODIC)]
    program = make.program(states, bindings, controls=["speed", "turn"])
    return read_trace(RECORDINGS / "husky" / name, program)


def test_the_husky_drive_is_the_same_from_mcap_and_from_its_ros_1_bag(make: Any) -> None:
    mcap, bag = read_husky(make, "husky.mcap"), read_husky(make, "husky.bag")

    assert mcap.series.keys() == bag.series.keys()
    assert mcap.losses == bag.losses == ()
    assert mcap.start == bag.start
    for name, series in mcap.series.items():
        # The converter copied the doubles, so nothing may differ.
        np.testing.assert_array_equal(series.values, bag.series[name].values)
        np.testing.assert_array_equal(series.times, bag.series[name].times)


def test_the_husky_drive_is_as_its_readme_says(make: Any) -> None:
    trace = read_husky(make, "husky.mcap")
    x, y, heading = (trace.series[name] for name in ("x", "y", "heading"))

    assert len(x.times) == 3952
    assert len(trace.series["turn"].times) == 11865
    assert {series.clock for series in trace.series.values()} == {"sensor"}
    assert np.hypot(np.diff(x.values), np.diff(y.values)).sum() == pytest.approx(359.0, abs=1.0)
    assert np.abs(np.diff(heading.values)).max() < 0.2
    # Delays move a series back: the speed speaks of half a second earlier than its pose.
    assert trace.series["speed"].times[0] == 0.0
    assert x.times[0] == pytest.approx(0.5, abs=1e-9)


def test_the_scitos_run_is_as_its_readme_says(make: Any) -> None:
    actions = ("Move-Forward", "Slight-Right-Turn", "Sharp-Right-Turn", "Slight-Left-Turn")
    bindings = {
        "front": "front",
        "left": "left",
        "action": make.binding(
            "action", "action", values=tuple(zip(actions, range(4), strict=True))
        ),
    }
    states = [make.state("front"), make.state("left")]
    path = RECORDINGS / "scitos" / "wall_following.csv"

    trace = read_trace(path, make.program(states, bindings))

    front, left, action = (trace.series[name].values for name in ("front", "left", "action"))
    assert front.size == 5456
    assert trace.losses == ()
    explained = np.select([front <= 0.9, left > 0.9, left < 0.4965], [2.0, 3.0, 1.0], 0.0)
    # The README gives the third threshold as somewhere in 0.494 to 0.499.
    unsure = (left > 0.493) & (left < 0.4995)
    np.testing.assert_array_equal(action[~unsure], explained[~unsure])


@pytest.mark.parametrize(("name", "kind"), [("husky.mcap", "MCAP"), ("husky.bag", "ROS 1 bag")])
def test_the_inventory_of_the_husky_drive(name: str, kind: str) -> None:
    found = inspect(RECORDINGS / "husky" / name)

    assert found.kind == kind
    assert found.messages == 16806
    assert found.duration == pytest.approx(395.0, abs=1.0)
    assert {topic.name: topic.count for topic in found.topics} == {
        "/fix": 989,
        ODOM: 3952,
        "/imu/data": 11865,
    }
    odometry = next(topic for topic in found.topics if topic.name == ODOM)
    assert odometry.rate == pytest.approx(10.0, abs=0.2)
    fields = {field.path: field for field in odometry.fields}
    assert fields[f"{ODOM}.twist.twist.linear.x"].high == pytest.approx(1.0, abs=0.05)
    assert fields[f"{ODOM}.pose.pose.orientation.@yaw"].first == pytest.approx(-0.2728, abs=1e-4)
    assert fields[f"{ODOM}.child_frame_id"].texts == ("base_link",)
    assert not any("stamp" in path for path in fields)

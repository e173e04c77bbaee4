"""Odometry out of a zstd MCAP into arrays, beside rosbags and mcap-ros2-support, in one run.

`make bench` takes 100,000 messages, `--full` a million. Every reader gives the same six numbers
of every message and its stamp, on its best path, and all compare the chunks' checksums (rosbags
has no such option). CPU time of this process, as it is given out to all its threads.
"""
# ruff: noqa: T201 - a bench prints

import argparse
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from tests.study.bound import bound
from verifier.traces.read import read_trace

TYPE = "nav_msgs/msg/Odometry"
PATHS = {
    "x": "/odom.pose.pose.position.x",
    "y": "/odom.pose.pose.position.y",
    "qz": "/odom.pose.pose.orientation.z",
    "qw": "/odom.pose.pose.orientation.w",
    "v": "/odom.twist.twist.linear.x",
    "w": "/odom.twist.twist.angular.z",
}

Numbers = npt.NDArray[np.float64]


def write(path: Path, count: int) -> None:
    """Odometry at 100 Hz, with other numbers in every message."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    types = store.types
    text, _ = store.generate_msgdef(TYPE, ros_version=2)
    message = types[TYPE](
        header=types["std_msgs/msg/Header"](
            stamp=types["builtin_interfaces/msg/Time"](sec=1, nanosec=2), frame_id="odom"
        ),
        child_frame_id="base_link",
        pose=types["geometry_msgs/msg/PoseWithCovariance"](
            pose=types["geometry_msgs/msg/Pose"](
                position=types["geometry_msgs/msg/Point"](x=3.0, y=4.0, z=0.0),
                orientation=types["geometry_msgs/msg/Quaternion"](x=0.0, y=0.0, z=5.0, w=6.0),
            ),
            covariance=np.full(36, 0.01),
        ),
        twist=types["geometry_msgs/msg/TwistWithCovariance"](
            twist=types["geometry_msgs/msg/Twist"](
                linear=types["geometry_msgs/msg/Vector3"](x=7.0, y=0.0, z=0.0),
                angular=types["geometry_msgs/msg/Vector3"](x=0.0, y=0.0, z=8.0),
            ),
            covariance=np.full(36, 0.02),
        ),
    )
    template = bytes(store.serialize_cdr(message, TYPE))
    places = [template.index(np.float64(value).tobytes()) for value in (3, 4, 5, 6, 7, 8)]
    rng = np.random.default_rng(1)
    numbers = np.cumsum(rng.normal(0.0, 0.01, (count, 6)), axis=0)
    writer = Writer(str(path), compression=CompressionType.ZSTD)
    writer.start(profile="ros2")
    schema = writer.register_schema(TYPE, "ros2msg", text.encode())
    channel = writer.register_channel("/odom", "cdr", schema)
    for i in range(count):
        stamp = 10_000_000_000 + i * 10_000_000
        payload = bytearray(template)
        payload[4:8] = (stamp // 10**9).to_bytes(4, "little")
        payload[8:12] = (stamp % 10**9).to_bytes(4, "little")
        for place, number in zip(places, numbers[i], strict=True):
            payload[place : place + 8] = number.tobytes()
        writer.add_message(channel, stamp + 1_000_000, bytes(payload), stamp)
    writer.finish()


def by_specc(path: Path) -> Numbers:
    """This project's reader, with ordering, clocks and all."""
    trace = read_trace(path, bound(PATHS))
    assert not trace.losses
    return np.stack([trace.series[name].values for name in PATHS])


def numbers_of(message: object) -> tuple[float, ...]:
    """The six numbers of a message object of either peer."""
    pose, twist = message.pose.pose, message.twist.twist  # type: ignore[attr-defined]  # by name
    return (
        pose.position.x, pose.position.y, pose.orientation.z, pose.orientation.w,
        twist.linear.x, twist.angular.z, message.header.stamp.nanosec,  # type: ignore[attr-defined]  # by name
    )  # fmt: skip


def by_rosbags(path: Path) -> Numbers:
    """rosbags, deserializing message by message."""
    with AnyReader([path]) as reader:
        rows = [
            numbers_of(reader.deserialize(raw, connection.msgtype))
            for connection, _, raw in reader.messages()
        ]
    return np.array(rows)[:, :6].T


def by_mcap(path: Path) -> Numbers:
    """mcap with mcap-ros2-support, in file order, checksums compared."""
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        found = reader.iter_decoded_messages(topics=["/odom"], log_time_order=False)
        rows = [numbers_of(decoded.decoded_message) for decoded in found]
    return np.array(rows)[:, :6].T


def timed(read: Callable[[Path], Numbers], path: Path, rounds: int) -> tuple[float, Numbers]:
    """The least CPU seconds of some rounds, and what was read."""
    best = np.inf
    for _ in range(rounds):
        begin = time.process_time()
        found = read(path)
        best = min(best, time.process_time() - begin)
    return float(best), found


def main() -> None:
    """Prints CPU seconds, messages a second, and the ratios."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--full", action="store_true", help="a million messages")
    count = 1_000_000 if parser.parse_args().full else 100_000
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "odometry.mcap"
        write(path, count)
        print(f"{count} {TYPE} in {path.stat().st_size / 1e6:.0f} MB of MCAP (zstd)")
        own, expected = timed(by_specc, path, 3)
        print(f"{'specc':<24}{own:8.2f} s {count / own / 1e3:8.0f} k/s")
        for name, read in (("rosbags", by_rosbags), ("mcap + ros2-support", by_mcap)):
            took, found = timed(read, path, 1)
            assert np.array_equal(found, expected), "the readers disagree"
            print(
                f"{name:<24}{took:8.2f} s {count / took / 1e3:8.0f} k/s  specc: 1/{took / own:.0f}"
            )


if __name__ == "__main__":
    main()

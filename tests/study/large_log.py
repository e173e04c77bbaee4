"""Memory and time on an MCAP file of 2 GB with ten million messages: `make bench-large`.

The file is made for the purpose, once: odometry at 50 Hz, an IMU at 200 Hz and commands at 20 Hz
of a drive of many hours, and opaque blocks beside them that nobody asks for. What is measured is
the memory that is the process's own (`RssAnon`; pages of the file that the system keeps are not),
above what it had before, and the processor's time.
"""

import argparse
import struct
import threading
import time
import zlib
from pathlib import Path
from typing import Self

import numpy as np
import numpy.typing as npt
import zstandard
from rosbags.typesys import Stores, get_typestore

from tests.study.bound import bound
from verifier.traces.inventory import inspect
from verifier.traces.read import read_trace

TOPICS = {
    "/odom": "geometry_msgs/msg/TwistStamped",
    "/imu": "geometry_msgs/msg/Vector3Stamped",
    "/cmd": "geometry_msgs/msg/Vector3Stamped",
}
MAGIC = b"\x89MCAP0\r\n"
A_CHUNK = 5_000
Places = npt.NDArray[np.int64]
PATHS = {
    "v": "/odom.twist.linear.x",
    "w": "/odom.twist.angular.z",
    "a": "/imu.vector.x",
    "b": "/imu.vector.y",
    "u": "/cmd.vector.z",
}


def record(opcode: int, body: bytes) -> bytes:
    """A record of MCAP."""
    return struct.pack("<BQ", opcode, len(body)) + body


def text(value: str | bytes) -> bytes:
    """A text of MCAP, or other bytes with their length."""
    raw = value.encode() if isinstance(value, str) else value
    return struct.pack("<I", len(raw)) + raw


def declarations() -> bytes:
    """The channels 1 to 3 with their schemas, and 4 of opaque blocks."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    parts = []
    for number, (topic, name) in enumerate(TOPICS.items(), 1):
        definition, _ = store.generate_msgdef(name, ros_version=2)
        schema = struct.pack("<H", number) + text(name) + text("ros2msg") + text(definition)
        parts.append(record(3, schema))
        channel = struct.pack("<HH", number, number) + text(topic) + text("cdr") + bytes(4)
        parts.append(record(4, channel))
    blocks = struct.pack("<HH", 4, 0) + text("/blocks") + text("raw") + bytes(4)
    return b"".join([*parts, record(4, blocks)])


def template(block: int) -> tuple[bytearray, Places, Places, Places]:
    """A chunk without numbers; where its log times stand, its stamps, and its numbers."""
    chunk = bytearray()
    times, stamps, numbers = [], [], []
    for i in range(A_CHUNK):
        kind = 4 if i % 100 == 0 else 1 if i % 27 < 5 else 2 if i % 27 < 25 else 3
        count = (0, 6, 3, 3, 0)[kind]
        head = b"\0\1\0\0" + bytes(8) + struct.pack("<I", 1) + bytes(4) + bytes(8 * count)
        payload = bytes(block) if kind == 4 else head
        begin = len(chunk) + 9
        chunk += record(5, struct.pack("<HIQQ", kind, i, 0, 0) + payload)
        times.append(begin + 6)
        stamps.append(begin + 22 + 4 if kind != 4 else -1)
        numbers += [begin + 22 + 20 + 8 * k for k in range(count)]
        if kind == 4:
            numbers += [begin + 22 + 8 * k for k in range(block // 8)]
    return chunk, np.array(times), np.array(stamps), np.array(numbers)


def put(chunk: npt.NDArray[np.uint8], places: Places, values: npt.NDArray[np.generic]) -> None:
    """Writes each value's bytes at its place."""
    raw = values[:, None].view(np.uint8)
    chunk[places[:, None] + np.arange(raw.shape[1])] = raw


def write(path: Path, count: int, block: int) -> None:
    """`count` messages; every hundredth is an opaque block of `block` bytes."""
    rng = np.random.default_rng(1)
    pattern, times, stamps, numbers = template(block)
    stamped = stamps >= 0
    with path.open("wb") as file:
        file.write(MAGIC + record(1, text("ros2") + text("study")) + declarations())
        for first in range(0, count, A_CHUNK):
            chunk = np.frombuffer(bytes(pattern), dtype=np.uint8).copy()
            now = 10**18 + (first + np.arange(A_CHUNK)) * (10**9 // 270)
            put(chunk, times, now)
            put(chunk, times + 8, now)
            put(chunk, stamps[stamped], (now[stamped] // 10**9).astype(np.uint32))
            put(chunk, stamps[stamped] + 4, (now[stamped] % 10**9).astype(np.uint32))
            put(chunk, numbers, rng.random(numbers.size))
            inside = chunk.tobytes()
            packed = zstandard.ZstdCompressor(level=1).compress(inside)
            head = struct.pack("<QQQI", now[0], now[-1], len(inside), zlib.crc32(inside))
            packing = text("zstd") + struct.pack("<Q", len(packed))
            file.write(record(6, head + packing + packed))
        file.write(record(15, bytes(4)) + record(2, bytes(20)) + MAGIC)


def own_memory() -> int:
    """The process's own memory in bytes."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) << 10 for line in lines if line.startswith("RssAnon"))


class Watch:
    """The most of its own memory that the process has while this is open."""

    def __enter__(self) -> Self:
        self.before = self.most = own_memory()
        self.open = True
        self.thread = threading.Thread(target=self._look)
        self.thread.start()
        self.begin = time.process_time()
        return self

    def __exit__(self, *_: object) -> None:
        self.took = time.process_time() - self.begin
        self.open = False
        self.thread.join()

    def _look(self) -> None:
        while self.open:
            self.most = max(self.most, own_memory())
            time.sleep(0.02)


def main() -> None:
    """Prints a line for reading for a spec, and one for an inventory."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--messages", type=int, default=10_000_000)
    parser.add_argument("--block", type=int, default=16_000, help="bytes of each opaque block")
    parser.add_argument("--file", type=Path, default=Path("out/large.mcap"))
    chosen = parser.parse_args()
    if not chosen.file.exists():
        chosen.file.parent.mkdir(parents=True, exist_ok=True)
        begin = time.monotonic()
        write(chosen.file, chosen.messages, chosen.block)
        print(f"written in {time.monotonic() - begin:.0f} s")
    size = chosen.file.stat().st_size
    print(f"{chosen.file}: {size / 1e9:.2f} GB")
    with Watch() as watch:
        trace = read_trace(chosen.file, bound(PATHS))
    count = sum(series.times.size for series in trace.series.values())
    told = f"{watch.took:.1f} s CPU, {(watch.most - watch.before) / 1e6:.0f} MB above before"
    print(f"read for a spec: {count} values, {len(trace.losses)} losses, {told}")
    del trace
    with Watch() as watch:
        found = inspect(chosen.file)
    told = f"{watch.took:.1f} s CPU, {(watch.most - watch.before) / 1e6:.0f} MB above before"
    print(f"inventory: {found.messages} messages of {len(found.topics)} topics, {told}")


if __name__ == "__main__":
    main()

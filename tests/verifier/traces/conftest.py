"""Logs of a few kilobytes, written by the tests themselves, and programs to read them for."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias, final

import numpy as np
import pytest
from mcap.writer import CompressionType, Writer
from rosbags.rosbag1 import Writer as Writer1
from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.store import Typestore

from runtime.program import (
    Binding,
    Control,
    Field,
    Kind,
    Origin,
    Program,
    Role,
    State,
    Unit,
)
from verifier.traces.read import ClockWish, read_trace
from verifier.traces.trace import Trace

METRE = Unit("m", 1.0)
SECOND = 1_000_000_000

Bindings: TypeAlias = Mapping[str, str | Binding]


def binding(name: str, path: str, **changes: object) -> Binding:
    values: dict[str, object] = {
        "unit": METRE,
        "delay": 0.0,
        "scale": 1.0,
        "offset": 0.0,
        "constant": None,
        "values": (),
        "origin": "spec.yaml:1:1",
    }
    return Binding(name=name, path=path, **(values | changes))  # type: ignore[arg-type]  # checked by the tests


def state(
    name: str, kind: Kind = Kind.CONTINUOUS, role: Role = Role.BOTH, **changes: object
) -> State:
    values: dict[str, object] = {
        "unit": METRE,
        "low": -np.pi,
        "high": np.pi,
        "hold": 0.0,
        "closure": None,
        "values": (),
        "relates": ("agent", "world"),
        "about": "",
        "origin": "spec.yaml:1:1",
    }
    return State(name=name, kind=kind, role=role, **(values | changes))  # type: ignore[arg-type]  # checked by the tests


def program(
    states: Sequence[State],
    bindings: Bindings,
    controls: Sequence[str] = (),
    name: str = "drive",
    text: str = "",
) -> Program:
    bound = tuple(
        binding(key, value) if isinstance(value, str) else value for key, value in bindings.items()
    )
    driven = tuple(one.name for one in states if one.is_driven)
    return Program(
        name=name,
        about="",
        states=tuple(states),
        controls=tuple(Control(c, METRE, -1.0, 1.0, 0.0, "", "spec.yaml:1:1") for c in controls),
        constants=(),
        outputs=(),
        field=Field(driven, "formula", 0.0, (), (), (), None, ""),
        fidelity=None,
        bindings=bound,
        judge_when=None,
        realizes=(),
        feasibility=None,
        source=Origin("spec.yaml", text, ""),
    )


@final
@dataclass(frozen=True, slots=True)
class Note:
    """A message: topic, log time in seconds, payload, and how it is encoded."""

    topic: str
    time: float
    payload: bytes
    encoding: str = "json"
    schema: str = ""
    schema_encoding: str = "jsonschema"
    schema_text: str = "{}"


def said(topic: str, time: float, **fields: object) -> Note:
    return Note(topic, time, json.dumps(fields).encode())


@final
@dataclass(frozen=True, slots=True)
class Workshop:
    """Writes logs into a folder and reads them."""

    folder: Path
    store: Typestore

    def mcap(
        self,
        notes: Sequence[Note],
        name: str = "log.mcap",
        compression: CompressionType = CompressionType.NONE,
        chunk_size: int = 1024,
        attachments: Mapping[str, bytes] | None = None,
        silent: Sequence[str] = (),
        **options: bool,
    ) -> Path:
        path = self.folder / name
        writer = Writer(str(path), chunk_size=chunk_size, compression=compression, **options)
        writer.start()
        channels: dict[tuple[str, str], int] = {}
        for key, data in (attachments or {}).items():
            writer.add_attachment(0, 0, key, "application/zip", data)
        for topic in silent:
            writer.register_channel(topic, "json", 0)
        for note in notes:
            key = (note.topic, note.encoding + note.schema)
            if key not in channels:
                number = 0
                if note.schema or note.encoding == "json":
                    text = note.schema_text.encode()
                    number = writer.register_schema(
                        note.schema or "object", note.schema_encoding, text
                    )
                channels[key] = writer.register_channel(note.topic, note.encoding, number)
            time = round(note.time * SECOND)
            writer.add_message(channels[key], time, note.payload, time)
        writer.finish()
        return path

    def cdr(self, topic: str, time: float, message: object) -> Note:
        name: str = message.__msgtype__  # type: ignore[attr-defined]  # made by rosbags
        text, _ = self.store.generate_msgdef(name, ros_version=2)
        payload = bytes(self.store.serialize_cdr(message, name))
        return Note(topic, time, payload, "cdr", name, "ros2msg", text)

    def odometry(
        self,
        stamp: float,
        x: float = 0.0,
        y: float = 0.0,
        yaw: float = 0.0,
        speed: float = 0.0,
        frame: str = "odom",
    ) -> object:
        types = self.store.types
        point = types["geometry_msgs/msg/Point"](x=x, y=y, z=0.0)
        quaternion = types["geometry_msgs/msg/Quaternion"](
            x=0.0, y=0.0, z=np.sin(yaw / 2.0), w=np.cos(yaw / 2.0)
        )
        zero = types["geometry_msgs/msg/Vector3"](x=0.0, y=0.0, z=0.0)
        linear = types["geometry_msgs/msg/Vector3"](x=speed, y=0.0, z=0.0)
        whole = round(stamp * SECOND)
        time = types["builtin_interfaces/msg/Time"](sec=whole // SECOND, nanosec=whole % SECOND)
        return types["nav_msgs/msg/Odometry"](
            header=types["std_msgs/msg/Header"](stamp=time, frame_id=frame),
            child_frame_id="base",
            pose=types["geometry_msgs/msg/PoseWithCovariance"](
                pose=types["geometry_msgs/msg/Pose"](position=point, orientation=quaternion),
                covariance=np.zeros(36),
            ),
            twist=types["geometry_msgs/msg/TwistWithCovariance"](
                twist=types["geometry_msgs/msg/Twist"](linear=linear, angular=zero),
                covariance=np.zeros(36),
            ),
        )

    def bag1(
        self,
        compression: Writer1.CompressionFormat | None = None,
        count: int = 50,
        chunk: int | None = None,
    ) -> Path:
        """Points stamped every second, logged 5 ms later; `chunk` of them together."""
        store = get_typestore(Stores.ROS1_NOETIC)
        kind = store.types["geometry_msgs/msg/PointStamped"]
        header = store.types["std_msgs/msg/Header"]
        time = store.types["builtin_interfaces/msg/Time"]
        point = store.types["geometry_msgs/msg/Point"]
        writer = Writer1(self.folder / "log.bag")
        if chunk:
            writer.chunk_threshold = 150 * chunk
        if compression:
            writer.set_compression(compression)
        with writer:
            connection = writer.add_connection("/p", kind.__msgtype__, typestore=store)
            for i in range(count):
                stamp = time(sec=10 + i, nanosec=0)
                message = kind(
                    header=header(seq=i, stamp=stamp, frame_id="map" * (i % 3)),
                    point=point(x=float(i), y=0.0, z=0.0),
                )
                payload = store.serialize_ros1(message, kind.__msgtype__)
                writer.write(connection, (10 + i) * SECOND + 5_000_000, payload)
        return self.folder / "log.bag"

    def text(self, content: str | bytes, name: str = "log.csv") -> Path:
        path = self.folder / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    def read(
        self, path: Path, clock: ClockWish = "auto", *, strict: bool = False, **bindings: str
    ) -> Trace:
        """The trace of states of these names, bound so."""
        bound = program([state(name) for name in bindings], bindings)
        return read_trace(path, bound, clock, strict=strict)


@pytest.fixture(scope="session")
def store() -> Typestore:
    return get_typestore(Stores.ROS2_HUMBLE)


@pytest.fixture
def workshop(tmp_path: Path, store: Typestore) -> Workshop:
    return Workshop(tmp_path, store)


@pytest.fixture(scope="session")
def make() -> "type[Make]":
    return Make


@final
class Make:
    """Parts of programs and logs."""

    binding = staticmethod(binding)
    state = staticmethod(state)
    program = staticmethod(program)
    said = staticmethod(said)
    note = Note

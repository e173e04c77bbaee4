"""Protobuf, XCDR2 and ULog: read as their own formats say, against bytes that are made here."""

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from google.protobuf import timestamp_pb2
from google.protobuf.descriptor_pb2 import (
    DescriptorProto,
    FieldDescriptorProto,
    FileDescriptorProto,
    FileDescriptorSet,
)
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.message_factory import GetMessageClass

from runtime.program import Kind
from spec_schema.diagnostics import SpecError
from verifier.traces.files.log import Wanted
from verifier.traces.files.ulog_file import read_ulog
from verifier.traces.inventory import inspect
from verifier.traces.messages.channel import Channel
from verifier.traces.messages.definitions import definition
from verifier.traces.messages.leaves import list_fields
from verifier.traces.messages.protobuf_messages import Protobuf
from verifier.traces.messages.wire import decode
from verifier.traces.read import read_trace

F = FieldDescriptorProto
ULOG = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 1_000_000)


def descriptors() -> FileDescriptorSet:
    """robot.Pose: timestamp, position {x, y}, a list of numbers, a mode."""
    file = FileDescriptorProto(name="robot.proto", package="robot", syntax="proto3")
    file.dependency.append("google/protobuf/timestamp.proto")
    point = DescriptorProto(name="Point")
    for number, name in enumerate("xy", 1):
        point.field.add(name=name, number=number, type=F.TYPE_DOUBLE, label=F.LABEL_OPTIONAL)
    pose = DescriptorProto(name="Pose")
    one = F.LABEL_OPTIONAL
    pose.field.add(
        name="timestamp", number=1, type=F.TYPE_MESSAGE, label=one,
        type_name=".google.protobuf.Timestamp",
    )  # fmt: skip
    pose.field.add(
        name="position", number=2, type=F.TYPE_MESSAGE, label=one, type_name=".robot.Point"
    )
    pose.field.add(name="ranges", number=3, type=F.TYPE_FLOAT, label=F.LABEL_REPEATED)
    pose.field.add(name="mode", number=4, type=F.TYPE_ENUM, label=one, type_name=".robot.Mode")
    mode = file.enum_type.add(name="Mode")
    mode.value.add(name="IDLE", number=0)
    mode.value.add(name="DRIVE", number=1)
    file.message_type.extend([point, pose])
    stamps = FileDescriptorProto()
    timestamp_pb2.DESCRIPTOR.CopyToProto(stamps)
    # The file that needs the other comes first: the order in a log is not ours.
    return FileDescriptorSet(file=[file, stamps])


def protobuf_log(workshop: Any, make: Any, count: int = 40) -> Path:
    found = descriptors()
    pool = DescriptorPool()
    for file in reversed(found.file):
        pool.Add(file)
    kind = GetMessageClass(pool.FindMessageTypeByName("robot.Pose"))
    writer_notes = []
    for i in range(count):
        message: Any = kind(ranges=[0.5, float(i)] if i % 2 else [float(i)], mode=i % 2)
        message.timestamp.seconds, message.timestamp.nanos = 10 + i, 5
        if i != 3:
            message.position.x = float(i)
        payload = message.SerializeToString()
        writer_notes.append(make.note("/pose", 10.1 + i, payload, "protobuf", "robot.Pose"))
    return proto_mcap(workshop.folder / "p.mcap", writer_notes, found.SerializeToString())


def proto_mcap(path: Path, notes: list[Any], schema: bytes) -> Path:
    from mcap.writer import Writer

    writer = Writer(str(path))
    writer.start()
    number = writer.register_schema("robot.Pose", "protobuf", schema)
    channel = writer.register_channel("/pose", "protobuf", number)
    for note in notes:
        time = round(note.time * 1e9)
        writer.add_message(channel, time, note.payload, time)
    writer.finish()
    return path


def test_protobuf_messages_are_read_by_the_descriptors_in_the_log(workshop: Any, make: Any) -> None:
    path = protobuf_log(workshop, make)

    trace = workshop.read(path, x="/pose.position.x", r="/pose.ranges[-1]", s="/pose.ranges[1]")

    # A message that lacks its position has no x; one that lacks y has y's default, 0.
    assert trace.series["x"].values.tolist() == [i for i in range(40) if i != 3]
    assert trace.series["r"].values.tolist() == list(range(40))
    assert trace.series["s"].values.tolist() == list(range(1, 40, 2))
    assert trace.series["r"].clock == "sensor"
    assert trace.start == pytest.approx(10.000000005, abs=1e-12)
    assert {loss.cause for loss in trace.losses} == {"no finite value"}
    assert [loss.count for loss in trace.losses] == [1, 20]


def test_the_values_of_an_enumeration_are_texts(workshop: Any, make: Any) -> None:
    path = protobuf_log(workshop, make)
    bound = make.binding("mode", "/pose.mode", values=(("IDLE", 0), ("DRIVE", 1)))
    mode = make.state("mode", Kind.DISCRETE, values=("idle", "drive"))

    trace = read_trace(path, make.program([mode], {"mode": bound}))

    assert trace.series["mode"].values.tolist() == [i % 2 for i in range(40)]


def test_the_fields_of_protobuf_messages_are_listed(workshop: Any, make: Any) -> None:
    (topic,) = inspect(protobuf_log(workshop, make)).topics

    paths = [field.path for field in topic.fields]
    assert paths[:3] == ["/pose.position.x", "/pose.position.y", "/pose.ranges[0]"]
    assert "/pose.mode" in paths
    assert topic.rate == pytest.approx(1.0)


def test_a_torn_protobuf_message_is_counted(workshop: Any, make: Any) -> None:
    path = protobuf_log(workshop, make, 5)
    good = descriptors().SerializeToString()
    bad = [make.note("/pose", 1.0, b"\x12\xff\xff", "protobuf")]
    bad += [make.note("/pose", 2.0 + i, b"\x12\x09\x09" + bytes(8), "protobuf") for i in range(3)]

    trace = workshop.read(proto_mcap(path, bad, good), "log", x="/pose.position.x")

    assert trace.series["x"].values.tolist() == [0.0] * 3
    assert [(loss.cause, loss.count) for loss in trace.losses] == [("unreadable messages", 1)]


@pytest.mark.parametrize("schema", [b"", b"\xff\xff\xff", b"\x0a\x02\x0a\x00"])
def test_descriptors_that_are_none_are_refused(workshop: Any, make: Any, schema: bytes) -> None:
    path = proto_mcap(
        workshop.folder / "p.mcap", [make.note("/pose", 1.0, b"", "protobuf")], schema
    )

    with pytest.raises(SpecError, match=r"V311.*robot\.Pose"):
        workshop.read(path, x="/pose.position.x")


TEXT = "uint8 a\nfloat64 b\nItem[] items\nint64 c\n" + "=" * 80 + "\nMSG: p/Item\nfloat32 v\n"


@pytest.mark.parametrize("order", ["<", ">"])
def test_xcdr2_aligns_to_four_bytes_and_sizes_its_lists(order: str) -> None:
    # DDS-XTypes 1.3, 7.4.3.5: a, three bytes of padding, b at 4; the size of the list (12 bytes),
    # its length, two floats; c at 28, which plain CDR would have put at 32.
    body = struct.pack(f"{order}B3xdIIffq", 7, 2.5, 12, 2, 0.5, 1.5, -9)
    payload = (b"\0\7" if order == "<" else b"\0\6") + b"\0\0" + body
    root = definition("p/Thing", "ros2msg", TEXT)
    asked = [("a",), ("b",), ("items", 1, "v"), ("c",)]

    decoded = decode([payload] * 3, "cdr", root, asked)

    assert decoded.readable.all()
    assert [column.numbers.tolist() for column in decoded.columns] == [
        [7.0] * 3, [2.5] * 3, [1.5] * 3, [-9.0] * 3,
    ]  # fmt: skip


def test_delimited_xcdr2_is_refused_by_name() -> None:
    root = definition("p/Thing", "ros2msg", TEXT)

    decoded = decode([b"\0\x09\0\0" + bytes(40)], "cdr", root, [("a",)])

    assert not decoded.readable.any()
    assert "0x0009" in decoded.reason


def ulog(kind: str, body: bytes) -> bytes:
    return struct.pack("<HB", len(body), ord(kind)) + body


def attitude(i: int, key: int = 3) -> bytes:
    """Turned about z by a tenth of a radian more each time, after PX4's order w, x, y, z."""
    half = 0.05 * i
    values = struct.pack("<Q4ff", 5_000_000 + 20_000 * i, np.cos(half), 0, 0, np.sin(half), i)
    return ulog("D", struct.pack("<H", key) + values)


FORMATS = ulog(
    "F", b"vehicle_attitude:uint64_t timestamp;float[4] q;float speed;uint8_t[4] _padding0;"
)
ADDED = ulog("A", struct.pack("<BH", 0, 3) + b"vehicle_attitude")
SECOND_ONE = ulog("A", struct.pack("<BH", 1, 4) + b"vehicle_attitude")


def ulog_file(workshop: Any, *parts: bytes) -> Path:
    path: Path = workshop.text(ULOG + FORMATS + ADDED + SECOND_ONE + b"".join(parts), "log.ulg")
    return path


def read_yaw(make: Any, path: Path) -> Any:
    yaw = make.state("h", Kind.PERIODIC)
    bindings = {"h": "vehicle_attitude.q.@yaw", "v": "vehicle_attitude.speed"}
    return read_trace(path, make.program([yaw, make.state("v")], bindings))


def test_ulog_is_read_with_its_quaternions_in_their_own_order(workshop: Any, make: Any) -> None:
    path = ulog_file(workshop, *(attitude(i) for i in range(100)), attitude(7, key=4))

    trace = read_yaw(make, path)

    # Single precision; unwrapped over more than one turn.
    np.testing.assert_allclose(trace.series["h"].values, 0.1 * np.arange(100), atol=1e-5)
    assert trace.series["v"].values.tolist() == list(range(100))
    assert trace.start == 5.0
    np.testing.assert_allclose(trace.series["v"].times, 0.02 * np.arange(100), atol=1e-9)
    assert trace.losses == ()
    assert [topic.name for topic in inspect(path).topics] == [
        "vehicle_attitude", "vehicle_attitude/1",
    ]  # fmt: skip


def test_dropouts_of_the_logger_are_losses(workshop: Any, make: Any) -> None:
    drop = ulog("O", struct.pack("<H", 120))

    trace = read_yaw(make, ulog_file(workshop, attitude(0), drop, attitude(1), drop, attitude(2)))

    assert [(loss.cause, loss.count) for loss in trace.losses] == [("dropouts of the logger", 240)]


def test_a_damaged_ulog_is_read_on_from_the_next_mark(workshop: Any, make: Any) -> None:
    mark = ulog("S", b"\x2f\x73\x13\x20\x25\x0c\xbb\x12")
    path = ulog_file(
        workshop, *map(attitude, range(10)), b"\xff" * 50, *map(attitude, range(10, 12)), mark,
        *map(attitude, range(12, 20)), attitude(20)[:-3],
    )  # fmt: skip

    trace = read_yaw(make, path)

    assert trace.series["v"].values.tolist() == [*range(10), *range(12, 20)]
    assert {loss.cause for loss in trace.losses} >= {"damaged bytes"}


def test_a_type_that_holds_itself_many_times_does_not_grow_without_end() -> None:
    """A stranger's 16 fields of the type itself would be 16 ** 12 structs, one by one."""
    schema = FileDescriptorSet()
    file = schema.file.add(name="a.proto", syntax="proto3")
    message = file.message_type.add(name="A")
    for i in range(16):
        message.field.add(name=f"a{i}", number=i + 1, label=1, type=F.TYPE_MESSAGE, type_name=".A")
    channel = Channel("/a", "A", "protobuf", "protobuf", schema.SerializeToString())

    assert list_fields(Protobuf(channel).root) == ()


def test_channels_of_a_ulog_share_the_formats_before_them(workshop: Any) -> None:
    """Thousands of subscriptions, each with its own copy of all formats, would fill the memory."""
    path = ulog_file(workshop, attitude(0), attitude(0, key=4))

    first, second = read_ulog(path, Wanted(None, None), lambda _done, _of: None).streams

    assert first.channel.schema is second.channel.schema


def test_formats_and_subscriptions_in_turn_do_not_fill_the_memory(
    workshop: Any, make: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each subscription after a new format would be given a copy of all formats before it."""
    monkeypatch.setattr("verifier.traces.files.ulog_file.MOST_FORMATS", 10_000)
    turns = [
        ulog("F", b"t%03d:uint64_t timestamp;" % i) + ulog("A", struct.pack("<BH", 0, 9 + i) + b"t")
        for i in range(100)
    ]
    path = ulog_file(workshop, attitude(0), *turns, attitude(1))

    streams = read_ulog(path, Wanted(None, None), lambda _done, _of: None).streams
    trace = read_yaw(make, path)

    assert sum(len(stream.channel.schema) for stream in streams) <= 10_000
    assert trace.series["v"].values.tolist() == [0, 1]
    [loss] = trace.losses
    assert loss.cause == "formats left out"
    assert 20 < loss.count < 100

"""What a log holds, as the user sees it before there is a spec."""

from typing import Any

import numpy as np
import pytest

from spec_schema.diagnostics import SpecError
from verifier.traces.inventory import inspect
from verifier.traces.messages.definitions import definition
from verifier.traces.messages.leaves import list_fields, list_quaternions
from verifier.traces.messages.paths import parse_path


def test_short_lists_are_shown_whole_and_long_ones_by_their_first_item() -> None:
    text = "float64[3] short\nfloat64[36] long\nfloat64[] any\ngeometry_msgs/Point[] points\n"
    text += "=" * 80 + "\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n"

    fields = list_fields(definition("a/msg/B", "ros2msg", text))

    assert [steps for steps in fields if steps[0] == "short"] == [("short", i) for i in range(3)]
    assert [steps for steps in fields if steps[0] == "long"] == [("long", 0)]
    assert len([steps for steps in fields if steps[0] == "any"]) == 8
    assert [steps for steps in fields if steps[0] == "points"] == [("points", 0, n) for n in "xyz"]


def test_quaternions_are_found_and_stamps_are_left_out() -> None:
    root = definition("nav_msgs/msg/Odometry", "", "")

    assert list_quaternions(root) == (("pose", "pose", "orientation"),)
    assert not any("stamp" in steps for steps in list_fields(root))


def test_every_listed_path_can_be_bound(workshop: Any) -> None:
    notes = [workshop.cdr("/odom", 5.0 + i, workshop.odometry(5.0 + i, x=i)) for i in range(5)]
    path = workshop.mcap(notes)
    (topic,) = inspect(path).topics

    numbers = [field for field in topic.fields if not field.is_text]
    trace = workshop.read(path, **{f"v{i}": field.path for i, field in enumerate(numbers)})

    assert len(numbers) == 13 + 1 + 1 + 3
    for i, field in enumerate(numbers):
        values = trace.series[f"v{i}"].values
        assert (field.first, field.low, field.high) == (values[0], values.min(), values.max())


def test_the_inventory_of_json_and_of_what_cannot_be_read(workshop: Any, make: Any) -> None:
    notes = [
        make.said(
            "/state", 10.0 + 0.5 * i, x=i, mode="go" if i else "stop", joints=[1.0, i], ok=True
        )
        for i in range(5)
    ]
    notes += [make.note("/proto", 11.0, b"x", "flatbuffer", "made.Y", "flatbuffer")]
    path = workshop.mcap(notes, attachments={"drive.specc": b"compiled"})

    found = inspect(path)

    assert (found.kind, found.messages, found.attached) == ("MCAP", 6, "drive.specc")
    assert (found.start, found.duration, found.size) == (10.0, 2.0, path.stat().st_size)
    proto, state = found.topics
    assert (proto.count, proto.fields) == (1, ())
    assert "flatbuffer" in proto.note
    assert (state.count, state.rate, state.duration) == (5, 2.0, 2.0)
    fields = {field.path: field for field in state.fields}
    assert set(fields) == {
        "/state.x",
        "/state.mode",
        "/state.joints[0]",
        "/state.joints[1]",
        "/state.ok",
    }
    assert (fields["/state.x"].first, fields["/state.x"].high) == (0.0, 4.0)
    assert fields["/state.mode"].texts == ("go", "stop")
    assert fields["/state.joints[1]"].high == 4.0


def test_the_inventory_of_a_csv_file_names_its_columns(workshop: Any) -> None:
    path = workshop.text("t,left,do\n" + "".join(f"{0.25 * i},{i},go\n" for i in range(9)))

    found = inspect(path)

    assert (found.kind, found.messages, found.duration) == ("CSV", 9, 2.0)
    (topic,) = found.topics
    assert topic.rate == pytest.approx(4.0)
    assert [field.path for field in topic.fields] == ["left", "do"]
    assert topic.fields[1].texts == ("go",)


def test_a_field_without_a_finite_value_is_listed_without_a_range(workshop: Any, make: Any) -> None:
    notes = [make.note("/a", 0.1 * i, b'{"x": NaN, "y": 1}') for i in range(3)]

    (topic,) = inspect(workshop.mcap(notes)).topics

    x = topic.fields[0]
    assert (x.path, x.first, x.low, x.high, x.is_text) == ("/a.x", None, None, None, False)


def test_rates_come_from_sensor_stamps_where_delivery_is_batched(workshop: Any) -> None:
    # Ten messages at a time, 16 microseconds apart, while the sensor measured every 50 ms.
    stamps = 100.0 + 0.05 * np.arange(200)
    logged = 100.5 + 0.5 * (np.arange(200) // 10) + 16e-6 * (np.arange(200) % 10)
    notes = [
        workshop.cdr("/odom", late, workshop.odometry(stamp))
        for stamp, late in zip(stamps, logged, strict=True)
    ]

    (topic,) = inspect(workshop.mcap(notes)).topics

    assert topic.rate == pytest.approx(20.0, rel=1e-6)


def test_a_log_that_is_none_is_refused(workshop: Any) -> None:
    with pytest.raises(SpecError, match="V302"):
        inspect(workshop.text("hello\n"))


def test_odd_names_are_written_so_that_they_can_be_read(workshop: Any, make: Any) -> None:
    notes = [make.note("/odd.topic", 0.1 * i, b'{"a b": {"c.d": 1}}') for i in range(3)]

    (topic,) = inspect(workshop.mcap(notes)).topics

    path = parse_path(topic.fields[0].path)
    assert (path.topic, path.steps) == ("/odd.topic", ("a b", "c.d"))

"""Message paths: what they say, and what is said about bad ones."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from verifier.traces.messages.paths import (
    PathError,
    column_text,
    parse_column,
    parse_path,
    path_text,
    steps_text,
)


@pytest.mark.parametrize(
    ("text", "topic", "steps", "derived"),
    [
        ("/odom.twist.twist.linear.x", "/odom", ("twist", "twist", "linear", "x"), ""),
        ("/a/b/c.data", "/a/b/c", ("data",), ""),
        ("odom.x", "odom", ("x",), ""),
        ("/scan.ranges[0]", "/scan", ("ranges", 0), ""),
        ("/scan.ranges[-1]", "/scan", ("ranges", -1), ""),
        ("/scan.ranges[3:3]", "/scan", ("ranges", 3), ""),
        ("/tf.transforms[2].transform.x", "/tf", ("transforms", 2, "transform", "x"), ""),
        ("/m.rows[0][1]", "/m", ("rows", 0, 1), ""),
        ("/imu.orientation.@yaw", "/imu", ("orientation",), "yaw"),
        ("/imu.orientation.@rpy.pitch", "/imu", ("orientation",), "pitch"),
        ("/poses.list[1].@roll", "/poses", ("list", 1), "roll"),
        ('"/odd.name".x', "/odd.name", ("x",), ""),
        ('/a."odd field".x', "/a", ("odd field", "x"), ""),
    ],
)
def test_a_path_names_topic_fields_and_derived_value(
    text: str, topic: str, steps: tuple[str | int, ...], derived: str
) -> None:
    path = parse_path(text)

    assert (path.topic, path.steps, path.derived) == (topic, steps, derived)


@pytest.mark.parametrize(
    ("text", "at_fault", "word"),
    [
        ("", "", "topic"),
        (".x", ".x", "topic"),
        ("/odom", "/odom", "no field"),
        ("/odom.", ".", "missing"),
        ("/odom.a..b", ".", "missing"),
        ("/scan.ranges[1:3]", "[1:3]", "several"),
        ("/scan.ranges[:]", "[:]", "several"),
        ("/scan.ranges[1:]", "[1:]", "several"),
        ("/scan.ranges[x]", "[x]", "whole number"),
        ("/scan.ranges[1.5]", "[1.5]", "whole number"),
        ("/scan.ranges[0", "[0", "not closed"),
        ("/a.b[0]c", "c", "not expected"),
        ("/a.list{id==3}.x", "{id==3}.x", "filters"),
        ("/imu.orientation.@jaw", "@jaw", "@jaw"),
        ("/imu.orientation.@yaw.x", "@yaw.x", "@yaw.x"),
        ("/imu.orientation@yaw", "@yaw", "dot"),
    ],
)
def test_a_bad_path_is_explained_at_its_place(text: str, at_fault: str, word: str) -> None:
    with pytest.raises(PathError) as caught:
        parse_path(text)

    assert text[caught.value.start : caught.value.end].startswith(at_fault)
    assert word in caught.value.message


NAMES = st.text(
    st.characters(blacklist_categories=["Cs"], blacklist_characters='"'), min_size=1, max_size=12
)
STEPS = st.lists(st.one_of(NAMES, st.integers(-99, 99)), min_size=1, max_size=5)


@given(topic=NAMES, steps=STEPS)
def test_every_path_that_is_written_can_be_read_again(topic: str, steps: list[str | int]) -> None:
    written = path_text(topic, tuple(steps))
    first = steps_text(tuple(steps))

    assert written.endswith(first)
    assert parse_path(written).steps == tuple(steps)
    assert parse_path(written).topic == topic


@given(st.text(max_size=40))
def test_any_text_is_a_path_or_a_fault_inside_it(text: str) -> None:
    fault = fault_of(text)

    if fault:
        assert 0 <= fault.start <= fault.end
        assert fault.start <= len(text)


def fault_of(text: str) -> PathError | None:
    try:
        parse_path(text)
    except PathError as error:
        return error
    return None


@pytest.mark.parametrize("name", ["left", "a b", "'odd'", '"odd"', "x.y", "`z`", "it's"])
def test_a_column_that_is_written_can_be_read_again(name: str) -> None:
    assert parse_column(column_text(name)) == name


def test_a_column_may_be_quoted() -> None:
    assert parse_column('"left range"') == "left range"
    assert parse_column("left range") == "left range"

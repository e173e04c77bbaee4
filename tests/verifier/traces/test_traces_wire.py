"""CDR and ROS 1 bytes against the serializer of rosbags, an independent implementation."""

import itertools
import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from verifier.traces.messages.definitions import (
    DefinitionError,
    Many,
    Node,
    Number,
    Struct,
    Text,
    definition,
)
from verifier.traces.messages.json_messages import decode as decode_json
from verifier.traces.messages.paths import Steps
from verifier.traces.messages.wire import decode

NUMBERS = {
    "bool": np.bool_,
    "int8": np.int8,
    "uint8": np.uint8,
    "int16": np.int16,
    "uint16": np.uint16,
    "int32": np.int32,
    "uint32": np.uint32,
    "int64": np.int64,
    "uint64": np.uint64,
    "float32": np.float32,
    "float64": np.float64,
}
LINE = "=" * 80
counter = itertools.count()


@st.composite
def definitions(draw: st.DrawFn) -> tuple[str, str]:
    """The name and text of a message type with nested types."""
    count = draw(st.integers(1, 3))
    names = [f"T{next(counter)}" for _ in range(count)]
    texts = []
    for depth, _ in enumerate(names):
        inner = [f"made/{name}" for name in names[depth + 1 :]]
        kinds = st.sampled_from([*NUMBERS, "string", *inner])
        many = st.sampled_from(["", "", "", "[]", "[3]", "[<=4]"])
        fields = draw(st.lists(st.tuples(kinds, many), min_size=1, max_size=5))
        texts.append("\n".join(f"{kind}{suffix} f{i}" for i, (kind, suffix) in enumerate(fields)))
    below = "".join(
        f"\n{LINE}\nMSG: made/{n}\n{t}" for n, t in zip(names[1:], texts[1:], strict=True)
    )
    return f"made/msg/{names[0]}", texts[0] + below


def fill(store: Any, node: Node, rng: np.random.Generator, base: str) -> Any:
    """A value for the node as rosbags wants it."""
    if isinstance(node, Number):
        return number(node, rng, base)
    if isinstance(node, Text):
        return "".join(rng.choice(list("aé✓ z"), size=rng.integers(0, 6)))
    if isinstance(node, Struct):
        return structure(store, node, rng)
    size = node.count if node.count is not None else int(rng.integers(0, 4))
    items = [fill(store, node.item, rng, base) for _ in range(size)]
    return np.array(items, dtype=NUMBERS[base]) if isinstance(node.item, Number) else items


def number(node: Number, rng: np.random.Generator, base: str) -> Any:
    if base == "bool":
        return bool(rng.integers(0, 2))
    kind = NUMBERS[base]
    value = rng.normal() * 10.0 if node.code[0] == "f" else rng.integers(0, 100)
    return kind(value)


def structure(store: Any, node: Struct, rng: np.random.Generator) -> Any:
    described = store.fielddefs[node.name][1]
    values = {}
    for (name, child), (_, desc) in zip(node.fields, described, strict=True):
        base = re.search(r"'([a-z]+\d*)'", str(desc))
        values[name] = fill(store, child, rng, base[1] if base and base[1] in NUMBERS else "")
    return store.types[node.name](**values)


def leaves_of(node: Node, above: Steps = ()) -> list[Steps]:
    if isinstance(node, Struct):
        return [leaf for name, child in node.fields for leaf in leaves_of(child, (*above, name))]
    if isinstance(node, Many):
        return [leaf for i in (0, 2, -1) for leaf in leaves_of(node.item, (*above, i))]
    return [above]


def value_at(message: Any, steps: Steps) -> Any:
    for step in steps:
        if isinstance(step, int):
            if not -len(message) <= step < len(message):
                return None
            message = message[step]
        else:
            message = getattr(message, step)
    return message


def compare(messages: Sequence[Any], leaves: Sequence[Steps], decoded: Any) -> None:
    assert decoded.readable.all(), decoded.reason
    for steps, column in zip(leaves, decoded.columns, strict=True):
        for row, message in enumerate(messages):
            expected = value_at(message, steps)
            if isinstance(expected, str):
                assert column.texts[row] == expected
            elif expected is None:
                assert np.isnan(column.numbers[row])
            else:
                assert column.numbers[row] == np.float64(expected)


@settings(max_examples=25, deadline=None)
@given(described=definitions(), seed=st.integers(0, 2**32 - 1))
def test_any_message_type_is_read_as_rosbags_wrote_it(
    described: tuple[str, str], seed: int
) -> None:
    name, text = described
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(text, name))
    root = definition(name, "ros2msg", text)
    rng = np.random.default_rng(seed)
    messages = [structure(store, root, rng) for _ in range(6)]
    leaves = leaves_of(root)

    for little in (True, False):
        payloads = [bytes(store.serialize_cdr(one, name, little_endian=little)) for one in messages]
        compare(messages, leaves, decode(payloads, "cdr", root, leaves))
    payloads = [bytes(store.serialize_ros1(one, name)) for one in messages]
    compare(messages, leaves, decode(payloads, "ros1", root, leaves))


def test_messages_whose_strings_change_length_are_all_read(workshop: Any) -> None:
    frames = ["odom", "o", "", "a much longer frame", "odom"] * 40
    notes = [
        workshop.cdr("/odom", i, workshop.odometry(i, x=float(i), frame=frame))
        for i, frame in enumerate(frames)
    ]
    root = definition("nav_msgs/msg/Odometry", "ros2msg", notes[0].schema_text)
    asked: list[Steps] = [("pose", "pose", "position", "x"), ("header", "frame_id")]

    decoded = decode([note.payload for note in notes], "cdr", root, asked)

    assert decoded.columns[0].numbers.tolist() == list(range(200))
    assert decoded.columns[1].texts == tuple(frames)


def test_more_layouts_of_one_size_than_are_compared_are_still_read() -> None:
    root = definition("a/msg/B", "ros2msg", "string[] names\nfloat64 x")
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg("string[] names\nfloat64 x", "a/msg/B"))
    make = store.types["a/msg/B"]
    splits = [(i, j) for i in range(12) for j in range(12) if (i + j) < 12][:90] * 2
    messages = [
        make(names=["a" * i, "b" * j, "c" * (30 - i - j)], x=float(n))
        for n, (i, j) in enumerate(splits)
    ]

    payloads = [bytes(store.serialize_cdr(one, "a/msg/B")) for one in messages]

    assert decode(payloads, "cdr", root, [("x",)]).columns[0].numbers.tolist() == list(
        range(len(splits))
    )


@pytest.mark.parametrize("length", [0, 3, 4, 20, 100])
def test_a_short_message_is_not_readable_and_the_rest_is(workshop: Any, length: int) -> None:
    note = workshop.cdr("/odom", 0, workshop.odometry(0, x=7.0))
    root = definition("nav_msgs/msg/Odometry", "ros2msg", note.schema_text)
    asked = [("pose", "pose", "position", "x")]

    decoded = decode([note.payload[:length], note.payload], "cdr", root, asked)

    assert decoded.readable.tolist() == [False, True]
    assert decoded.columns[0].numbers[1] == 7.0
    assert decoded.reason


def test_a_message_longer_than_its_definition_is_not_believed(workshop: Any) -> None:
    note = workshop.cdr("/odom", 0, workshop.odometry(0))
    root = definition("nav_msgs/msg/Odometry", "ros2msg", note.schema_text)

    decoded = decode([note.payload + bytes(8)], "cdr", root, [("header", "stamp", "sec")])

    assert not decoded.readable[0]


def test_a_sequence_that_claims_more_than_the_message_holds_costs_nothing() -> None:
    root = definition("a/msg/B", "ros2msg", "a/C[] items\n" + LINE + "\nMSG: a/C\n")

    decoded = decode([b"\0\1\0\0\xff\xff\xff\xff"], "cdr", root, [])

    assert not decoded.readable[0]


@pytest.mark.parametrize(
    ("encoding", "text", "why"),
    [
        ("ros2msg", "a/B self", "itself"),
        ("ros2msg", "other/Type x", "not in the file"),
        ("ros2msg", "float64", "can't be read"),
        ("ros2msg", "wat??", "can't be read"),
        ("protobuf", "x", "not supported"),
        ("ros2idl", "module {", "can't be read"),
        ("ros2msg", "float64 x\n" * 30_000, "characters"),
    ],
)
def test_a_definition_that_cannot_be_used_says_why(encoding: str, text: str, why: str) -> None:
    with pytest.raises(DefinitionError, match=why):
        definition("a/msg/B", encoding, text)


def test_a_definition_in_idl_is_read() -> None:
    text = (
        "================================================================================\n"
        "IDL: a/msg/B\n"
        "module a { module msg { struct B { double x; string name; }; }; };\n"
    )

    root = definition("a/msg/B", "ros2idl", text)

    assert root.names == ("x", "name")


def test_a_definition_that_the_file_lacks_is_that_of_ros_2() -> None:
    root = definition("nav_msgs/msg/Odometry", "", "")

    assert root.names == ("header", "child_frame_id", "pose", "twist")


def test_json_values_are_numbers_texts_or_missing() -> None:
    payloads = [
        b'{"a": {"b": [1, 2.5]}, "s": "left", "on": true}',
        b'{"a": {"b": [3]}, "s": "right", "on": false}',
        b'{"a": 4, "s": null}',
        b'{"a": {"b": [1, 2',
        b"\xff\xfe",
        b"[" * 100_000,
    ]

    decoded = decode_json(payloads, [("a", "b", 1), ("s",), ("on",), ("a", "b", -1)])

    assert decoded.readable.tolist() == [True, True, True, False, False, False]
    np.testing.assert_equal(decoded.columns[0].numbers[:3], [2.5, np.nan, np.nan])
    assert decoded.columns[1].texts is not None
    assert decoded.columns[1].texts[:3] == ("left", "right", None)
    np.testing.assert_equal(decoded.columns[2].numbers[:3], [1.0, 0.0, np.nan])
    np.testing.assert_equal(decoded.columns[3].numbers[:3], [2.5, 3.0, np.nan])

"""Edits in place: what is meant changes, and every other character stays."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from spec_schema.editing.edits import Edit, EditError, NewKey, NewNumber, NewText
from spec_schema.editing.in_place import edited
from spec_schema.node import plain
from spec_schema.places import Path
from spec_schema.source import Source
from spec_schema.yaml_reader import read

UNITS = ("", " m/s", " 1/(m*s)", "deg", " %")
QUOTES = ("", '"', "'")
NUMBER = st.decimals(-1000, 1000, allow_nan=False, places=3).map(str)
COMMENT = st.sampled_from(["", "  # was 0.5 m/s, see log", "   # {x: 1, y: [2]}"])


def change(text: str, *edits: Edit) -> str:
    return edited(Source("spec.yaml", text), edits).text


def data(text: str) -> object:
    return plain(read(Source("spec.yaml", text)))


@st.composite
def scalars(draw: st.DrawFn) -> tuple[str, str, str, str]:
    """A number as it may be written, in parts: quote, number, unit, and a number to come."""
    quote = draw(st.sampled_from(QUOTES))
    unit = draw(st.sampled_from(UNITS))
    return quote, draw(NUMBER), unit, draw(NUMBER)


LAYOUTS = (
    ("a: {{b: 1, v: {}, c: [x, 'y, z']}}{}{end}d: 2{end}", ("a", "v")),
    ("a:{end}  b: 1{end}  v: {}{}{end}  c: x{end}", ("a", "v")),
    ("a:{end}- [1, {}]{}{end}- [3, 4]{end}", ("a", 0, 1)),
    ("# no spec{end}v: {}{}", ("v",)),
    ("a: [{{at: [0, 1],{end}     go: [1,   {} ]}}]{}{end}", ("a", 0, "go", 1)),
)


@given(st.sampled_from(LAYOUTS), scalars(), COMMENT, st.sampled_from(["\n", "\r\n"]))
def test_a_number_is_changed_and_nothing_else(
    layout: tuple[str, Path], scalar: tuple[str, str, str, str], comment: str, end: str
) -> None:
    quote, old, unit, new = scalar
    before, after = (
        layout[0].format(f"{quote}{number}{unit}{quote}", comment, end=end) for number in (old, new)
    )

    assert change(before, NewNumber(layout[1], new)) == after


@given(st.lists(NUMBER, min_size=2, max_size=6), st.data())
def test_many_edits_do_not_disturb_one_another(numbers: list[str], more: st.DataObject) -> None:
    text = "".join(f"k{i}: {{v: {number}}} # {i}\n" for i, number in enumerate(numbers))
    new = more.draw(st.lists(NUMBER, min_size=len(numbers), max_size=len(numbers)))
    order = more.draw(st.permutations(range(len(numbers))))

    found = change(text, *(NewNumber((f"k{i}", "v"), new[i]) for i in order))

    assert found == "".join(f"k{i}: {{v: {number}}} # {i}\n" for i, number in enumerate(new))


@given(
    st.sampled_from(
        [
            "t:\n  s: {path: /odom.x, scale: 2}  # c\n  u: 1\n",
            "t:\n  s: {path: /odom.x, scale: 2,}\n",
            "t:\n  s:\n    path: /odom.x   # where\n    scale: 2\n  u: 1\n",
            "t:\n  s:\n    path: /odom.x\n    scale: 2",
            "t:\n  s: {path: /odom.x,   # one\n      scale: 2   # two\n  }\n",
            "t: {s: {scale: 2, path: /odom.x}}",
        ]
    ),
    NUMBER,
)
def test_a_new_key_is_added_and_nothing_is_lost(text: str, number: str) -> None:
    found = change(text, NewKey(("t", "s", "delay"), f"{number} s", "path"))

    entry = data(found)["t"]["s"]  # type: ignore[index]
    assert entry == {"path": "/odom.x", "scale": 2, "delay": f"{number} s"}
    assert list(entry)[-1] == "delay"
    assert re.sub(r"(, | *)delay: \S+ s\n?", "", found).rstrip("\n") == text.rstrip("\n")


@pytest.mark.parametrize(
    ("written", "braced"),
    [
        ("/odom.x", "/odom.x"),
        ('"/odom.x"', '"/odom.x"'),
        ("/odom.c[0]", "'/odom.c[0]'"),
        ("/tf{frame=='a'}.x", "'/tf{frame==''a''}.x'"),
        ("column, too", "'column, too'"),
    ],
)
def test_a_bare_path_becomes_a_mapping(written: str, braced: str) -> None:
    path: Path = ("trace", "v", "delay")
    keys = (NewKey(path, "0.5 s", "path"), NewKey((*path[:-1], "scale"), "2", "path"))
    text = f"trace:\n  v: {written}  # late\n  w: /w.x\n"

    found = change(text, *keys)

    assert found == f"trace:\n  v: {{path: {braced}, delay: 0.5 s, scale: 2}}  # late\n  w: /w.x\n"
    before = data(text)["trace"]["v"]  # type: ignore[index]
    assert data(found)["trace"]["v"]["path"] == before  # type: ignore[index]


def test_a_text_is_changed_within_its_quotes() -> None:
    text = 'a: {unit: "rad", b: rad}\n'

    found = change(text, NewText(("a", "unit"), "deg"), NewText(("a", "b"), "mm"))

    assert found == 'a: {unit: "deg", b: mm}\n'


@pytest.mark.parametrize(
    ("text", "path"),
    [
        ("v: |\n  0.5 m\n", ("v",)),
        ('v: "\\x30.5 m"\n', ("v",)),
        ("v: pi/2\n", ("v",)),
        ("v: {a: 1}\n", ("v",)),
        ("v: 1\n", ("w",)),
    ],
)
def test_what_can_not_be_changed_in_place_is_refused(text: str, path: Path) -> None:
    with pytest.raises(EditError):
        change(text, NewNumber(path, "7"))


def test_what_no_longer_reads_as_meant_is_refused() -> None:
    with pytest.raises(EditError, match="in place"):
        change("a: {b: x}\n", NewText(("a", "b"), "y, c: 1"))


def test_new_keys_of_one_mapping_need_not_stand_together() -> None:
    text = "t:\n  a: /x.y\n  b: /x.z\n"
    delays = [NewKey(("t", name, "delay"), "0.1 s", "path") for name in "ab"]
    scale = NewKey(("t", "a", "scale"), "-1", "path")

    found = change(text, *delays, scale)

    a, b = "{path: /x.y, delay: 0.1 s, scale: -1}", "{path: /x.z, delay: 0.1 s}"
    assert found == f"t:\n  a: {a}\n  b: {b}\n"

"""Places: paths to spans, and characters within a text to spans."""

from itertools import combinations
from pathlib import Path

import pytest

from spec_schema.load import load
from spec_schema.places import Places, dotted
from spec_schema.source import Source, Span
from spec_schema.yaml_reader import read

VAN_DER_POL = load(Path(__file__).parents[2] / "specs" / "van_der_pol.yaml")
TEXT = """\
field:
  formula:
    x: v + w
    v: "-k*x"
    w: 'it''s'
    a: "tab\\there"
    n: 0.50
    long: |
      x +
      v
sketch:
  - at: [0, 1]
"""


def places() -> Places:
    source = Source("f.yaml", TEXT)
    return Places(source, read(source))


def shown(span: Span) -> str:
    assert span.line == span.end_line
    return TEXT.splitlines()[span.line - 1][span.column - 1 : span.end_column - 1]


def test_a_path_leads_to_the_key_and_to_the_value() -> None:
    found = places()

    assert shown(found.value(("field", "formula", "x"))) == "v + w"
    assert shown(found.key(("field", "formula", "x"))) == "x"
    assert shown(found.value(("sketch", 0, "at", 1))) == "1"
    assert shown(found.key(("sketch", 0, "at", 1))) == "1"
    assert found.origin(("field", "formula")) == "f.yaml:2:3"


def test_a_path_beyond_the_text_leads_to_the_last_thing_written() -> None:
    found = places()

    assert found.value(("sketch", 0, "go", 1)) == found.value(("sketch", 0))
    assert found.value(("sketch", 7)) == found.value(("sketch",))
    assert shown(found.key(("field", "formula", "x", "path"))) == "x"
    assert found.written(("sketch", 0, "go", 1)) == ("sketch", 0)


@pytest.mark.parametrize(
    ("name", "start", "end", "expected"),
    [
        ("x", 4, 5, "w"),
        ("v", 1, 2, "k"),
        ("w", 0, 2, "'it''s'"),  # escaped: the characters on the page are others
        ("a", 0, 3, '"tab\\there"'),
        ("n", 0, 1, "0"),
        ("x", 5, 5, ""),  # after the end: one caret there
        ("x", 3, 99, "v + w"),
    ],
)
def test_characters_within_a_text_are_found_on_the_page(
    name: str, start: int, end: int, expected: str
) -> None:
    span = places().within(("field", "formula", name), start, end)

    assert shown(span) == expected


def test_within_a_text_of_several_lines_the_whole_is_meant() -> None:
    path = ("field", "formula", "long")

    assert places().within(path, 2, 3) == places().value(path)


def test_every_piece_of_an_expression_in_a_spec_is_cut_out_exactly() -> None:
    text = "mu*(1 - x**2)*v - x"

    for start, end in combinations(range(len(text) + 1), 2):
        span = VAN_DER_POL.places.within(("field", "formula", "v"), start, end)
        line = VAN_DER_POL.source.line(span.line)
        assert line[span.column - 1 : span.end_column - 1] == text[start:end]


def test_a_path_is_written_as_the_diagnostics_show_it() -> None:
    assert dotted(()) == "$"
    assert dotted(("a", 0, "b-c", "*.mcap", "")) == "$.a[0].b-c['*.mcap']['']"

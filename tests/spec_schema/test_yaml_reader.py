"""The reader against JSON (a subset of YAML) as a second implementation, and against bombs."""

import json
import time
from pathlib import Path

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from spec_schema import yaml_reader
from spec_schema.diagnostics import SpecError
from spec_schema.node import Listing, Mapping, Node, Scalar, plain
from spec_schema.source import Source, Span
from spec_schema.yaml_reader import DEEPEST, read

BAD = sorted((Path(__file__).parents[1] / "golden" / "bad").glob("*.yaml"))
PRINTABLE = st.text(st.characters(codec="utf-8", exclude_categories=["C", "Zl", "Zp"]))
SCALARS = (
    st.none()
    | st.booleans()
    | st.integers(-(2**60), 2**60)
    | st.floats(allow_nan=False, allow_infinity=False)
    | PRINTABLE
)
DATA = st.recursive(
    SCALARS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(PRINTABLE, inner, max_size=4),
)
DOCUMENTS = st.dictionaries(PRINTABLE, DATA, max_size=5)


def codes(text: str) -> list[str]:
    with pytest.raises(SpecError) as caught:
        read(Source("f.yaml", text))
    return [found.code for found in caught.value.diagnostics]


def cut(text: str, span: Span) -> str:
    lines = text.split("\n")[span.line - 1 : span.end_line]
    lines[-1] = lines[-1][: span.end_column - 1]
    lines[0] = lines[0][span.column - 1 :]
    return "\n".join(lines)


def assert_spans_cut_out_the_values(text: str, node: Node) -> None:
    assert json.loads(cut(text, node.span)) == plain(node)
    match node:
        case Listing():
            for item in node.items:
                assert_spans_cut_out_the_values(text, item)
        case Mapping():
            for name, entry in node.entries.items():
                assert json.loads(cut(text, entry.key)) == name
                assert_spans_cut_out_the_values(text, entry.value)


@given(DOCUMENTS, st.sampled_from([None, 2]))
@settings(max_examples=40)
def test_json_is_read_as_json_reads_it(data: dict[str, object], indent: int | None) -> None:
    text = json.dumps(data, ensure_ascii=False, indent=indent)

    assert plain(read(Source("f.yaml", text))) == data


@given(DOCUMENTS, st.sampled_from([None, 2]))
@settings(max_examples=40)
def test_the_span_of_every_key_and_value_holds_just_that(
    data: dict[str, object], indent: int | None
) -> None:
    text = json.dumps(data, ensure_ascii=False, indent=indent)

    assert_spans_cut_out_the_values(text, read(Source("f.yaml", text)))


def test_block_style_ends_with_its_last_value() -> None:
    text = "a:\n  b: 1   # one\n  c: [2]\n\n# end\nd: |\n  text\n"
    a = read(Source("f.yaml", text)).entries["a"]

    assert cut(text, a.value.span) == "b: 1   # one\n  c: [2]"
    assert cut(text, a.key) == "a"


def test_a_key_without_a_value_stands_for_it() -> None:
    root = read(Source("f.yaml", "a:\nb: 1\n"))

    assert root.entries["a"].value == Scalar(None, "", Span(1, 1, 1, 2))


def test_quoted_scalars_are_text() -> None:
    assert plain(read(Source("f.yaml", "a: '1'\nb: \"null\"\nc: |\n  1\nd: 1"))) == {
        "a": "1",
        "b": "null",
        "c": "1\n",
        "d": 1,
    }


def test_all_mistakes_are_told_at_once_in_file_order() -> None:
    text = "a: &x 1\nb: !!int 2\na: 3\n4: 5\nc: *x\n? [d]\n: 6\n<<: {}\n---\n"

    assert codes(text) == ["S003", "S004", "S002", "S005", "S003", "S005", "S003", "S006"]


def test_a_mistake_before_a_syntax_error_is_told_too() -> None:
    assert codes("a: 1\na: 2\nb: [1\n") == ["S002", "S001"]


def test_nesting_is_counted_from_the_top() -> None:
    inside = "[" * (DEEPEST - 1) + "]" * (DEEPEST - 1)

    assert isinstance(read(Source("f.yaml", f"a: {inside}")), Mapping)
    assert codes(f"a: [{inside}]") == ["S013"]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("[" * 100_000, "S013"),
        ("{a: " * 100_000, "S013"),
        ("- " * 100_000, "S013"),
        ("? " * 100_000, "S013"),
        ("\n".join(" " * depth + "a:" for depth in range(1_000)), "S013"),
        ("a: &a [1]\nb: [" + "*a," * 100_000 + "]", "S003"),
        ("a: 1\n" * 100_000, "S002"),
        ("a: '" + "x\n" * 100_000, "S001"),
        ("!a " * 100_000, "S004"),
        ("---\n" * 100_000, "S007"),
        (" " * 1_000_000, "S007"),
        ("x" * 1_000_000, "S008"),
        ("a" * 2**20 + ": 1", "S012"),
    ],
    ids=lambda value: value[:8] if isinstance(value, str) else None,
)
def test_a_bomb_costs_neither_time_nor_a_crash(text: str, code: str) -> None:
    start = time.process_time()

    assert codes(text)[0] == code
    assert time.process_time() - start < 2.0


@pytest.mark.parametrize("path", BAD, ids=lambda path: path.stem)
def test_the_slow_parser_finds_the_same_at_the_same_line(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = Source(path.name, path.read_text(encoding="utf-8"))
    fast = _findings(source)
    monkeypatch.setattr(yaml_reader, "_LOADER", yaml.SafeLoader)

    assert _findings(source) == fast


def _findings(source: Source) -> list[tuple[str, int]]:
    try:
        read(source)
    except SpecError as error:
        return [(found.code, found.span.line if found.span else 0) for found in error.diagnostics]
    return []

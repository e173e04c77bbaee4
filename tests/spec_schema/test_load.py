"""Loading: files that can't be read, all mistakes at once, and whatever else a file may hold."""

from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from spec_schema.behavior import BehaviorSpec
from spec_schema.characters import LARGEST
from spec_schema.diagnostics import Diagnostic, Severity, SpecError, render
from spec_schema.load import Loaded, load, load_source
from spec_schema.project import ProjectSpec
from spec_schema.source import Source

SPECS = Path(__file__).parents[2] / "specs"
GOOD = (SPECS / "van_der_pol.yaml").read_text(encoding="utf-8")


def mistakes(text: str) -> tuple[Diagnostic, ...]:
    with pytest.raises(SpecError) as caught:
        load_source(Source("f.yaml", text))
    return caught.value.diagnostics


def file_mistake(path: Path) -> Diagnostic:
    with pytest.raises(SpecError) as caught:
        load(path)
    assert len(caught.value.diagnostics) == 1
    return caught.value.diagnostics[0]


def assert_places_lie_in_the_text(found: tuple[Diagnostic, ...]) -> None:
    for diagnostic in found:
        span = diagnostic.span
        if span is None:
            continue
        source = diagnostic.source
        assert (span.line, span.column) <= (span.end_line, span.end_column)
        for line, column in [(span.line, span.column), (span.end_line, span.end_column)]:
            assert 1 <= line <= source.text.count("\n") + source.text.count("\r") + 1
            assert 1 <= column <= len(source.line(line)) + 1


def check_anything(text: str) -> None:
    """A text is a spec, or it is explained why not: there is no third way."""
    try:
        loaded = load_source(Source("f.yaml", text))
    except SpecError as error:
        found = error.diagnostics
    else:
        assert isinstance(loaded.spec, BehaviorSpec | ProjectSpec)
        return
    assert found
    assert render(found).endswith(" in f.yaml")
    assert_places_lie_in_the_text(found)


def test_a_good_spec_is_loaded_with_its_places() -> None:
    loaded = load(SPECS / "van_der_pol.yaml")

    assert isinstance(loaded.spec, BehaviorSpec)
    assert loaded.spec.control["mu"].domain == (0.1, 3.0)
    assert loaded.origin(("state", "v")).endswith("van_der_pol.yaml:21:3")


def test_later_passes_place_their_errors_at_values_keys_and_characters() -> None:
    loaded = load_source(Source("f.yaml", GOOD))
    path = ("field", "formula", "v")

    whole = loaded.error("S201", path, "wrong")
    part = loaded.error("S201", path, "wrong", within=(3, 12), label="here")
    key = loaded.warning("S201", path, "odd", "better", key=True)

    line = loaded.source.text.splitlines().index("    v: mu*(1 - x**2)*v - x") + 1
    assert (whole.place, whole.path) == (f"f.yaml:{line}:8", "$.field.formula.v")
    assert part.span is not None
    assert loaded.source.line(line)[part.span.column - 1 : part.span.end_column - 1] == "(1 - x**2"
    assert (key.place, key.severity, key.help) == (f"f.yaml:{line}:5", Severity.WARNING, "better")


def test_a_file_that_is_not_there_is_named_with_the_nearest_one(tmp_path: Path) -> None:
    (tmp_path / "patrol.yaml").touch()

    found = file_mistake(tmp_path / "partol.yaml")

    assert (found.code, found.help) == ("S015", "did you mean 'patrol.yaml'?")


def test_a_folder_is_no_spec(tmp_path: Path) -> None:
    assert file_mistake(tmp_path).code == "S015"


def test_a_file_of_more_than_a_mebibyte_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "large.yaml"
    path.write_bytes(b"#" * (LARGEST + 1))

    assert file_mistake(path).code == "S012"


def test_a_file_that_is_not_utf_8_is_refused_at_the_first_wrong_byte(tmp_path: Path) -> None:
    path = tmp_path / "latin.yaml"
    path.write_bytes("specc: 1\nabout: für\n".encode("latin-1"))

    found = file_mistake(path)

    assert (found.code, found.place) == ("S011", f"{path}:2:9")


def test_a_byte_order_mark_moves_no_column(tmp_path: Path) -> None:
    path = tmp_path / "marked.yaml"
    path.write_bytes(b"\xef\xbb\xbfspec: 1\n" + GOOD.split("specc: 1\n")[1].encode())

    with pytest.raises(SpecError) as caught:
        load(path)

    assert [(found.code, found.place) for found in caught.value.diagnostics] == [
        ("S102", f"{path}:1:1")
    ]


def test_windows_line_ends_move_no_line() -> None:
    bad = GOOD.replace("role: both", "rolle: both")

    unix = [(found.code, found.span) for found in mistakes(bad)]
    windows = [(found.code, found.span) for found in mistakes(bad.replace("\n", "\r\n"))]

    assert unix == windows


def test_of_hundreds_of_mistakes_the_first_are_listed() -> None:
    found = mistakes(GOOD + "".join(f"k{number}: 1\n" for number in range(300)))

    assert len(found) == 101
    assert found[-1].code == "S016"


def test_six_mistakes_are_told_in_one_go() -> None:
    text = (
        GOOD.replace("kind: behavior", "kind: behaviour")
        .replace("domain: [-4, 4]", "domain: [4, -4]")
        .replace("role: both", "rolle: both", 1)
        .replace("agent: rate", "agnet: rate")
        .replace("default: 1,", "default: 10,")
        .replace("  horizon: 2 s\n", "")
    )

    assert [found.code for found in mistakes(text)] == [
        "S104",
        "S111",
        "S102",
        "S102",
        "S114",
        "S101",
    ]


def test_a_key_without_a_value_is_told_once() -> None:
    found = mistakes(GOOD.replace("horizon: 2 s", "horizon:").replace("role: both", "role:"))

    assert [one.message for one in found] == [
        "'role' has no value",
        "'role' has no value",
        "'horizon' has no value",
    ]


def test_a_message_repeats_only_the_beginning_of_a_long_text() -> None:
    (found,) = mistakes(GOOD.replace("role: both", f"role: {'both' * 1000}", 1))

    assert found.message.startswith("unknown role 'bothboth")
    assert len(found.message) < 100


def test_mistakes_inside_a_misspelt_key_are_told_under_its_own_name() -> None:
    found = mistakes(GOOD.replace("fidelity:", "fidellity:").replace("horizon: 2 s", "horizon: []"))

    assert [(one.code, one.path) for one in found] == [
        ("S102", "$.fidellity"),
        ("S103", "$.fidellity.horizon"),
    ]


def test_a_key_that_is_already_there_is_not_suggested() -> None:
    found = mistakes(GOOD.replace("horizon: 2 s", "horizon: 2 s\n  horizons: 3 s"))

    assert [one.help for one in found] == [
        "the keys here are: tolerance, scatter, horizon, region, coverage"
    ]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("specc: 1\nkind: projekt\nname: a\n", "S104"),
        ("specc: 1\nname: a\nspecs: []\n", "S101"),
    ],
)
def test_a_project_is_known_without_its_kind(text: str, code: str) -> None:
    assert [found.code for found in mistakes(text)] == [code]


@pytest.mark.parametrize("path", sorted(SPECS.glob("*.yaml")), ids=lambda path: path.stem)
def test_every_spec_of_the_library_has_the_right_shape(path: Path) -> None:
    assert isinstance(load(path), Loaded)


@given(st.text(max_size=200))
@example("\ufeffspecc: 1")
@example("a: \ud800")
@example("\r\n\u0085\u2028")
def test_any_text_is_loaded_or_explained(text: str) -> None:
    check_anything(text)


@given(st.text(alphabet=" \n-:?[]{},&*!|>'\"%@`#~<a1.e", max_size=60))
@settings(max_examples=200)
def test_any_text_that_looks_like_yaml_is_loaded_or_explained(text: str) -> None:
    check_anything(text)


PIECES = ["\n", "  ", ": ", "- ", "[", "]", "{", "}", ",", "#", "'", '"', "&a ", "*a", "!t ", "|"]
VALUES = [".nan", "1e999", "[]", "{}", "null", "true", "[[1]]", "{x: 1}", "0", "''", "x", "9" * 25]


@given(st.data())
@settings(max_examples=200, deadline=None)
def test_any_change_of_a_good_spec_is_loaded_or_explained(data: st.DataObject) -> None:
    text = GOOD
    for _ in range(data.draw(st.integers(1, 4))):
        start = data.draw(st.integers(0, len(text)))
        end = data.draw(st.integers(start, min(len(text), start + 12)))
        put = data.draw(st.sampled_from(PIECES) | st.text(max_size=3))
        text = text[:start] + put + text[end:]
    check_anything(text)


@given(st.data())
@settings(max_examples=200, deadline=None)
def test_any_value_in_any_place_is_loaded_or_explained(data: st.DataObject) -> None:
    lines = [line for line in GOOD.splitlines() if line and not line.startswith("#")]
    for _ in range(data.draw(st.integers(1, 3))):
        number = data.draw(st.integers(0, len(lines) - 1))
        key = lines[number].split(":")[0]
        lines[number] = f"{key}: {data.draw(st.sampled_from(VALUES))}"
    check_anything("\n".join(lines))


@pytest.mark.parametrize(
    ("keys", "kind"),
    [
        ("nodes: {}", "architecture"),
        ("arena: {box: [1, 1]}", "world"),
        ("drive: {}", "body"),
        ("by: {}", "arbiter"),
        ("robots: {}", "scenario"),
        ("state: {}", "behavior"),
    ],
)
def test_a_spec_without_its_kind_is_taken_for_what_its_keys_tell(keys: str, kind: str) -> None:
    text = f"specc: 1\nname: tried\n{keys}\n"

    with pytest.raises(SpecError) as caught:
        load_source(Source("spec.yaml", text))

    said = [f"{found.message} {found.help}" for found in caught.value.diagnostics]
    assert any("'kind' is missing" in one and kind in one for one in said)
    assert not any("unknown key" in one for one in said)

"""What a diagnostic looks like: the format that editors, CI and people read."""

import pickle

import pytest
from hypothesis import given
from hypothesis import strategies as st

from spec_schema.diagnostics import (
    MOST,
    WIDEST,
    Diagnostic,
    Severity,
    SpecError,
    first_ones,
    in_file_order,
    render,
    render_one,
)
from spec_schema.source import Source, Span


def finding(text: str, span: Span | None, message: str = "wrong", label: str = "") -> Diagnostic:
    source = Source("specs/reach.yaml", text)
    return Diagnostic("S102", Severity.ERROR, message, source, span, "$.gian", "help", label)


def excerpt(text: str, start: int, end: int) -> tuple[str, str]:
    line, carets = render_one(finding(text, Span(1, start, 1, end))).splitlines()[2:4]
    return line.removeprefix("1 | "), carets.removeprefix("  | ")


def test_an_error_is_the_same_in_another_process() -> None:
    error = SpecError([finding("kind: point\n", Span(1, 1, 1, 5))])

    again = pickle.loads(pickle.dumps(error))  # noqa: S301 - bytes of our own

    assert (again.diagnostics, str(again)) == (error.diagnostics, str(error))


def test_the_format_is_that_of_the_style_guide() -> None:
    text = "kind: point\n" * 4 + "    gian: 2.0\n"
    found = finding(text, Span(5, 5, 5, 9), "unknown key 'gian'")

    assert render([found]) == (
        "specs/reach.yaml:5:5: error[S102]: unknown key 'gian'\n"
        "  |\n"
        "5 |     gian: 2.0\n"
        "  |     ^^^^\n"
        "  = at: $.gian\n"
        "  = help: help\n"
        "\n"
        "1 error in specs/reach.yaml"
    )


def test_what_goes_on_over_lines_is_underlined_to_the_end_of_the_first() -> None:
    found = finding("a: [1,\n  2]\n", Span(1, 4, 2, 5), label="in this list")

    assert "  |    ^^^ in this list" in render_one(found).splitlines()


def test_wide_and_combining_characters_keep_the_carets_below() -> None:
    assert excerpt("牆: gian", 4, 8) == ("牆: gian", "    ^^^^")
    assert excerpt("e\u0301: gian", 5, 9)[1] == "   ^^^^"


def test_nothing_of_the_text_moves_the_cursor() -> None:
    line, carets = excerpt("\x1b[2J: \tgian", 8, 12)

    assert line == "�[2J:  gian"
    assert carets == "       ^^^^"


@given(st.integers(1, 5000), st.integers(1, 300), st.integers(0, 5000))
def test_of_a_long_line_the_part_that_is_meant_is_shown(
    before: int, meant: int, after: int
) -> None:
    text = "b" * before + "m" * meant + "a" * after
    line, carets = excerpt(text, before + 1, before + meant + 1)

    assert len(line) <= WIDEST + 2
    start, length = len(carets) - len(carets.lstrip()), carets.count("^")
    assert set(line[start : start + length]) == {"m"}
    assert length == min(meant, line.count("m"))
    assert line.startswith(("b", "…"))


def test_repetitions_are_told_once_and_all_in_file_order() -> None:
    first, second = finding("a\nb", Span(1, 1, 1, 2)), finding("a\nb", Span(2, 1, 2, 2))

    assert in_file_order([second, first, second]) == (first, second)


def test_after_the_first_hundred_it_is_said_that_there_are_more() -> None:
    many = [finding("a\n" * 500, Span(line, 1, line, 2)) for line in range(1, 301)]

    listed = first_ones(many)

    assert listed[:MOST] == tuple(many[:MOST])
    assert [found.code for found in listed[MOST:]] == ["S016"]
    assert first_ones(many[:MOST]) == tuple(many[:MOST])


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_lines_end_as_in_yaml(end: str) -> None:
    source = Source("f.yaml", f"a\x0cb{end}c\u2028d{end}")

    assert [source.line(number) for number in range(5)] == ["", "a\x0cb", "c\u2028d", "", ""]


def test_json_carries_every_field() -> None:
    record = finding("a", Span(1, 1, 1, 2)).as_json()

    assert record == {
        "code": "S102",
        "severity": "error",
        "message": "wrong",
        "file": "specs/reach.yaml",
        "line": 1,
        "column": 1,
        "end_line": 1,
        "end_column": 2,
        "path": "$.gian",
        "help": "help",
    }

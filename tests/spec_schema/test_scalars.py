"""Plain scalars by the tables of YAML 1.2.2, section 10.3.2, and where YAML 1.1 would differ."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from spec_schema.scalars import ScalarValue, resolve


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("", None),
        ("~", None),
        ("null", None),
        ("Null", None),
        ("true", True),
        ("FALSE", False),
        ("0", 0),
        ("-19", -19),
        ("+12", 12),
        ("010", 10),  # YAML 1.1: eight
        ("0o14", 12),
        ("0x3A", 58),
        ("0.", 0.0),
        ("-0.0", -0.0),
        (".5", 0.5),
        ("+12e03", 12000.0),
        ("-2E+05", -200000.0),
        ("1e-3", 0.001),  # PyYAML: a text
        ("12345678901234567890", 12345678901234567890.0),
    ],
)
def test_null_booleans_and_numbers_are_those_of_the_core_schema(
    text: str, value: ScalarValue
) -> None:
    assert resolve(text) == value
    assert type(resolve(text)) is type(value)


TEXTS = ["no", "yes", "on", "off", "y", "n", "1_000", "1:30", "2024-01-01", "0b11", "1.2.3", "1e"]
STRANGE = [
    "0x",
    "0o8",
    ".",
    "-",
    "+",
    "e5",
    "nULL",
    "True!",
    "-0x1",
    "1,5",
    "٣",
    "¹",
    "1.e+",
    ".e1",
]


@pytest.mark.parametrize("text", [*TEXTS, *STRANGE, "inf", "nan", "+.nan", "1\n", " 1", "1 2"])
def test_everything_else_is_text(text: str) -> None:
    assert resolve(text) == text


@pytest.mark.parametrize("text", [".inf", "+.Inf", "-.INF", ".nan", ".NaN", "1e999"])
def test_infinities_and_nan_are_floats_that_models_refuse(text: str) -> None:
    value = resolve(text)

    assert isinstance(value, float)
    assert not math.isfinite(value)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_float_written_by_python_is_read_back(number: float) -> None:
    assert resolve(repr(number)) == number


@given(st.text())
def test_no_text_is_too_strange(text: str) -> None:
    value = resolve(text)

    assert value is None or isinstance(value, bool | int | float) or value == text

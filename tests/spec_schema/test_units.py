"""Units: the committed table is pint's, texts mean what pint says, mistakes are explained."""

import math
import subprocess
import sys
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from spec_schema.unit_grammar import LIKE_THESE
from spec_schema.unit_names import TABLE, table
from spec_schema.unit_table import as_text
from spec_schema.units import (
    DIMENSIONLESS,
    Dimension,
    Unit,
    UnitFault,
    describe,
    parse_quantity,
    parse_unit,
    quantity_in,
)


def test_the_committed_table_is_what_pint_says() -> None:
    assert TABLE.read_text(encoding="utf-8") == as_text(), "python -m spec_schema.unit_table"


@pytest.mark.parametrize(
    ("text", "scale", "si"),
    [
        ("m", 1.0, "m"),
        ("mm", 1e-3, "m"),
        ("km/h", 1 / 3.6, "m/s"),
        ("m/s^2", 1.0, "m/s^2"),
        ("m/s**2", 1.0, "m/s^2"),
        ("m/s²", 1.0, "m/s^2"),
        ("m*s^-2", 1.0, "m/s^2"),
        ("m·s⁻²", 1.0, "m/s^2"),
        ("m/s/s", 1.0, "m/s^2"),
        ("m/s*s", 1.0, "m"),
        ("m/(s*s)", 1.0, "m/s^2"),
        ("kg*m/s^2", 1.0, "kg*m/s^2"),
        ("N", 1.0, "kg*m/s^2"),
        ("W/(m^2*K)", 1.0, "kg/(s^3*K)"),
        ("1", 1.0, "1"),
        ("1/s", 1.0, "1/s"),
        ("Hz", 1.0, "1/s"),
        ("rpm", math.tau / 60, "1/s"),
        ("rad", 1.0, "1"),
        ("deg", math.pi / 180, "1"),
        ("°/s", math.pi / 180, "1/s"),
        ("mrad", 1e-3, "1"),
        ("%", 0.01, "1"),
        ("%/s", 0.01, "1/s"),
        ("lux", 1.0, "cd/m^2"),
        ("us", 1e-6, "s"),
        ("µs", 1e-6, "s"),
        ("μs", 1e-6, "s"),
        ("mAh", 3.6, "s*A"),
        ("ft", 0.3048, "m"),
        ("m^0.5", 1.0, "m^(1/2)"),
        ("rad/Hz^(1/2)", 1.0, "s^(1/2)"),
        ("  m / s ", 1.0, "m/s"),
    ],
)
def test_a_unit_has_this_scale_and_dimension(text: str, scale: float, si: str) -> None:
    unit = parse_unit(text)
    assert unit.text == text.strip()
    assert unit.scale == pytest.approx(scale, rel=1e-15)
    assert describe(unit.dimension) == si


def test_a_unit_that_the_table_lacks_comes_from_pint() -> None:
    assert "furlong" not in table()
    assert parse_unit("furlong/fortnight").scale == pytest.approx(201.168 / (14 * 86400), rel=1e-5)


def test_common_units_are_read_without_pint_and_numpy() -> None:
    code = (
        "import sys; from spec_schema.units import parse_quantity;"
        "parse_quantity('30 deg/s'); parse_quantity('5 km/h');"
        "assert not {'pint', 'numpy', 'pydantic'} & set(sys.modules), sorted(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


def fault_of(text: str) -> tuple[str, str, str, str]:
    with pytest.raises(UnitFault) as caught:
        parse_unit(text)
    fault = caught.value.fault
    return text[fault.start : fault.end], fault.code, fault.message, fault.help


@pytest.mark.parametrize(
    ("text", "at", "code", "message", "advice"),
    [
        ("m/sec2", "sec2", "S121", "no unit is named 'sec2'", "write sec^2"),
        ("m/s2", "s2", "S121", "no unit is named 's2'", "write s^2"),
        ("Km/h", "Km", "S121", "no unit is named 'Km'", "did you mean 'km'?"),
        ("metters", "metters", "S121", "no unit is named 'metters'", "did you mean 'meters'?"),
        ("m s", "s", "S122", "the unit can't be read from 's'",
         "write * for a product, as in kg*m"),
        ("m/", "/", "S122", "the unit ends too early", LIKE_THESE),
        ("(m", "m", "S122", "the unit ends too early", "add ')'"),
        ("m)", ")", "S122", "the unit can't be read from ')'", LIKE_THESE),
        ("m//s", "/s", "S122", "the unit can't be read from '/s'", LIKE_THESE),
        ("2*m", "2*m", "S122", "the unit can't be read from '2*m'", LIKE_THESE),
        ("", "", "S122", "the unit is empty", 'write "1" for a number without unit'),
        ("m^99", "^99", "S122", "an exponent is at most 20 (got 99)", ""),
        ("m^(1/0)", "^(1/0)", "S122", "the unit can't be read from '^(1/0)'", LIKE_THESE),
        ("degC", "degC", "S123", "'degC' is no multiple of an SI unit: its zero lies elsewhere",
         "use K, and an offset where it is measured"),
        ("dB", "dB", "S123", "'dB' is a logarithm, no multiple of an SI unit",
         "use the ratio itself, with unit 1"),
    ],
)  # fmt: skip
def test_a_unit_that_is_none_is_explained(
    text: str, at: str, code: str, message: str, advice: str
) -> None:
    assert fault_of(text) == (at, code, message, advice)


@pytest.mark.parametrize(
    "text",
    ["m" * 101, "(" * 50 + "m" + ")" * 50, "km^20*" * 17 + "km^20", "1/" * 49 + "m", "\0", "m^²"],
)
def test_a_hostile_unit_is_refused_or_read(text: str) -> None:
    try:
        unit = parse_unit(text)
    except UnitFault as error:
        fault = error.fault
        assert 0 <= fault.start < fault.end <= len(text)  # either outcome will do
    else:
        assert math.isfinite(unit.scale)


@given(st.text(alphabet="ms kg*/^()12-.°%²⁻N", max_size=14))
def test_no_text_breaks_the_reader_of_units(text: str) -> None:
    try:
        unit = parse_unit(text)
    except UnitFault as error:
        assert 0 <= error.fault.start < error.fault.end <= max(1, len(text))  # noqa: PT017  # as above
    else:
        assert unit.scale > 0


EXPONENTS = st.one_of(st.integers(-4, 4).map(Fraction), st.fractions(-4, 4, max_denominator=6))


@given(st.tuples(*[EXPONENTS] * 7))
def test_a_described_dimension_reads_back(dimension: Dimension) -> None:
    unit = parse_unit(describe(dimension))
    assert (unit.scale, unit.dimension) == (1.0, dimension)


@given(st.sampled_from(sorted(table())), st.sampled_from(sorted(table())), st.integers(-3, 3))
def test_units_multiply_as_numbers_do(first: str, second: str, n: int) -> None:
    a, b, both = parse_unit(first), parse_unit(second), parse_unit(f"{first}/{second}^{n}")
    assert both.scale == pytest.approx(a.scale / b.scale**n, rel=1e-12)
    assert both.dimension == tuple(x - n * y for x, y in zip(a.dimension, b.dimension, strict=True))


@pytest.mark.parametrize(
    ("text", "value", "unit"),
    [
        ("0.05 m", 0.05, "m"),
        ("2 %", 0.02, "%"),
        ("180deg", math.pi, "deg"),
        ("-1e-3 m", -1e-3, "m"),
        (" +.5  km/h ", 0.5 / 3.6, "km/h"),
        ("250 ms", 0.25, "ms"),
        ("3 1", 3.0, "1"),
    ],
)
def test_a_quantity_is_a_number_of_units(text: str, value: float, unit: str) -> None:
    quantity = parse_quantity(text)
    assert quantity.value == pytest.approx(value, rel=1e-15)
    assert quantity.unit.text == unit


@pytest.mark.parametrize(
    ("text", "at", "code", "message", "advice"),
    [
        ("m", "m", "S124", "a quantity begins with a number (got 'm')", "write it as '0.05 m/s'"),
        ("", "", "S124", "a quantity begins with a number (got '')", "write it as '0.05 m/s'"),
        ("5", "5", "S124", "'5' lacks a unit", "write 5 without quotes, or add its unit"),
        ("1e999 m", "1e999", "S124", "the number 1e999 is too large", "write a finite one"),
        ("5 mmm", "mmm", "S121", "no unit is named 'mmm'", "did you mean 'mm'?"),
        ("5 furlongz", "furlongz", "S121", "no unit is named 'furlongz'", "write it in m/s"),
        ("0.5 s", "0.5 s", "S125", "0.5 s can't be read in m/s", "write it in m/s"),
        ("1 km", "1 km", "S125", "1 km can't be read in m/s", "write it in m/s; km is m in SI"),
    ],
)
def test_a_quantity_that_is_none_is_explained(
    text: str, at: str, code: str, message: str, advice: str
) -> None:
    with pytest.raises(UnitFault) as caught:
        quantity_in(text, parse_unit("m/s"))
    fault = caught.value.fault
    assert (text[fault.start : fault.end], fault.code, fault.message, fault.help) == (
        at,
        code,
        message,
        advice,
    )


def test_a_quantity_of_the_wanted_dimension_is_its_si_value() -> None:
    wanted = Unit("m/s", 1.0, parse_unit("m/s").dimension)
    assert quantity_in("36 km/h", wanted) == pytest.approx(10.0, rel=1e-15)
    assert quantity_in("50 %", Unit("1", 1.0, DIMENSIONLESS)) == 0.5

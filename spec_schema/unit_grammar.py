"""The grammar of a unit: `product = power (("*" | "/") power)*`, `power = atom exponent?`.

An atom is a unit's name, `1`, or a product in brackets; an exponent is `^2`, `**-1`, `²`, `^0.5`
or `^(1/2)`.
"""

import re
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import final

from spec_schema.dimension import DIMENSIONLESS, Dimension, power, product
from spec_schema.faults import Fault, UnitFault
from spec_schema.suggest import did_you_mean
from spec_schema.unit_names import meaning, table

LONGEST = 100
"""Characters in a unit; it bounds the brackets in brackets, too."""

GREATEST_EXPONENT = 20
"""Of one factor of a unit."""

LIKE_THESE = "units are such as m, cm, s, ms, deg, rad/s, kg, lx or 1"

SIGN = re.compile(r"\s*([*/·⋅])(?!\*)\s*")
OPEN = re.compile(r"\(\s*")
CLOSE = re.compile(r"\s*\)")
ONE = re.compile(r"1(?![\d.])")
NAME = re.compile(r"[^\W\d_⁰¹²³⁴-⁹][^\W⁰¹²³⁴-⁹]*|%|°")
EXPONENT = re.compile(
    r"\s*(?:\^|\*\*)\s*([+-]?\d+(?:\.\d+)?|\(\s*[+-]?\d+\s*(?:/\s*\d*[1-9]\s*)?\))|([⁺⁻]?[⁰¹²³⁴-⁹]+)",
    re.ASCII,
)
RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻", "0123456789+-")


@final
@dataclass(frozen=True, slots=True)
class Factor:
    """A part of a unit: its SI scale, its dimension, and where in the text it ends."""

    scale: float
    dimension: Dimension
    end: int


def read_unit(text: str) -> Factor:
    """Scale and dimension of a unit's text.

    Raises:
        UnitFault: where it can't be read (S122) or names no unit of ours (S121, S123).
    """
    if len(text) > LONGEST:
        message = f"a unit has at most {LONGEST} characters (got {len(text)})"
        raise UnitFault(Fault(0, len(text), "S122", message))
    if not text.strip():
        advice = 'write "1" for a number without unit'
        raise UnitFault(Fault(0, max(1, len(text)), "S122", "the unit is empty", advice))
    factor = _product(text, len(text) - len(text.lstrip()))
    if factor.end < len(text.rstrip()):
        raise _unread(text, factor.end)
    return factor


def _product(text: str, start: int) -> Factor:
    factor = _power(text, start)
    while sign := SIGN.match(text, factor.end):
        right = _power(text, sign.end())
        if sign.group(1) == "/":
            right = _raised(right, Fraction(-1), text, sign.start(1))
        factor = Factor(
            factor.scale * right.scale, product(factor.dimension, right.dimension), right.end
        )
    return factor


def _power(text: str, start: int) -> Factor:
    factor = _atom(text, start)
    match = EXPONENT.match(text, factor.end)
    if not match:
        return factor
    written = match.group(1) or match.group(2).translate(RAISED)
    exponent = Fraction(re.sub(r"[()\s]", "", written))
    return replace(_raised(factor, exponent, text, match.start()), end=match.end())


def _raised(factor: Factor, exponent: Fraction, text: str, at: int) -> Factor:
    if abs(exponent) > GREATEST_EXPONENT:
        message = f"an exponent is at most {GREATEST_EXPONENT} (got {exponent})"
        raise UnitFault(Fault(at, len(text), "S122", message))
    try:
        # The quotient, not the power -1: 1/1000 is exact to rounding and 1000**-1.0 need not be.
        scale = 1.0 / factor.scale if exponent == -1 else factor.scale ** float(exponent)
    except (OverflowError, ZeroDivisionError):
        message = "the unit is too large or too small for a number"
        raise UnitFault(Fault(0, len(text), "S122", message)) from None
    return Factor(scale, power(factor.dimension, exponent), factor.end)


def _atom(text: str, start: int) -> Factor:
    if bracket := OPEN.match(text, start):
        inner = _product(text, bracket.end())
        close = CLOSE.match(text, inner.end)
        if not close:
            raise _unread(text, inner.end, "add ')'")
        return replace(inner, end=close.end())
    if one := ONE.match(text, start):
        return Factor(1.0, DIMENSIONLESS, one.end())
    name = NAME.match(text, start)
    if not name:
        raise _unread(text, start)
    return _named(name)


def _named(match: re.Match[str]) -> Factor:
    name, start, end = match.group(), match.start(), match.end()
    known = meaning(name)
    if known is None:
        raise UnitFault(Fault(start, end, "S121", f"no unit is named '{name}'", _nearest(name)))
    scale, dimension = known
    if scale is None:
        raise UnitFault(Fault(start, end, "S123", *_why_no_multiple(name, dimension)))
    return Factor(scale, dimension, end)


def _nearest(name: str) -> str:
    squeezed = re.fullmatch(r"([^\W\d]+)([1-9])", name)
    if squeezed and squeezed.group(1) in table():
        return f"write {squeezed.group(1)}^{squeezed.group(2)}"
    return did_you_mean(name, table()) or LIKE_THESE


def _why_no_multiple(name: str, dimension: Dimension) -> tuple[str, str]:
    if any(dimension):
        message = f"'{name}' is no multiple of an SI unit: its zero lies elsewhere"
        return message, "use K, and an offset where it is measured"
    message = f"'{name}' is a logarithm, no multiple of an SI unit"
    return message, "use the ratio itself, with unit 1"


def _unread(text: str, start: int, advice: str = "") -> UnitFault:
    rest = text[start:].strip()
    if not rest:
        return UnitFault(
            Fault(start - 1, start, "S122", "the unit ends too early", advice or LIKE_THESE)
        )
    at = text.index(rest[0], start)
    if not advice and NAME.match(rest):
        advice = "write * for a product, as in kg*m"
    advice = advice or LIKE_THESE
    message = f"the unit can't be read from '{rest if len(rest) <= 30 else rest[:27] + '...'}'"
    return UnitFault(Fault(at, len(text.rstrip()), "S122", message, advice))

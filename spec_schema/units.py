"""Units and quantities: what a text like `m/s^2` or `0.05 m` means in SI.

A unit is a product of names: `m`, `m/s`, `kg*m/s^2`, `W/(m^2*K)`, `1/s`, `%`, `1`. Factors are
joined by `*` and `/`, read from left to right as in arithmetic; a power is `^2`, `**2` or `²`,
and may be negative, decimal or a fraction in brackets, `Hz^(1/2)`. A blank joins nothing.
A hertz is 1/s, a turn 2*pi, and rpm are radians per second.
"""

import math
import re
from dataclasses import dataclass, replace
from typing import final

from spec_schema.dimension import DIMENSIONLESS, Dimension, describe
from spec_schema.faults import Fault, UnitFault
from spec_schema.unit_grammar import LIKE_THESE, read_unit

__all__ = [
    "DIMENSIONLESS",
    "Dimension",
    "Quantity",
    "Unit",
    "UnitFault",
    "describe",
    "parse_quantity",
    "parse_unit",
    "quantity_in",
]

NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*", re.ASCII)


@final
@dataclass(frozen=True, slots=True)
class Unit:
    """A unit as the user wrote it; `scale` is the SI value of one of it."""

    text: str
    scale: float
    dimension: Dimension


@final
@dataclass(frozen=True, slots=True)
class Quantity:
    """A number of units; `value` is in SI."""

    value: float
    unit: Unit


def parse_unit(text: str) -> Unit:
    """The unit that the text means.

    Raises:
        UnitFault: where it means none, with the nearest one that exists.

    >>> unit = parse_unit("km/h")
    >>> round(unit.scale, 6), describe(unit.dimension)
    (0.277778, 'm/s')
    """
    factor = read_unit(text)
    return Unit(text.strip(), factor.scale, factor.dimension)


def parse_quantity(text: str) -> Quantity:
    """The quantity that a number and a unit mean: `0.05 m`, `2 %`, `180deg`.

    Raises:
        UnitFault: where there is no number, no unit, or none that exists.

    >>> parse_quantity("250 ms").value
    0.25
    """
    match = NUMBER.match(text)
    if not match:
        message = f"a quantity begins with a number (got '{_short(text)}')"
        raise UnitFault(Fault(0, max(1, len(text)), "S124", message, "write it as '0.05 m'"))
    number, written = float(match.group(1)), _short(match.group(1))
    if math.isinf(number):
        message = f"the number {written} is too large"
        raise UnitFault(Fault(*match.span(1), "S124", message, "write a finite one"))
    if match.end() == len(text):
        advice = f"write {written} without quotes, or add its unit"
        raise UnitFault(Fault(*match.span(1), "S124", f"'{written}' lacks a unit", advice))
    try:
        unit = parse_unit(text[match.end() :])
    except UnitFault as error:
        start, end = error.fault.start + match.end(), error.fault.end + match.end()
        raise UnitFault(replace(error.fault, start=start, end=end)) from None
    return Quantity(number * unit.scale, unit)


def quantity_in(text: str, wanted: Unit) -> float:
    """The SI value of a quantity that must be of the same dimension as `wanted`.

    Raises:
        UnitFault: as `parse_quantity`, and where the quantity is of another dimension.
    """
    quantity = _quantity_like(text, wanted)
    unit = quantity.unit
    if unit.dimension != wanted.dimension:
        message = f"{_short(text.strip())} can't be read in {wanted.text}"
        advice = _in(wanted)
        told = [_in_si(one) for one in (unit, wanted) if one.text != describe(one.dimension)]
        advice = "; ".join([advice, *([", ".join(told)] if told else [])])
        raise UnitFault(Fault(0, len(text), "S125", message, advice))
    return quantity.value


def _quantity_like(text: str, wanted: Unit) -> Quantity:
    """The quantity; what can't be read as one is asked for in the unit that is wanted."""
    try:
        return parse_quantity(text)
    except UnitFault as error:
        fault = error.fault
        if not NUMBER.match(text):
            example = "0.05" if wanted.text == "1" else f"0.05 {wanted.text}"
            raise UnitFault(replace(fault, help=f"write it as '{example}'")) from None
        if fault.help == LIKE_THESE:
            raise UnitFault(replace(fault, help=_in(wanted))) from None
        raise


def _in(wanted: Unit) -> str:
    return "write a plain number" if wanted.text == "1" else f"write it in {wanted.text}"


def _in_si(unit: Unit) -> str:
    return f"{unit.text} is {describe(unit.dimension)} in SI"


def _short(text: str) -> str:
    return text if len(text) <= 30 else f"{text[:27]}..."

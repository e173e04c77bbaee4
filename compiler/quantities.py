"""Numbers with units, as the spec writes them, in SI."""

from fractions import Fraction

from compiler.findings import Findings
from spec_schema.dimension import DIMENSIONLESS, describe, quotient
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.parse import parse
from spec_schema.expressions.rewrite import unknown_names
from spec_schema.faults import ExpressionError, UnitFault
from spec_schema.places import Path
from spec_schema.units import Unit, parse_unit, quantity_in

ONE = Unit("1", 1.0, DIMENSIONLESS)
SECOND = Unit("s", 1.0, (Fraction(0), Fraction(0), Fraction(1), *(Fraction(0),) * 4))

LONG = 5.0
"""Seconds: a robot's time that is written without a unit and is as long as this was meant in ms."""


def unit_of(text: str | None, path: Path, findings: Findings) -> Unit | None:
    """The unit that a text means; None, and a finding, where it means none."""
    if text is None:
        return None
    try:
        return parse_unit(text)
    except UnitFault as error:
        findings.fault(path, error.fault)
        return None


def si_value(value: float | str, unit: Unit | None, path: Path, findings: Findings) -> float | None:
    """A number in `unit`, or a quantity like it, in SI; None where it can't be told."""
    if unit is None:
        return None
    if not isinstance(value, str):
        return value * unit.scale
    try:
        return quantity_in(value, unit)
    except UnitFault as error:
        findings.fault(path, error.fault)
        return None


def si_time(value: float | str, path: Path, findings: Findings) -> float | None:
    """A robot's time in seconds; None where it can't be told, or was probably meant in ms."""
    if is_without_ms(value, path, findings):
        return None
    return si_value(value, SECOND, path, findings)


def is_without_ms(value: float | str, path: Path, findings: Findings) -> bool:
    """Whether milliseconds were probably meant, and a finding where they were."""
    if isinstance(value, str) or value < LONG:
        return False
    message = f"a plain number is in seconds: did you mean {value:g} ms?"
    remedy = f"write '{value:g} ms', or '{value:g} s' if that is meant"
    findings.error("S212", path, message, remedy)
    return True


def si_within(
    value: float | str,
    name: str,
    domain: tuple[float, float],
    unit: Unit,
    code: str,
    path: Path,
    findings: Findings,
) -> float | None:
    """A value in SI for what `name` says, within its domain (SI); outside is a finding: `code`."""
    found = si_value(value, unit, path, findings)
    low, high = domain
    if found is None or low <= found <= high:
        return found
    shown = f"[{low / unit.scale:.4g}, {high / unit.scale:.4g}] {unit.text}".removesuffix(" 1")
    message = f"{value} is outside the domain of '{name}', {shown}"
    findings.error(code, path, message, "write a value within it")
    return None


def si_limit(value: float | str, unit: Unit | None, path: Path, findings: Findings) -> float | None:
    """A limit of a domain in SI: a number, a quantity, or an expression such as `-pi`."""
    if unit is None or not isinstance(value, str):
        return si_value(value, unit, path, findings)
    try:
        expr = parse(value)
    except ExpressionError as error:
        try:
            return quantity_in(value, unit)
        except UnitFault as second:
            is_quantity = value.strip()[:1].isdigit() or value.strip()[:1] in "+-."
            for fault in (second.fault,) if is_quantity else error.faults:
                findings.fault(path, fault)
            return None
    faults = unknown_names(expr, ())
    for fault in faults:
        findings.fault(path, fault)
    return None if faults else evaluate(expr, {}) * unit.scale


def per_second(unit: Unit) -> Unit:
    """The unit of the rate of something that is in `unit`."""
    dimension = quotient(unit.dimension, SECOND.dimension)
    return Unit(rate_text(unit.text), unit.scale, dimension)


def rate_text(unit: str) -> str:
    """`unit` per second, as text.

    >>> rate_text("m"), rate_text("m/s"), rate_text("1")
    ('m/s', 'm/s^2', '1/s')
    """
    if unit == "1":
        return "1/s"
    return f"{unit}^2" if unit.endswith("/s") else f"{unit}/s"


def like(unit: Unit) -> str:
    """A unit for people: its text, and what it is in SI where that says more."""
    in_si = describe(unit.dimension)
    return unit.text if unit.text == in_si else f"{unit.text} ({in_si} in SI)"

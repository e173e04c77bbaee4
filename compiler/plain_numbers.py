"""Expressions whose numbers are in SI and have no units: conditions that were learned, rewards."""

from dataclasses import replace

from compiler.findings import Findings
from spec_schema.expressions.parse import parse
from spec_schema.expressions.tree import Expr
from spec_schema.faults import ExpressionError, Fault, UnitFault
from spec_schema.places import Path
from spec_schema.units import parse_quantity
from spec_schema.wording import number


def parsed(text: str, path: Path, findings: Findings) -> Expr | None:
    """The tree of an expression; None, and findings, where it can't be read."""
    try:
        return parse(text)
    except ExpressionError as error:
        for fault in error.faults:
            findings.fault(path, _in_si(fault, text))
        return None


def _in_si(fault: Fault, text: str) -> Fault:
    """The fault; where it is a number with a unit, with that number in SI."""
    try:
        meant = parse_quantity(text[fault.start : fault.end]).value
    except UnitFault:
        return fault
    message = "numbers are in SI here, and have no unit"
    return replace(fault, message=message, help=f"write `{number(meant)}`")

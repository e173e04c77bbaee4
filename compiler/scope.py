"""What an expression may read, and how one is read: parsed, names found, dimension checked."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import final

from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.quantities import like, per_second
from spec_schema.dimension import DIMENSIONLESS, Dimension, describe
from spec_schema.expressions.dimensions import dimension_of
from spec_schema.expressions.parse import parse
from spec_schema.expressions.rewrite import names_in, resolve_texts, unknown_names
from spec_schema.expressions.tree import Expr
from spec_schema.faults import ExpressionError
from spec_schema.places import Path
from spec_schema.units import Unit


@final
@dataclass(frozen=True, slots=True)
class Scope:
    """What an expression may read: dimensions, and the values of discrete names."""

    dimensions: Mapping[str, Dimension | None]
    values: Mapping[str, tuple[str, ...]]


def scope_of(declared: Declarations) -> Scope:
    """The scope of everything that is declared."""
    dimensions = {
        name: DIMENSIONLESS if name in declared.values else dimension_in(declared.units.get(name))
        for name in declared.register
    }
    return Scope(dimensions, declared.values)


def read(text: str, path: Path, scope: Scope, findings: Findings) -> Expr | None:
    """The tree of one expression; None, and findings, where it can't be used."""
    try:
        expr = parse(text)
    except ExpressionError as error:
        for fault in error.faults:
            findings.fault(path, fault)
        return None
    faults = unknown_names(expr, scope.dimensions)
    resolved, more = resolve_texts(expr, scope.values)
    for fault in (*faults, *more):
        findings.fault(path, fault)
    return None if faults or more else resolved


def checked(
    text: str, path: Path, scope: Scope, wanted: Unit | None, what: str, findings: Findings
) -> Expr | None:
    """The tree of an expression whose dimension must be that of `wanted` (None: any)."""
    expr = read(text, path, scope, findings)
    if expr is None:
        _tell_dimensions(text, path, scope, findings)
        return None
    known = {n: scope.dimensions[n] for n in names_in(expr)}
    dimensions = {name: dimension for name, dimension in known.items() if dimension is not None}
    dimension, faults = dimension_of(expr, dimensions)
    for fault in faults:
        findings.fault(path, fault)
    if len(dimensions) < len(known):
        return expr  # an unreadable unit was told already; the rate's own would follow from it
    if dimension is None or wanted is None or dimension == wanted.dimension:
        return expr
    if not _is_zero(expr):
        message = f"{what} is in {describe(dimension)}, and {like(wanted)} is wanted"
        findings.error("S211", path, message, "multiply by a constant that has the missing unit")
    return expr


def _tell_dimensions(text: str, path: Path, scope: Scope, findings: Findings) -> None:
    """What is wrong with the known names of an expression that reads an unknown one as well."""
    try:
        expr = parse(text)
    except ExpressionError:
        return
    known = {n: d for n in names_in(expr) if (d := scope.dimensions.get(n)) is not None}
    for fault in dimension_of(expr, known)[1]:
        findings.fault(path, fault)


def wanted_of(name: str, declared: Declarations, *, is_map: bool) -> Unit | None:
    """The unit of a rate; None where nothing is asked: every state is a plain number."""
    unit = declared.units.get(name)
    if unit is None or is_map:
        return unit
    if all(declared.units[s].text == "1" for s in declared.continuous if s in declared.units):
        return None
    return per_second(unit)


def dimension_in(unit: Unit | None) -> Dimension | None:
    """The dimension of what is in `unit`; None where that could not be read."""
    return None if unit is None else unit.dimension


def _is_zero(expr: Expr) -> bool:
    return getattr(expr, "value", None) == 0.0

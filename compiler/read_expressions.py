"""Pass 2: every expression parsed, its names found, its dimension checked against its place."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import final

from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.quantities import like, per_second, unit_of
from runtime.program import Role
from spec_schema.behavior import BehaviorSpec
from spec_schema.dimension import DIMENSIONLESS, Dimension, describe
from spec_schema.expressions.dimensions import dimension_of
from spec_schema.expressions.parse import parse
from spec_schema.expressions.rewrite import names_in, resolve_texts, unknown_names
from spec_schema.expressions.tree import Expr
from spec_schema.faults import ExpressionError
from spec_schema.field_forms import Formula, Step
from spec_schema.places import Path
from spec_schema.units import Unit


@final
@dataclass(frozen=True, slots=True)
class Expressions:
    """The trees of a behavior. rates: of the driven states (for a step map, their next values)."""

    rates: Mapping[str, Expr]
    closures: Mapping[str, Expr]
    outputs: Mapping[str, Expr]
    judge_when: Expr | None


@final
@dataclass(frozen=True, slots=True)
class Scope:
    """What an expression may read: dimensions, and the values of discrete names."""

    dimensions: Mapping[str, Dimension | None]
    values: Mapping[str, tuple[str, ...]]


def read_expressions(spec: BehaviorSpec, declared: Declarations, findings: Findings) -> Expressions:
    """Every expression that can be read, and a finding for each mistake in one."""
    scope = _scope(declared)
    rates = _rates(spec, declared, scope, findings)
    closures = _closures(spec, declared, scope, findings)
    outputs = _outputs(spec, scope, findings)
    judge_when = None
    if spec.judge_when is not None:
        wider = _with_signals(spec, scope, findings)
        judge_when = _read(spec.judge_when, ("judge_when",), wider, findings)
    return Expressions(rates, closures, outputs, judge_when)


def signals(spec: BehaviorSpec) -> tuple[str, ...]:
    """The names under `trace:` that are declared nowhere: only `judge_when` reads them."""
    declared = {*spec.state, *spec.control, *spec.constants, *spec.output}
    return tuple(name for name in spec.trace if name not in declared)


def _scope(declared: Declarations) -> Scope:
    dimensions = {
        name: DIMENSIONLESS if name in declared.values else _dimension(declared.units.get(name))
        for name in declared.register
    }
    return Scope(dimensions, declared.values)


def _dimension(unit: Unit | None) -> Dimension | None:
    return None if unit is None else unit.dimension


def _with_signals(spec: BehaviorSpec, scope: Scope, findings: Findings) -> Scope:
    dimensions, values = dict(scope.dimensions), dict(scope.values)
    for name in signals(spec):
        entry = spec.trace[name]
        if entry.values is not None:
            values[name] = tuple(dict.fromkeys(entry.values.values()))
        unit = unit_of(entry.unit, ("trace", name, "unit"), findings)
        dimensions[name] = DIMENSIONLESS if entry.unit is None else _dimension(unit)
    return Scope(dimensions, values)


def _read(text: str, path: Path, scope: Scope, findings: Findings) -> Expr | None:
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


def _checked(
    text: str, path: Path, scope: Scope, wanted: Unit | None, what: str, findings: Findings
) -> Expr | None:
    """The tree of an expression whose dimension must be that of `wanted` (None: any)."""
    expr = _read(text, path, scope, findings)
    if expr is None:
        return None
    known = {n: scope.dimensions[n] for n in names_in(expr)}
    dimensions = {name: dimension for name, dimension in known.items() if dimension is not None}
    if len(dimensions) < len(known):
        return expr  # an unreadable unit was told already; anything said here would follow from it
    dimension, faults = dimension_of(expr, dimensions)
    for fault in faults:
        findings.fault(path, fault)
    if dimension is None or wanted is None or dimension == wanted.dimension:
        return expr
    if not _is_zero(expr):
        message = f"{what} is in {describe(dimension)}, and {like(wanted)} is wanted"
        findings.error("S211", path, message, "multiply by a constant that has the missing unit")
    return expr


def _is_zero(expr: Expr) -> bool:
    return getattr(expr, "value", None) == 0.0


def _rates(
    spec: BehaviorSpec, declared: Declarations, scope: Scope, findings: Findings
) -> dict[str, Expr]:
    form = spec.field.form
    if isinstance(form, Formula):
        base: Path = ("field", "formula")
        texts, is_map = form.rates, False
    elif isinstance(form, Step):
        base = ("field", "step", "next")
        texts, is_map = form.next, True
    else:
        return {}
    _match_names(texts, base, declared, findings)
    found: dict[str, Expr] = {}
    for name in texts:
        path = (*base, name)
        what = f"the {'next value' if is_map else 'rate'} of '{name}'"
        wanted = _wanted(name, declared, is_map=is_map)
        expr = _checked(texts[name], path, scope, wanted, what, findings)
        if expr is not None:
            _refuse_unsensed(expr, path, declared, findings)
            found[name] = expr
    return found


def _wanted(name: str, declared: Declarations, *, is_map: bool) -> Unit | None:
    """The unit of a rate; None where nothing is asked: every state is a plain number."""
    unit = declared.units.get(name)
    if unit is None or is_map:
        return unit
    if all(declared.units[s].text == "1" for s in declared.continuous if s in declared.units):
        return None
    return per_second(unit)


def _match_names(
    given: Collection[str], path: Path, declared: Declarations, findings: Findings
) -> None:
    driven = [state.name for state in declared.driven]
    missing = [name for name in driven if name not in given]
    if missing:
        message = f"the field gives no rate for {_listed(missing)}"
        remedy = f"add `{missing[0]}: ...`, or write `role: sensed` for what it does not move"
        findings.error("S204", path, message, remedy, key=True)
    for name in given:
        if name not in driven:
            known = name in {state.name for state in declared.states}
            why = "is only sensed, so the field gives no rate for it" if known else "is no state"
            findings.error(
                "S205",
                (*path, name),
                f"'{name}' {why}",
                "write `role: both` or a `closure`" if known else f"the states: {_listed(driven)}",
                key=True,
            )


def _refuse_unsensed(expr: Expr, path: Path, declared: Declarations, findings: Findings) -> None:
    blind = {state.name for state in declared.states if state.role is Role.DRIVEN}
    for name in sorted(names_in(expr) & blind):
        findings.error(
            "S206",
            path,
            f"the field reads '{name}', which the behavior drives but does not sense",
            f"write `role: both` for '{name}' if it is sensed as well",
        )


def _closures(
    spec: BehaviorSpec, declared: Declarations, scope: Scope, findings: Findings
) -> dict[str, Expr]:
    is_map = isinstance(spec.field.form, Step)
    found: dict[str, Expr] = {}
    for name, state in spec.state.items():
        if state.closure is not None:
            path = ("state", name, "closure")
            wanted = _wanted(name, declared, is_map=is_map)
            what = f"the closure of '{name}'"
            expr = _checked(state.closure, path, scope, wanted, what, findings)
            if expr is not None:
                found[name] = expr
    return found


def _outputs(spec: BehaviorSpec, scope: Scope, findings: Findings) -> dict[str, Expr]:
    found: dict[str, Expr] = {}
    for name, output in spec.output.items():
        wanted = unit_of(output.unit, ("output", name, "unit"), findings)
        path = ("output", name, "is")
        expr = _checked(output.expression, path, scope, wanted, f"output '{name}'", findings)
        if expr is not None:
            found[name] = expr
    return found


def _listed(names: Collection[str]) -> str:
    return ", ".join(f"'{name}'" for name in names)

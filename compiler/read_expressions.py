"""Pass 2: every expression parsed, its names found, its dimension checked against its place."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import final

from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.noise import read_noise
from compiler.quantities import unit_of
from compiler.read_modes import Way, read_modes
from compiler.read_rates import read_rates
from compiler.scope import Scope, checked, dimension_in, read, scope_of, wanted_of
from compiler.sketch.drawing import Drawing
from compiler.sketch.reading import read_sketch
from spec_schema.arbiter import ArbiterSpec
from spec_schema.behavior import BehaviorSpec
from spec_schema.dimension import DIMENSIONLESS
from spec_schema.expressions.tree import Expr
from spec_schema.field_forms import Formula, Step
from spec_schema.field_modes import Modes
from spec_schema.field_sketch import Sketch


@final
@dataclass(frozen=True, slots=True)
class Expressions:
    """The trees of a behavior.

    rates: of the driven states (for a step map, their next values). ways: between its modes.
    drawing: a sketched field. noise: sizes of the noise of driven states.
    """

    rates: Mapping[str, Expr]
    closures: Mapping[str, Expr]
    outputs: Mapping[str, Expr]
    judge_when: Expr | None
    ways: tuple[Way, ...] = ()
    drawing: Drawing | None = None
    noise: Mapping[str, Expr] = field(default_factory=dict)


def read_expressions(spec: BehaviorSpec, declared: Declarations, findings: Findings) -> Expressions:
    """Every expression that can be read, and a finding for each mistake in one."""
    scope = scope_of(declared)
    rates, ways = _rates(spec, declared, scope, findings)
    closures = _closures(spec, declared, scope, findings)
    outputs = read_outputs(spec, scope, findings)
    judge_when = None
    if spec.judge_when is not None:
        wider = with_signals(spec, scope, findings)
        judge_when = read(spec.judge_when, ("judge_when",), wider, findings)
    drawing = None
    if isinstance(spec.field.form, Sketch):
        drawing = read_sketch(spec.field.form, declared, scope, findings)
    noise = read_noise(spec, declared, scope, findings)
    return Expressions(rates, closures, outputs, judge_when, ways, drawing, noise)


def signals(spec: BehaviorSpec | ArbiterSpec) -> tuple[str, ...]:
    """The names under `trace:` that are declared nowhere: only `judge_when` reads them."""
    states = spec.state if isinstance(spec, BehaviorSpec) else {*spec.reads, "choice"}
    declared = {*states, *spec.control, *spec.constants, *spec.output}
    return tuple(name for name in spec.trace if name not in declared)


def with_signals(spec: BehaviorSpec | ArbiterSpec, scope: Scope, findings: Findings) -> Scope:
    """The scope with the signals that `judge_when` may read beside."""
    dimensions, values = dict(scope.dimensions), dict(scope.values)
    for name in signals(spec):
        entry = spec.trace[name]
        if entry.values is not None:
            values[name] = tuple(dict.fromkeys(entry.values.values()))
        unit = unit_of(entry.unit, ("trace", name, "unit"), findings)
        dimensions[name] = DIMENSIONLESS if entry.unit is None else dimension_in(unit)
    return Scope(dimensions, values)


def _rates(
    spec: BehaviorSpec, declared: Declarations, scope: Scope, findings: Findings
) -> tuple[dict[str, Expr], tuple[Way, ...]]:
    match spec.field.form:
        case Formula() as form:
            return read_rates(form.rates, ("field", "formula"), declared, scope, findings), ()
        case Step() as form:
            base = ("field", "step", "next")
            return read_rates(form.next, base, declared, scope, findings, is_map=True), ()
        case Modes() as form:
            return read_modes(form, declared, scope, findings)
        case _:
            return {}, ()


def _closures(
    spec: BehaviorSpec, declared: Declarations, scope: Scope, findings: Findings
) -> dict[str, Expr]:
    is_map = isinstance(spec.field.form, Step)
    found: dict[str, Expr] = {}
    for name, state in spec.state.items():
        if state.closure is not None:
            path = ("state", name, "closure")
            wanted = wanted_of(name, declared, is_map=is_map)
            what = f"the closure of '{name}'"
            expr = checked(state.closure, path, scope, wanted, what, findings)
            if expr is not None:
                found[name] = expr
    return found


def read_outputs(
    spec: BehaviorSpec | ArbiterSpec, scope: Scope, findings: Findings
) -> dict[str, Expr]:
    """The trees of the outputs, by name."""
    found: dict[str, Expr] = {}
    for name, output in spec.output.items():
        wanted = unit_of(output.unit, ("output", name, "unit"), findings)
        path = ("output", name, "is")
        expr = checked(output.expression, path, scope, wanted, f"output '{name}'", findings)
        if expr is not None:
            found[name] = expr
    return found

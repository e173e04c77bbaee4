"""How the field shall be tabulated: the `table:` block and the step of a map, in SI."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import final

from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.quantities import SECOND, per_second, si_value
from runtime.program import Kind
from runtime.table import Method
from spec_schema.behavior import BehaviorSpec
from spec_schema.field_forms import Formula, Step
from spec_schema.field_modes import Modes

LEAST = {Method.CUBIC: 4, Method.LINEAR: 2}
"""Nodes that an axis needs."""


@final
@dataclass(frozen=True, slots=True)
class Settings:
    """How the tables shall be.

    tolerance: (m,) of the driven states' rates (of a map: next values), in SI; None where the
    spec declares none. every: seconds of a map's step, else 0.
    strictness: what the error of each table is held below its share by.
    """

    method: Method
    tolerance: tuple[float | None, ...]
    fixed: Mapping[str, int]
    budget: int
    every: float
    strictness: float = 1.0


def settings_of(spec: BehaviorSpec, declared: Declarations, findings: Findings) -> Settings:
    """The settings that can be read, and a finding for each that can't be used."""
    form = spec.field.form
    if spec.table.keep == "code" and not isinstance(form, Formula | Step | Modes):
        message = f"a field given as {type(form).__name__.lower()} can't be kept as code"
        findings.error("S246", ("table", "keep"), message, "write `keep: tables`")
    method = Method(spec.table.method)
    for name, count in spec.table.nodes.items():
        periodic = any(s.name == name and s.kind is Kind.PERIODIC for s in declared.states)
        least = max(LEAST[method], 4 if periodic and method is Method.CUBIC else 2)
        if count < least:
            message = f"a {method} table needs at least {least} nodes per axis (got {count})"
            findings.error("S244", ("table", "nodes", name), message, f"write {name}: {least}")
    every = _every(form, findings) if isinstance(form, Step) else 0.0
    tolerance = _tolerances(spec, declared, findings, is_map=isinstance(form, Step))
    return Settings(method, tolerance, spec.table.nodes, spec.table.budget, every)


def _every(form: Step, findings: Findings) -> float:
    path = ("field", "step", "every")
    every = si_value(form.every, SECOND, path, findings)
    if every is not None and every <= 0.0:
        message = f"a step must take some time (got {form.every})"
        findings.error("S212", path, message, "write `every: 0.1 s`")
    return every or 0.0


def _tolerances(
    spec: BehaviorSpec, declared: Declarations, findings: Findings, *, is_map: bool
) -> tuple[float | None, ...]:
    found: list[float | None] = []
    for state in declared.driven:
        unit = declared.units.get(state.name)
        given = spec.table.tolerance.get(state.name)
        path = ("table", "tolerance", state.name)
        value = None
        if given is not None and unit is not None:
            value = si_value(given, unit if is_map else per_second(unit), path, findings)
        if value is not None and value <= 0.0:
            message = f"a tolerance must be positive (got {given})"
            findings.error("S212", path, message, "write how far the table may be off")
        found.append(value)
    return tuple(found)

"""Pass 5: what is to be tabulated. Every form of a field becomes sheets: functions to be tables.

A formula is split into sums of c(controls) * t(states), and the t that stand over the same
variables share a sheet; a sketch, an array or a module is one sheet with a column per driven state.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import final

import numpy as np

from compiler.arrows import arrows_sampler
from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.grid import grid_sampler
from compiler.lower_parts import code_of
from compiler.python_module import ModuleError, sampler
from compiler.references import axes_of, drives_of
from compiler.tabulate import Sampler
from compiler.terms import summands
from runtime.arrays import Array
from runtime.code import ONE, Code
from runtime.machine import evaluate
from runtime.program import Coordinate, Kind
from runtime.table import Table
from spec_schema.behavior import BehaviorSpec
from spec_schema.expressions.bounds import bounds
from spec_schema.expressions.printers.text import to_text
from spec_schema.expressions.rewrite import names_in, simplify, substitute
from spec_schema.expressions.tree import Expr, Number
from spec_schema.field_forms import Arrows, Module
from spec_schema.field_grid import Grid


@final
@dataclass(frozen=True, slots=True)
class Use:
    """A column of a sheet, times a coefficient, is part of the rate of one driven state.

    largest: a bound of the coefficient's magnitude over the domain of the controls.
    """

    component: int
    coefficient: Code
    column: int
    largest: float


@final
@dataclass(frozen=True, eq=False, slots=True)
class Sheet:
    """A function over `over`, with a column for each number it gives.

    table: given where the sheet is a table already, so that there is nothing left to interpolate.
    """

    over: tuple[str, ...]
    columns: int
    sample: Sampler
    uses: tuple[Use, ...]
    table: Table | None = None


@final
class UnboundedError(Exception):
    """A factor of controls grows without bound over their domains."""

    def __init__(self, state: str, coefficient: Expr) -> None:
        self.state, self.coefficient = state, to_text(coefficient)
        super().__init__(f"{self.coefficient} is unbounded")


@final
@dataclass(frozen=True, slots=True)
class Plan:
    """The sheets of a field, and the parts of rates that no state enters: coefficients alone.

    coordinates: what sheets stand over beside states and controls.
    """

    sheets: tuple[Sheet, ...]
    alone: tuple[Use, ...]
    coordinates: tuple[Coordinate, ...] = ()


def plan_formula(rates: Mapping[str, Expr], declared: Declarations) -> Plan:
    """The sheets of a formula (of a step map: of its next values)."""
    box = _box(declared)
    discrete = {name: len(values) for name, values in declared.values.items()}
    constants: dict[str, Expr] = {c.name: Number(c.value) for c in declared.constants}
    parts: dict[tuple[str, ...], list[Expr]] = {}
    uses: dict[tuple[str, ...], list[Use]] = {}
    for component, state in enumerate(declared.driven):
        for summand in summands(rates[state.name], declared.continuous, discrete):
            part = simplify(substitute(summand.part, constants))
            over = tuple(v.name for v in declared.variables if v.name in names_in(part))
            columns = parts.setdefault(over, [])
            if part not in columns:
                columns.append(part)
            low, high = bounds(summand.coefficient, box)
            largest = max(abs(low), abs(high))
            if not math.isfinite(largest):
                raise UnboundedError(state.name, summand.coefficient)
            use = Use(component, code_of(summand.coefficient), columns.index(part), largest)
            uses.setdefault(over, []).append(use)
    alone = _alone(parts.pop((), []), uses.pop((), []))
    sheets = [
        Sheet(over, len(columns), _formula_sampler(over, columns), tuple(uses[over]))
        for over, columns in parts.items()
    ]
    return Plan(tuple(sheets), alone)


def plan_sampled(
    spec: BehaviorSpec, declared: Declarations, beside: FilePath, findings: Findings
) -> Plan | None:
    """The one sheet of a sketched, gridded or programmed field; None where it can't be had."""
    form = spec.field.form
    over, drives = axes_of(form, declared), drives_of(form, declared)
    order = tuple(state.name for state in declared.driven)
    table: Table | None = None
    match form:
        case Arrows():
            sample = arrows_sampler(form, declared, drives, findings)
        case Grid():
            sample, table = grid_sampler(form, spec, declared, drives, beside, findings)
        case Module():
            drives = order
            try:
                sample = sampler(form.call, beside, over, order)
            except ModuleError as error:
                findings.error("S233", ("field", "module", "call"), error.message, error.remedy)
                sample = None
        case _:
            raise AssertionError("formulas and maps are planned by their expressions")
    if sample is None:
        return None
    uses = tuple(Use(order.index(name), ONE, i, 1.0) for i, name in enumerate(drives))
    return Plan((Sheet(over, len(drives), sample, uses, table),), ())


def _box(declared: Declarations) -> dict[str, tuple[float, float]]:
    controls = {control.name: (control.low, control.high) for control in declared.controls}
    constants = {constant.name: (constant.value, constant.value) for constant in declared.constants}
    discrete = {s.name: (s.low, s.high) for s in declared.states if s.kind is Kind.DISCRETE}
    return {**controls, **constants, **discrete}


def _alone(parts: list[Expr], uses: list[Use]) -> tuple[Use, ...]:
    """Terms whose part is a number: the number joins the coefficient."""
    found = []
    for use in uses:
        number = code_of(parts[use.column]).text
        code = use.coefficient.text if number == "1" else f"{use.coefficient.text} {number} mul"
        found.append(Use(use.component, Code(code), -1, use.largest))
    return tuple(found)


def _formula_sampler(over: tuple[str, ...], columns: list[Expr]) -> Sampler:
    codes = [code_of(expr) for expr in columns]

    def sample(points: Array) -> Array:
        with np.errstate(all="ignore"):
            return evaluate(codes, over, np.ascontiguousarray(points))

    return sample

"""Pass 6: sheets become tables, tables become the field of a program, and its error is measured."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from compiler.declare import Declarations
from compiler.lower_parts import code_of
from compiler.plan import Plan, Sheet
from compiler.ranges import Range, range_of
from compiler.references import MOST_AXES
from compiler.sampling import random_points
from compiler.settings import Settings
from compiler.tabulate import (
    MARGIN,
    ROUNDING,
    SEED,
    TableError,
    Tabulated,
    Wanted,
    tabulate_function,
)
from runtime.arrays import Array
from runtime.code import Code
from runtime.flow import Source, flow_of, next_states, rates
from runtime.machine import evaluate
from runtime.program import ErrorBound, Field, Program, Term
from runtime.progress import Progress
from runtime.table import Method, Table
from spec_schema.expressions.tree import Expr

RELATIVE = {  # of the largest rate, where the spec declares no tolerance
    ("formula", Method.CUBIC): 1e-6,
    ("step", Method.CUBIC): 1e-6,
    ("modes", Method.CUBIC): 1e-6,
    ("module", Method.CUBIC): 1e-5,
    ("grid", Method.CUBIC): 1e-5,
    ("arrows", Method.CUBIC): 1e-3,  # a sketch is not known better than that
    ("sketch", Method.CUBIC): 1e-3,  # and here the verifier looks at what came out
}
RELATIVE_LINEAR = 1e-3
SURVEY = 4_096  # points that tell how large a column is
SPOTS = 40_000  # points that measure the whole field against its formula


def lower_field(
    program: Program, plan: Plan, settings: Settings, declared: Declarations, progress: Progress
) -> tuple[tuple[Table, ...], tuple[Term, ...], tuple[ErrorBound, ...]]:
    """The tables and terms of a field, and how far each driven state's rate may be off.

    Raises:
        TableError: a sheet can't be tabulated within tolerance and budget.
    """
    largest = _largest_rates(program, plan, declared)
    tolerance = _tolerances(largest, settings, program.field.form)
    tables: list[Table] = []
    terms = [Term(use.component, use.coefficient, -1, 0) for use in plan.alone]
    error = np.zeros(len(declared.driven))
    points = 0
    for i, sheet in enumerate(plan.sheets):
        progress(f"table over {', '.join(sheet.over)}", i, len(plan.sheets))
        made = _tabulated(sheet, plan, settings, tolerance, declared)
        for use in sheet.uses:
            terms.append(Term(use.component, use.coefficient, len(tables), use.column))
            error[use.component] += use.largest * made.error[use.column]
        tables.append(made.table)
        points += made.points
    progress("measured", len(plan.sheets), len(plan.sheets))
    bounds = tuple(
        ErrorBound(float(e), float(t), points) for e, t in zip(error, tolerance, strict=True)
    )
    return (
        tuple(tables),
        tuple(sorted(terms, key=lambda t: (t.component, t.table, t.column))),
        bounds,
    )


def formula_codes(rates_of: Mapping[str, Expr], field: Field) -> Field:
    """The field with its own expressions beside the tables."""
    return replace(field, formula=tuple(code_of(rates_of[name]) for name in field.driven))


def measured(program: Program) -> Program:
    """The program with its bounds measured as a whole, tables against formula, on fresh points.

    The sum of the sheets' errors stays where it is larger: both are estimates of the same.
    """
    if program.field.formula is None or not program.field.terms:
        return program
    x, u = random_points(program, {}, SPOTS, SEED + 1)
    run = next_states if program.field.is_map else rates
    by_tables, by_formula = (
        run(flow_of(program, source), x, u)[:, list(program.driven)]
        for source in (Source.TABLES, Source.FORMULA)
    )
    difference, size = np.abs(by_tables - by_formula), np.abs(by_formula)
    largest = MARGIN * np.nanmax(difference, axis=0) + ROUNDING * np.nanmax(size, axis=0)
    bounds = tuple(
        replace(b, measured=float(max(e, b.measured)), points=b.points + len(x))
        for b, e in zip(program.field.bounds, largest, strict=True)
    )
    return replace(program, field=replace(program.field, bounds=bounds))


def _largest_rates(program: Program, plan: Plan, declared: Declarations) -> Array:
    """How large the rates (m,) of the driven states become, on random points."""
    if program.field.formula is not None:
        x, u = random_points(program, {}, SPOTS, SEED)
        run = next_states if program.field.is_map else rates
        found = run(flow_of(program, Source.FORMULA), x, u)[:, list(program.driven)]
        sizes = np.abs(found)
    else:
        sizes = np.abs(_sampled(program, plan, declared))
    largest: Array = np.where(np.isfinite(sizes), sizes, 0.0).max(axis=0)
    return largest


def _sampled(program: Program, plan: Plan, declared: Declarations) -> Array:
    """The rates (N, m) of a field without formula, by its sheets, on random points."""
    [sheet] = plan.sheets
    x, u = random_points(program, {}, SURVEY, SEED)
    constants = [constant.value for constant in program.constants]
    register = np.concatenate([x, u, np.broadcast_to(constants, (len(x), len(constants)))], axis=1)
    places = {c.name: c.code for c in plan.coordinates}
    axes = [places.get(name, Code(name)) for name in sheet.over]
    columns = sheet.sample(evaluate(axes, program.register, register))
    factors = evaluate([use.coefficient for use in sheet.uses], program.register, register)
    found = np.zeros((len(x), len(declared.driven)))
    for i, use in enumerate(sheet.uses):
        found[:, use.component] += factors[:, i] * columns[:, use.column]
    return found


def _tolerances(largest: Array, settings: Settings, form: str) -> Array:
    """Absolute tolerances (m,) of the rates: declared, or relative to the largest rate."""
    share = RELATIVE.get((form, settings.method), RELATIVE_LINEAR)
    chosen = np.where(largest > 0.0, share * largest, 1e-12)
    return np.array(
        [c if g is None else g for c, g in zip(chosen, settings.tolerance, strict=True)]
    )


def _tabulated(
    sheet: Sheet, plan: Plan, settings: Settings, tolerance: Array, declared: Declarations
) -> Tabulated:
    if sheet.table is not None:
        return Tabulated(sheet.table, np.zeros(sheet.columns), 0)
    if len(sheet.over) > MOST_AXES:
        raise TableError(
            "S245",
            sheet.over[-1],
            f"the field has a part over {len(sheet.over)} variables ({', '.join(sheet.over)}), and "
            f"a table has at most {MOST_AXES} axes",
            "split it into factors of which each reads fewer (`gain * f(x)` keeps `gain` out of "
            "the table), or make a control a constant",
        )
    places = {c.name: Range(c.name, c.low, c.high, periodic=False) for c in plan.coordinates}
    ranges = tuple(
        places.get(n) or range_of(n, declared, settings.fixed.get(n)) for n in sheet.over
    )
    budget = settings.budget // max(1, len(plan.sheets))
    shares = _column_tolerance(sheet, plan, tolerance) / settings.strictness
    return tabulate_function(Wanted(sheet.sample, ranges, shares, settings.method, budget))


def _column_tolerance(sheet: Sheet, plan: Plan, tolerance: Array) -> Array:
    """What each column may be off, so that all uses of all sheets together stay within."""
    users = np.zeros(len(tolerance))
    for other in plan.sheets:
        for component in {use.component for use in other.uses}:
            users[component] += sum(use.component == component for use in other.uses)
    allowed = np.full(sheet.columns, np.inf)
    for use in sheet.uses:
        largest = use.largest if np.isfinite(use.largest) and use.largest > 0.0 else 1.0
        share = tolerance[use.component] / (users[use.component] * largest)
        allowed[use.column] = min(allowed[use.column], share)
    return allowed

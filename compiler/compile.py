"""The compiler in one screen: text, spec, checks, plan, tables, program.

load            text -> spec with places                          spec_schema.load
declare         units, domains, defaults                          1
read            expressions, names, dimensions                    2
references      names used and unused                             3
lower parts     outputs, fidelity, bindings                       4
plan            what is to be tabulated                           5
lower field     tables with measured error bounds                 6
horizon         table errors, carried to the fidelity horizon     7
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeAlias, final

from compiler.assemble import assembled
from compiler.check_behavior import Checked, check_behavior
from compiler.horizon import excess
from compiler.lower_field import lower_field, measured
from compiler.plan import Plan, UnboundedError, plan_formula, plan_sampled
from compiler.python_module import ModuleError, refuse_module
from compiler.settings import Settings
from compiler.sketch.claims import additions, sketch_claims
from compiler.sketch.design import Design
from compiler.sketch.fill import CANDIDATES, filled
from compiler.sketch.frame import SketchRefusedError
from compiler.sketch.gaps import narrowest_gap
from compiler.sketch.lower import SKETCH, plan_sketch
from compiler.tabulate import TableError
from compiler.terms import TooManyCasesError
from runtime.program import Field, Program
from runtime.progress import Progress
from spec_schema.behavior import BehaviorSpec
from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.field_forms import Form, Formula, Module, Step
from spec_schema.field_modes import Modes
from spec_schema.load import Loaded
from spec_schema.places import Path as KeyPath
from spec_schema.wording import with_article

__all__ = ["Compiled", "Judge", "Progress", "compile_loaded"]

Judge: TypeAlias = Callable[[Program], tuple[str, ...]]

MENDED_BY_CODE = {"S241", "S242", "S245"}  # a formula that is kept as code needs no table
SMOOTHER = (
    "draw smoother: round a polygon's corners more (`rounding: 0.6`), let neighboring edges take "
    "more even times, and features stand further apart; or loosen `table: tolerance`, or raise "
    "`table: budget`"
)
TIGHTENINGS = 3  # how often the tables are made again, finer, for the fidelity horizon


@final
@dataclass(frozen=True, eq=False, slots=True)
class Compiled:
    """A program, and the warnings on the way to it.

    notes: what the compiler chose or added by itself, in sentences.
    """

    program: Program
    warnings: tuple[Diagnostic, ...]
    notes: tuple[str, ...] = ()


def compile_loaded(
    loaded: Loaded, progress: Progress, judge: Judge | None = None, *, allow_code: bool = False
) -> Compiled:
    """Compile a behavior spec that has been read.

    judge: says what a compiled sketch lacks of its claims, or has beside them, in sentences.
    allow_code: whether the Python of a `module` field may be run.

    Raises:
        SpecError: with everything that is wrong with it, or its code may not be run (V336).
    """
    if not isinstance(loaded.spec, BehaviorSpec):
        message = f"this is {with_article(loaded.spec.kind)}; a behavior belongs here"
        raise SpecError([loaded.error("S200", ("kind",), message, "name a behavior spec")])
    checked = check_behavior(loaded, loaded.spec)
    _stop_at_errors(checked)
    if isinstance(loaded.spec.field.form, Module) and not allow_code:
        refuse_module(loaded, loaded.spec.field.form)
    program = assembled(checked)
    if checked.design is not None:
        program = _sketched(checked, checked.design, program, progress, judge)
    elif checked.spec.table.keep == "tables":
        program = _tabulated(checked, program, _plan(checked), progress)
    _stop_at_errors(checked)
    warnings = tuple(d for d in checked.findings.diagnostics if d.severity is Severity.WARNING)
    return Compiled(program, warnings, checked.findings.notes)


def _stop_at_errors(checked: Checked) -> None:
    if checked.findings.has_errors:
        raise SpecError(checked.findings.diagnostics)


def _sketched(
    checked: Checked, design: Design, program: Program, progress: Progress, judge: Judge | None
) -> Program:
    """The program of a sketch, filled in ways that are tried until the judge finds no fault."""
    claims = (*program.claims, *sketch_claims(design, checked.loaded))
    faults: tuple[str, ...] = ()
    for candidate in range(len(CANDIDATES)):
        plan = _plan_sketch(checked, design, candidate)
        made = replace(_tabulated(checked, program, plan, progress), claims=claims)
        _stop_at_errors(checked)
        found = judge(made) if judge is not None else ()
        if not found:
            for sentence in additions(design, checked.declared):
                checked.findings.note(sentence)
            return made
        faults = faults or found
    message = f"the filled field does not look as it was drawn: {faults[0]}"
    remedy = "draw features further apart or with like rates, or add arrows between them"
    checked.findings.error("S268", SKETCH, message, remedy, key=True)
    return program


def _tabulated(checked: Checked, program: Program, plan: Plan, progress: Progress) -> Program:
    """The program with tables that are good enough for its own fidelity tolerance."""
    settings = checked.settings
    for _ in range(TIGHTENINGS):
        field = _with_tables(checked, program, plan, settings, progress)
        made = measured(replace(program, field=field))
        worst = max([*excess(made).values(), *_over_tolerance(made)], default=0.0)
        if worst <= 1.0:
            return made
        settings = replace(settings, strictness=2.0 * worst * settings.strictness)
    checked.findings.error(
        "S247",
        ("fidelity", "horizon"),
        "carried to the horizon, the tables' error is more than "
        f"{10.0 ** math.floor(math.log10(worst)):g} times what it may be: a tenth of the fidelity "
        "tolerance",
        "shorten the horizon, or keep the field as code: `table: {keep: code}`",
        key=True,
    )
    return made


def _over_tolerance(program: Program) -> list[float]:
    """How many times each rate's tolerance its measured error is."""
    return [bound.measured / bound.tolerance for bound in program.field.bounds]


def _with_tables(
    checked: Checked, program: Program, plan: Plan, settings: Settings, progress: Progress
) -> Field:
    field, findings = program.field, checked.findings
    try:
        tables, terms, bounds = lower_field(program, plan, settings, checked.declared, progress)
    except TableError as error:
        message, remedy = error.message, error.remedy
        if field.formula is not None and error.code in MENDED_BY_CODE:
            keep = "keep the formula as code: `table: {keep: code}`"
            # Smaller domains and more budget rarely save a table that is far too fine.
            remedy = f"{keep}; or {remedy}" if error.code == "S241" else f"{remedy}; or {keep}"
        if checked.design is not None:
            remedy, message = SMOOTHER, message + narrowest_gap(checked.design)
        findings.error(error.code, _path_of(error, checked), message, remedy, key=True)
    except ModuleError as error:
        findings.error("S233", ("field", "module", "call"), error.message, error.remedy)
    _stop_at_errors(checked)
    return replace(field, tables=tables, terms=terms, bounds=bounds, coordinates=plan.coordinates)


def _plan(checked: Checked) -> Plan:
    if isinstance(checked.spec.field.form, Formula | Step | Modes):
        return _plan_formula(checked)
    beside = Path(checked.loaded.source.name).resolve().parent
    plan = plan_sampled(checked.spec, checked.declared, beside, checked.findings)
    _stop_at_errors(checked)
    assert plan is not None, "a plan that can't be made leaves an error"
    return plan


def _plan_sketch(checked: Checked, design: Design, candidate: int) -> Plan:
    origin = checked.loaded.origin(SKETCH)
    try:
        return plan_sketch(filled(design, candidate), checked.declared, origin)
    except SketchRefusedError as error:
        checked.findings.error(error.code, error.path, error.message, error.remedy)
    raise SpecError(checked.findings.diagnostics)


def _plan_formula(checked: Checked) -> Plan:
    base, has_keys = _place_of_rates(checked.spec.field.form)
    try:
        return plan_formula(checked.expressions.rates, checked.declared)
    except UnboundedError as error:
        message = f"the factor {error.coefficient} is not finite all over the controls' domains"
        remedy = "shrink the domain of a control so that it leaves the place out"
        checked.findings.error("S243", (*base, error.state) if has_keys else base, message, remedy)
    except TooManyCasesError as error:
        message = f"a term tells {error.combinations} combinations of discrete values apart"
        remedy = "split it into a sum of terms, or keep it as code: `table: {keep: code}`"
        checked.findings.error("S245", base, message, remedy, key=True)
    raise SpecError(checked.findings.diagnostics)


def _place_of_rates(form: Form) -> tuple[tuple[str, ...], bool]:
    """Where the expressions of the rates stand, and whether there is one for each driven state."""
    match form:
        case Formula():
            return ("field", "formula"), True
        case Step():
            return ("field", "step", "next"), True
        case _:
            return ("field", "modes"), False


def _path_of(error: TableError, checked: Checked) -> KeyPath:
    """The declaration of the axis at fault, else the field; of a sketch, itself."""
    if checked.design is not None:
        return SKETCH
    if error.axis is None:
        return ("field",)
    return ("state" if error.axis in checked.spec.state else "control", error.axis)

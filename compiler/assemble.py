"""A behavior that was checked, as a program: complete but for its tables."""

from dataclasses import replace

from compiler.check_behavior import Checked
from compiler.lower_field import formula_codes
from compiler.lower_parts import (
    lower_feasibility,
    lower_guards,
    lower_judge_when,
    lower_outputs,
    lower_realizes,
    lower_states,
    origin_of,
)
from compiler.noise import lower_noise
from runtime.program import Field, Program
from spec_schema.field_forms import Formula, Step
from spec_schema.field_modes import Modes


def assembled(checked: Checked) -> Program:
    """The program, its field as far as it is known before anything is tabulated."""
    return _program(checked, _untabulated(checked))


def _untabulated(checked: Checked) -> Field:
    """The field as far as it is known before anything is tabulated: its form and formula."""
    form = checked.spec.field.form
    name, every = type(form).__name__.lower(), checked.settings.every
    driven = tuple(state.name for state in checked.declared.driven)
    field = Field(driven, name, every, (), (), (), None, checked.loaded.origin(("field",)))
    if isinstance(form, Modes):
        guards = lower_guards(checked.expressions.ways, checked.loaded)
        field = replace(field, mode=form.of, guards=guards)
    if isinstance(form, Formula | Step | Modes):
        return formula_codes(checked.expressions.rates, field)
    return field


def _program(checked: Checked, field: Field) -> Program:
    spec, declared, expressions = checked.spec, checked.declared, checked.expressions
    return Program(
        name=spec.name,
        about=spec.about or "",
        states=lower_states(declared, expressions.closures),
        controls=declared.controls,
        constants=declared.constants,
        outputs=lower_outputs(spec, expressions.outputs, checked.loaded),
        field=field,
        fidelity=checked.fidelity,
        bindings=checked.bindings,
        judge_when=lower_judge_when(expressions),
        realizes=lower_realizes(spec, checked.loaded),
        feasibility=lower_feasibility(spec),
        source=origin_of(checked.loaded),
        claims=checked.claims,
        noise=lower_noise(expressions.noise, checked.loaded),
    )

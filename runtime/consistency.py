"""Whether the parts of a program fit together: what an artifact from a stranger must pass.

A program that passes can be packed and run: every index is in range, every name is known, every
table has the coefficients that its axes ask for. It says nothing about whether the field is right.
"""

import math
from collections.abc import Callable, Iterable, Iterator
from typing import Final

import numpy as np

from runtime.code import Code
from runtime.kernels.tape import MOST_AXES
from runtime.program import Constant, Control, Field, Kind, Program, State
from runtime.table import Axis, Method, Table
from runtime.tape import check_code

MOST_CODE: Final = 2_000_000
"""Characters of all code in a program."""
MOST_VARIABLES: Final = 1000
MOST_TERMS: Final = 10_000
NODES_OF_SPLINE: Final = 4


def faults(program: Program) -> Iterator[str]:
    """Every way in which the program does not fit together, as a sentence."""
    yield from _named(program)
    yield from _sized(program)
    yield from _ranged(program)
    yield from _field(program)
    yield from _claimed(program)
    yield from _restless(program)
    yield from _coded(program)


def _named(program: Program) -> Iterator[str]:
    outputs = tuple(output.name for output in program.outputs)
    coordinates = tuple(coordinate.name for coordinate in program.field.coordinates)
    names = (*program.register, *outputs, *coordinates)
    for name in (program.name, *names):
        if not name.isidentifier():
            yield f"{name!r} is no name"
    for name in _repeated(names):
        yield f"two variables are named '{name}'"
    if program.fidelity:
        known = {*program.register, *outputs}
        fidelity = program.fidelity
        for name in {*fidelity.tolerance, *fidelity.scatter, *fidelity.region} - known:
            yield f"fidelity speaks of '{name}', which does not exist"
    if not program.states:
        yield "the program has no state"


def _sized(program: Program) -> Iterator[str]:
    if len(program.register) > MOST_VARIABLES or len(program.field.terms) > MOST_TERMS:
        yield "the program has too many variables or terms"
    if sum(len(code.text) for _, code, _ in _codes(program)) > MOST_CODE:
        yield f"the program has more than {MOST_CODE} characters of code"


def _ranged(program: Program) -> Iterator[str]:
    variables: tuple[State | Control, ...] = (*program.states, *program.controls)
    for variable in variables:
        discrete = isinstance(variable, State) and variable.kind is Kind.DISCRETE
        if not (variable.low < variable.high or (discrete and variable.low == variable.high)):
            yield f"the domain of '{variable.name}' is empty"
    for state in program.states:
        if (state.kind is Kind.DISCRETE) != bool(state.values):
            yield f"'{state.name}' is not discrete and has values, or is and has none"
    units = [*(part.unit for part in variables), *(output.unit for output in program.outputs)]
    if any(unit.scale == 0.0 for unit in units):
        yield "a unit has the scale 0"


def _field(program: Program) -> Iterator[str]:
    field = program.field
    yield from _modes(program)
    known = {state.name for state in program.states if state.is_driven} - {field.mode}
    if set(field.driven) != known or _repeated(field.driven):
        yield "the field does not drive the driven states"
    if field.every < 0.0:
        yield "the field's step is negative"
    if field.formula is not None and len(field.formula) != len(field.driven):
        yield "the formula lacks a driven state"
    if field.formula is None and not field.terms:
        yield "the field has neither terms nor formula"
    if field.bounds and len(field.bounds) != len(field.driven):
        yield "the error bounds are not those of the driven states"
    for index, table in enumerate(field.tables):
        for fault in _table(program, table):
            yield f"table {index}: {fault}"
    yield from _terms(field)
    yield from _coordinates(program)


def _modes(program: Program) -> Iterator[str]:
    field = program.field
    mode = next((state for state in program.states if state.name == field.mode), None)
    if mode is None:
        if field.mode or field.guards:
            yield "the field has guards or a mode, and no state that names the mode"
        return
    if mode.kind is not Kind.DISCRETE or not mode.is_driven or mode.closure is not None:
        yield f"'{mode.name}' cannot be the mode: it is not discrete and driven"
    if field.is_map:
        yield "a step map has no modes that switch"
    if len(field.guards) > MOST_TERMS:
        yield "the field has too many guards"
    others = {state.name for state in program.states} - {mode.name}
    for number, guard in enumerate(field.guards):
        if {guard.mode, guard.target} - set(range(len(mode.values))):
            yield f"guard {number} leaves or enters a mode that '{mode.name}' does not have"
        names = [name for name, _ in guard.resets]
        if _repeated(names) or set(names) - others:
            yield f"guard {number} resets what is no state, or twice"


def _coordinates(program: Program) -> Iterator[str]:
    states = {state.name for state in program.states}
    if len(program.field.coordinates) > MOST_VARIABLES:
        yield "the field has too many coordinates"
    for coordinate in program.field.coordinates:
        read = states & set(coordinate.code.tokens)
        if len(read) != 1:
            yield f"the coordinate '{coordinate.name}' reads {len(read)} states, not one"
        if not coordinate.low < coordinate.high:
            yield f"the coordinate '{coordinate.name}' has no values"


def _terms(field: Field) -> Iterator[str]:
    for term in field.terms:
        if not 0 <= term.component < len(field.driven) or not -1 <= term.table < len(field.tables):
            yield "a term belongs to no driven state or no table"
        elif term.table >= 0:
            columns = field.tables[term.table].coefficients.shape[-1:]
            if not 0 <= term.column < sum(columns):
                yield f"a term reads column {term.column}, which its table lacks"


def _claimed(program: Program) -> Iterator[str]:
    states = {state.name for state in program.states}
    controls = {control.name for control in program.controls}
    if len(program.claims) > MOST_TERMS:
        yield "there are too many claims"
    for number, claim in enumerate(program.claims):
        places = {place.state for place in claim.places}
        if (places | {reach.state for reach in claim.reaches}) - states:
            yield f"claim {number} speaks of a place in what is no state"
        spans = [span.control for span in claim.over]
        settings = [name for name, _ in claim.settings]
        if {*spans, *settings} - controls or _repeated([*spans, *settings]):
            yield f"claim {number} sets what is no control, or twice"
        if any(not span.low <= span.high for span in claim.over):
            yield f"claim {number} is made over no value of a control"
        if claim.least < 0 or (claim.most is not None and claim.most < claim.least):
            yield f"claim {number} counts to less than it begins with"
        if claim.share is not None and not 0.0 <= claim.share <= 1.0:
            yield f"claim {number} speaks of a share that is none"


def _restless(program: Program) -> Iterator[str]:
    names = [noise.state for noise in program.noise]
    if _repeated(names) or set(names) - set(program.field.driven):
        yield "there is noise of what the field does not drive, or twice"


def _table(program: Program, table: Table) -> Iterator[str]:
    names = tuple(axis.name for axis in table.axes)
    known = {*program.register, *(coordinate.name for coordinate in program.field.coordinates)}
    if not 1 <= len(names) <= MOST_AXES or _repeated(names) or set(names) - known:
        yield f"its axes are not 1 to {MOST_AXES} variables"
    least = NODES_OF_SPLINE if table.method is Method.CUBIC else 2
    for axis in table.axes:
        if not (axis.low < axis.high and math.isfinite(axis.high - axis.low)):
            yield f"the axis '{axis.name}' is empty"
        if axis.count < least:
            yield f"the axis '{axis.name}' has {axis.count} nodes, less than {least}"
    expected = tuple(_count(axis, table.method) for axis in table.axes)
    if table.coefficients.shape[:-1] != expected or table.coefficients.shape[-1:] in {(), (0,)}:
        yield f"its coefficients are {table.coefficients.shape}, not {expected} times columns"
    elif not np.isfinite(table.coefficients).all():
        yield "it has coefficients that are not finite"


def _count(axis: Axis, method: Method) -> int:
    more = 0 if method is Method.LINEAR else 2
    return axis.count + more + axis.periodic


def _coded(program: Program) -> Iterator[str]:
    for what, code, names in _codes(program):
        try:
            check_code(code, names)
        except ValueError as problem:
            yield f"{what}: {problem}"


def _codes(program: Program) -> Iterator[tuple[str, Code, tuple[str, ...]]]:
    """Every piece of code, what it is for, and the names that it may read."""
    register = program.register
    parts: tuple[State | Control | Constant, ...]
    parts = (*program.states, *program.controls, *program.constants)
    given = tuple(
        part.name for part in parts if not isinstance(part, State) or part.kind is Kind.DISCRETE
    )
    for state in program.states:
        if state.closure is not None:
            yield f"closure of '{state.name}'", state.closure, register
    for output in program.outputs:
        yield f"output '{output.name}'", output.code, register
    for name, code in zip(program.field.driven, program.field.formula or (), strict=False):
        yield f"formula of '{name}'", code, register
    for term in program.field.terms:
        yield "coefficient of a term", term.coefficient, given
    for coordinate in program.field.coordinates:
        yield f"coordinate '{coordinate.name}'", coordinate.code, register
    for number, guard in enumerate(program.field.guards):
        yield f"condition of guard {number}", guard.condition, register
        for name, code in guard.resets:
            yield f"reset of '{name}' by guard {number}", code, register
    yield from _codes_of_claims(program)
    yield from ((f"noise of '{noise.state}'", noise.size, register) for noise in program.noise)
    if program.judge_when is not None:
        signals = tuple(binding.name for binding in program.bindings)
        yield "judge_when", program.judge_when, (*register, *signals)


def _codes_of_claims(program: Program) -> Iterator[tuple[str, Code, tuple[str, ...]]]:
    fixed = program.register[len(program.states) :]
    for number, claim in enumerate(program.claims):
        codes = [place.at for place in claim.places]
        codes += [code for reach in claim.reaches for code in (reach.low, reach.high)]
        for code in [*codes, *([claim.period] if claim.period else [])]:
            yield f"claim {number}", code, fixed


def _repeated(names: Iterable[str]) -> list[str]:
    seen: set[str] = set()
    add: Callable[[str], None] = seen.add
    return sorted({name for name in names if name in seen or add(name)})  # type: ignore[func-returns-value]  # add() gives None, so the name is kept only when it was there

"""A program as stable text: for reviews, golden files, and debugging by eye."""

from collections.abc import Iterator

from runtime.program import Field, Kind, Program, State
from runtime.table import Axis, Table


def dump(program: Program, notes: tuple[str, ...] = ()) -> str:
    """The program, line by line; sorted where order has no meaning, numbers in SI.

    notes: what the compiler says of it beside (`Compiled.notes`), at the end.
    """
    lines = (*_lines(program), *(f"  {note}" for note in notes))
    return "\n".join(lines) + "\n"


def _lines(program: Program) -> Iterator[str]:
    counts = f"{_count(program.states, 'state')}, {_count(program.controls, 'control')}"
    yield f"program {program.name}  ({counts}, {_count(program.field.tables, 'table')})"
    yield f"  spec {program.source.file} sha256 {program.source.sha256[:16]}"
    for state in program.states:
        yield _state(state)
    for control in program.controls:
        limits = f"[{control.low!r}, {control.high!r}]"
        yield _line(
            "control", control.name, f"{limits} default {control.default!r}", control.origin
        )
    for constant in program.constants:
        yield _line("constant", constant.name, repr(constant.value), constant.origin)
    for output in program.outputs:
        yield _line("output", output.name, f"= {output.code.text}", output.origin)
    yield from _field(program.field)
    for noise in program.noise:
        yield _line("noise", noise.state, f"= {noise.size.text}", noise.origin)
    yield from _verification(program)


def _count(parts: tuple[object, ...], noun: str) -> str:
    return f"{len(parts)} {noun}" + ("" if len(parts) == 1 else "s")


def _line(what: str, name: str, rest: str, origin: str) -> str:
    return f"  {what} {name}  {rest}  {origin}"


def _state(state: State) -> str:
    if state.kind is Kind.DISCRETE:
        return _line(
            "state", state.name, f"{state.role} one of {', '.join(state.values)}", state.origin
        )
    kind = "" if state.kind is Kind.CONTINUOUS else f" {state.kind}"
    closure = f" closure {state.closure.text}" if state.closure else ""
    rest = f"{state.role}{kind} [{state.low!r}, {state.high!r}]{closure}"
    return _line("state", state.name, rest, state.origin)


def _field(field: Field) -> Iterator[str]:
    kind = f"map every {field.every!r} s" if field.is_map else "rates"
    yield _line("field", field.form, f"{kind} of {', '.join(field.driven)}", field.origin)
    for coordinate in field.coordinates:
        limits = f"[{coordinate.low!r}, {coordinate.high!r}]"
        yield f"    coordinate {coordinate.name}  = {coordinate.code.text}  {limits}"
    for i, table in enumerate(field.tables):
        yield f"    table {i}  {_table(table)}"
    for term in field.terms:
        part = "1" if term.table < 0 else f"table {term.table} column {term.column}"
        yield f"    {field.driven[term.component]} += {term.coefficient.text} * {part}"
    for name, bound in zip(field.driven, field.bounds, strict=False):
        within = f"{bound.measured:.3e} of {bound.tolerance:.3e} allowed"
        yield f"    error {name}  {within}, measured on {bound.points} points"
    for name, code in zip(field.driven, field.formula or (), strict=False):
        yield f"    formula {name}  {code.text}"
    for guard in field.guards:
        resets = "".join(f" {name} := {code.text}" for name, code in guard.resets)
        ways = f"{guard.mode} -> {guard.target}"
        yield f"    {field.mode} {ways}  when {guard.condition.text} >= 0{resets}  {guard.origin}"


def _table(table: Table) -> str:
    axes = " x ".join(_axis(axis) for axis in table.axes)
    return f"{table.method} {axes} -> {table.coefficients.shape[-1]}"


def _axis(axis: Axis) -> str:
    return f"{axis.name}[{axis.count}]" + (" periodic" if axis.periodic else "")


def _verification(program: Program) -> Iterator[str]:
    if program.fidelity is not None:
        tolerance = ", ".join(f"{n} {v!r}" for n, v in sorted(program.fidelity.tolerance.items()))
        scatter = ", ".join(f"{n} {v!r}" for n, v in sorted(program.fidelity.scatter.items()))
        tolerance += f" scatter {scatter}" if scatter else ""
        rest = f"horizon {program.fidelity.horizon!r} s coverage {program.fidelity.coverage!r}"
        yield _line("fidelity", tolerance, rest, program.fidelity.origin)
    for binding in program.bindings:
        source = binding.path if binding.constant is None else repr(binding.constant)
        details = f" delay {binding.delay!r}" if binding.delay else ""
        details += f" scale {binding.scale!r}" if binding.scale != 1.0 else ""
        details += f" offset {binding.offset!r}" if binding.offset else ""
        details += f" noise {binding.noise!r}" if binding.noise is not None else ""
        yield _line(
            "trace", binding.name, f"{source} [{binding.unit.text}]{details}", binding.origin
        )
    if program.judge_when is not None:
        yield f"  judge when  {program.judge_when.text}"
    for realization in program.realizes:
        sign = "-" if realization.sign < 0.0 else ""
        rest = f"{sign}{realization.channel} as {realization.mode}"
        yield _line("realizes", realization.variable, rest, realization.origin)

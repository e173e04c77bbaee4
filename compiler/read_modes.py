"""Modes: a field for each value of a discrete state, and the ways that lead from one to another."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import final

from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.guard_sign import signed
from compiler.read_rates import read_rates, refuse_unsensed
from compiler.scope import Scope, checked
from runtime.program import Kind, Role
from spec_schema.behavior import BehaviorSpec
from spec_schema.expressions.rewrite import names_in
from spec_schema.expressions.tree import Apply, Expr, Name, Number
from spec_schema.field_modes import Leave, Modes
from spec_schema.places import Path
from spec_schema.suggest import did_you_mean

BASE: Path = ("field", "modes")


@final
@dataclass(frozen=True, slots=True)
class Way:
    """A way out of a mode. condition: zero or more where it is open; path: where it stands."""

    mode: int
    target: int
    condition: Expr
    resets: Mapping[str, Expr]
    path: Path

    @property
    def reads(self) -> frozenset[str]:
        """Every name that its condition and its resets read."""
        return names_in(self.condition).union(*map(names_in, self.resets.values()))


def check_moved_values(spec: BehaviorSpec, findings: Findings) -> None:
    """A finding for each discrete state that is to be driven although no modes drive it."""
    form = spec.field.form
    discrete = {name for name, state in spec.state.items() if state.kind == "discrete"}
    mode = form.of if isinstance(form, Modes) else ""
    if mode and mode not in discrete:
        return  # told already, and a consequence here
    for name in sorted(discrete - {mode}):
        state = spec.state[name]
        if state.role != "sensed":
            message = (
                f"a discrete variable is only sensed, unless it is the one that `modes` change; "
                f"this one's role is '{state.role}'"
            )
            remedy = "write 'role: sensed'"
            if not mode:
                remedy += ", or give a field to each of its values under `field: {modes: ...}`"
            findings.error("S251", ("state", name, "role"), message, remedy)


def read_modes(
    form: Modes, declared: Declarations, scope: Scope, findings: Findings
) -> tuple[dict[str, Expr], tuple[Way, ...]]:
    """The rates, told apart by the mode, and every way; findings for what can't be read."""
    modes = _modes(form, declared, findings)
    _match_modes(form, modes, findings)
    known = {name: mode for name, mode in form.each.items() if name in modes}
    rates = {
        name: read_rates(mode.formula, (*BASE, "each", name, "formula"), declared, scope, findings)
        for name, mode in known.items()
    }
    ways = tuple(
        way
        for name in modes
        if name in known
        for i, leave in enumerate(known[name].leave)
        for way in _way(
            leave, name, modes, (*BASE, "each", name, "leave", i), declared, scope, findings
        )
    )
    by_mode = [rates.get(name, {}) for name in modes]
    return {s.name: _told_apart(form.of, s.name, by_mode) for s in declared.driven}, ways


def _modes(form: Modes, declared: Declarations, findings: Findings) -> tuple[str, ...]:
    """The names of the modes, in the order of the values of the state that they are of."""
    path: Path = (*BASE, "of")
    discrete = {state.name: state for state in declared.states if state.kind is Kind.DISCRETE}
    if form.of not in discrete:
        known = {state.name for state in declared.states}
        what = "is not discrete" if form.of in known else "is no state"
        remedy = did_you_mean(form.of, sorted(discrete)) or (
            f"declare it: `{form.of}: {{kind: discrete, values: [{', '.join(form.each)}], "
            "role: both, relates: ...}`"
        )
        findings.error("S252", path, f"'{form.of}' {what}, so it has no modes", remedy)
        return tuple(form.each)
    state = discrete[form.of]
    if state.role is not Role.BOTH:
        message = f"modes sense and drive '{form.of}', and its role is '{state.role}'"
        findings.error("S252", path, message, f"write `role: both` for '{form.of}'")
    return state.values


def _match_modes(form: Modes, modes: tuple[str, ...], findings: Findings) -> None:
    for name in form.each:
        if name not in modes:
            message = f"'{form.of}' has no value '{name}', so it can't be a mode"
            remedy = did_you_mean(name, list(modes)) or f"its values: {', '.join(modes)}"
            findings.error("S253", (*BASE, "each", name), message, remedy, key=True)
    each: Path = (*BASE, "each")
    told = {name for name in modes if findings.written((*each, name)) == (*each, name)}
    missing = [name for name in modes if name not in form.each and name not in told]
    if missing:
        message = f"the mode '{missing[0]}' has no field"
        remedy = f"add `{missing[0]}: {{formula: {{...}}}}`"
        findings.error("S253", (*BASE, "each"), message, remedy, key=True)


def _told_apart(mode: str, state: str, by_mode: list[dict[str, Expr]]) -> Expr:
    """The rate of a state: that of the first mode where it is the first, and so on."""
    found = by_mode[-1].get(state, Number(0.0))
    for i in reversed(range(len(by_mode) - 1)):
        rate = by_mode[i].get(state, Number(0.0))
        if rate != found:
            test = Apply("eq", (Name(mode), Number(float(i))))
            found = Apply("where", (test, rate, found))
    return found


def _way(
    leave: Leave,
    name: str,
    modes: tuple[str, ...],
    path: Path,
    declared: Declarations,
    scope: Scope,
    findings: Findings,
) -> Iterator[Way]:
    """The way that `leave` describes, where it can be read."""
    known = leave.to in modes
    if not known:
        remedy = did_you_mean(leave.to, list(modes)) or f"the modes: {', '.join(modes)}"
        findings.error("S253", (*path, "to"), f"no mode is named '{leave.to}'", remedy)
    if leave.to == name and not leave.reset:
        message = f"this way leads from '{name}' to '{name}' and resets nothing: it stays open"
        findings.error("S256", (*path, "to"), message, "name another mode, or add a `reset`")
    condition = _condition(leave.when, (*path, "when"), declared, scope, findings)
    resets = dict(_resets(leave.reset, (*path, "reset"), declared, scope, findings))
    if known and condition is not None:
        yield Way(modes.index(name), modes.index(leave.to), condition, resets, path)


def _condition(
    text: str, path: Path, declared: Declarations, scope: Scope, findings: Findings
) -> Expr | None:
    expr = checked(text, path, scope, None, "a condition", findings)
    if expr is None:
        return None
    refuse_unsensed(expr, path, declared, findings)
    found = signed(expr, declared.values)
    if found is None:
        message = "where this way opens can't be told: it is not made of comparisons"
        remedy = "compare two quantities: `x >= x1`; join comparisons by `and`, `or`, `not`"
        if isinstance(expr, Apply) and expr.op in {"eq", "ne"}:
            message = "two numbers are hardly ever equal, so this way has no side to open from"
            remedy = "write `>=` or `<=`"
        findings.error("S254", path, message, remedy)
    return found


def _resets(
    given: Mapping[str, str],
    path: Path,
    declared: Declarations,
    scope: Scope,
    findings: Findings,
) -> Iterator[tuple[str, Expr]]:
    driven = [state.name for state in declared.driven]
    for name, text in given.items():
        if name not in driven:
            known = name in declared.values
            message = f"'{name}' is no state that jumps here"
            remedy = did_you_mean(name, driven) or f"the driven states: {', '.join(driven)}"
            if known:
                remedy = "the mode itself is set by `to`"
            findings.error("S255", (*path, name), message, remedy, key=True)
            continue
        what = f"the new value of '{name}'"
        expr = checked(text, (*path, name), scope, declared.units.get(name), what, findings)
        if expr is not None:
            refuse_unsensed(expr, (*path, name), declared, findings)
            yield name, expr

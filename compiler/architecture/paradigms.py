"""How an arbiter decides: rules, layers, weights, competition, plans and modules, in code."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import final

from compiler.architecture.choices import check_choice
from compiler.architecture.learned import learned_in, learned_rules
from compiler.architecture.leaving import check_leaving
from compiler.architecture.library import Library
from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.lower_parts import code_of
from compiler.quantities import ONE, SECOND, si_value
from compiler.scope import checked, scope_of
from compiler.world.shapes import positive
from runtime.arbiter import Competition, Paradigm, Rule
from runtime.code import Code
from runtime.program import Program, Role
from spec_schema.arbiter import ArbiterSpec, CompetitionSpec, RuleSpec
from spec_schema.expressions.bounds import bounds
from spec_schema.expressions.tree import Expr
from spec_schema.load import Loaded
from spec_schema.places import Path
from spec_schema.suggest import did_you_mean, there_are
from spec_schema.units import parse_unit

ZERO = Code("0.0")


@final
@dataclass(frozen=True, eq=False, slots=True)
class Decided:
    """A way of deciding; of the parts, the paradigm's own is filled.

    choices: of a plan in the order of its modes, else as the arbiter lists them. learner: by what
    its rules are learned; empty where their author wrote them.
    """

    paradigm: Paradigm
    choices: tuple[str, ...]
    rules: tuple[Rule, ...] = ()
    weights: tuple[Code, ...] = ()
    competition: Competition | None = None
    plan: Program | None = None
    learner: str = ""


def decided(
    spec: ArbiterSpec,
    declared: Declarations,
    loaded: Loaded,
    library: Library,
    findings: Findings,
) -> Decided:
    """The paradigm of an arbiter, with a finding for each mistake in it."""
    by, choices = spec.by, spec.choices
    for key, given in (("rules", by.rules), ("subsumption", by.subsumption)):
        if given is not None:
            rules = _rules(given, key, spec, declared, loaded, findings)
            return Decided(Paradigm(key), choices, rules=rules)
    if by.weights is not None:
        _check_each(by.weights, choices, ("by", "weights"), "weight", findings)
        weights = _numbers(by.weights, choices, ("by", "weights"), declared, findings)
        return Decided(Paradigm.WEIGHTS, choices, weights=weights)
    if by.competition is not None:
        competition = _competition(by.competition, choices, declared, findings)
        return Decided(Paradigm.COMPETITION, choices, competition=competition)
    if by.plan is not None:
        plan, order = _plan(by.plan, spec, declared, loaded, library, findings)
        return Decided(Paradigm.PLAN, order, plan=plan)
    learned = learned_in(by)
    if learned is not None:
        rules = learned_rules(*learned, spec, declared, loaded, findings)
        return Decided(Paradigm.RULES, choices, rules=rules, learner=learned[0])
    return Decided(Paradigm.MODULE, choices)


def _rules(
    rules: tuple[RuleSpec, ...],
    key: str,
    spec: ArbiterSpec,
    declared: Declarations,
    loaded: Loaded,
    findings: Findings,
) -> tuple[Rule, ...]:
    base: Path = ("by", key)
    found = tuple(
        _rule(rule, (*base, i), spec, declared, loaded, findings) for i, rule in enumerate(rules)
    )
    chosen = {rule.choose for rule in rules}
    for i, choice in enumerate(spec.choices):
        if choice not in chosen:
            message = f"no rule chooses '{choice}'"
            findings.warning("S329", ("choices", i), message, "add a rule, or remove the choice")
    always = next((i for i, rule in enumerate(rules) if rule.when is None), len(rules))
    if key == "rules" and always + 1 < len(rules):
        message = "this rule is never reached: the one before it always holds"
        findings.warning("S329", (*base, always + 1), message, "put the rule without `when` last")
    return found


def _rule(
    rule: RuleSpec,
    path: Path,
    spec: ArbiterSpec,
    declared: Declarations,
    loaded: Loaded,
    findings: Findings,
) -> Rule:
    check_choice(rule.choose, spec.choices, (*path, "choose"), findings)
    lasts = si_value(rule.lasts, SECOND, (*path, "lasts"), findings) or 0.0
    if lasts < 0.0:
        message = f"a rule can't last less than no time (got {rule.lasts})"
        findings.error("S212", (*path, "lasts"), message, "write 'lasts: 0.5 s'")
    choice = spec.choices.index(rule.choose) if rule.choose in spec.choices else 0
    when = _condition(rule.when, (*path, "when"), declared, findings)
    until = _condition(rule.until, (*path, "until"), declared, findings)
    if when is not None and until is not None and lasts == 0.0:
        check_leaving(when, until, path, declared, findings)
    codes = [None if expr is None else code_of(expr) for expr in (when, until)]
    return Rule(choice, codes[0], codes[1], max(lasts, 0.0), loaded.origin(path))


def _condition(
    text: str | None, path: Path, declared: Declarations, findings: Findings
) -> Expr | None:
    if text is None:
        return None
    return checked(text, path, scope_of(declared), ONE, "the condition", findings)


def _check_each(
    given: Mapping[str, str], choices: tuple[str, ...], path: Path, what: str, findings: Findings
) -> None:
    """A finding for each choice without an expression, and for each expression of no choice."""
    for name in given:
        check_choice(name, choices, (*path, name), findings, key=True)
    for name in choices:
        if name not in given:
            message = f"the choice '{name}' has no {what}"
            findings.error("S323", path, message, f"add '{name}: ...'", key=True)


def _numbers(
    given: Mapping[str, str],
    choices: Iterable[str],
    path: Path,
    declared: Declarations,
    findings: Findings,
    limits: tuple[float, float] = (0.0, float("inf")),
) -> tuple[Code, ...]:
    """The codes of plain numbers within limits, one per choice; 0 where there is none."""
    found = dict.fromkeys(choices, ZERO)
    for name, text in given.items():
        at = (*path, name)
        expr = checked(text, at, scope_of(declared), ONE, "the expression", findings)
        if expr is not None and name in found:
            found[name] = code_of(expr)
            _check_range(expr, at, declared, findings, limits)
    return tuple(found.values())


def _check_range(
    expr: Expr,
    path: Path,
    declared: Declarations,
    findings: Findings,
    limits: tuple[float, float],
) -> None:
    box = {one.name: (one.low, one.high) for one in declared.variables}
    box |= {one.name: (one.value, one.value) for one in declared.constants}
    low, high = bounds(expr, box)
    if low < limits[0] - 1e-9 or high > limits[1] + 1e-9:
        wanted = "0 or more" if limits[0] == 0.0 else "from -1 to 1"
        message = f"this should be {wanted}, and may be from {low:g} to {high:g}"
        remedy = f"write clip(..., {limits[0]:g}, {min(limits[1], 1.0):g})"
        findings.warning("S329", path, message, remedy)


def _competition(
    spec: CompetitionSpec, choices: tuple[str, ...], declared: Declarations, findings: Findings
) -> Competition:
    base: Path = ("by", "competition")
    _check_each(spec.advantage, choices, (*base, "advantage"), "advantage", findings)
    advantage = _numbers(
        spec.advantage, choices, (*base, "advantage"), declared, findings, (-1.0, 1.0)
    )
    rows = []
    for name in spec.suppresses:
        check_choice(name, choices, (*base, "suppresses", name), findings, key=True)
    for name in choices:
        row = spec.suppresses.get(name, {})
        path = (*base, "suppresses", name)
        for other in row:
            if other not in choices or other == name:
                known = [choice for choice in choices if choice != name]
                remedy = did_you_mean(other, known) or there_are(known)
                message = f"'{name}' can't suppress '{other}'"
                findings.error("S323", (*path, other), message, remedy, key=True)
        rows.append(_numbers(row, choices, path, declared, findings))
    time = positive(spec.time, "s", "the time scale", (*base, "time"), findings)
    return Competition(advantage, tuple(rows), time, spec.noise)


def _plan(
    text: str,
    spec: ArbiterSpec,
    declared: Declarations,
    loaded: Loaded,
    library: Library,
    findings: Findings,
) -> tuple[Program | None, tuple[str, ...]]:
    path: Path = ("by", "plan")
    found = library.behavior(loaded, path, text, findings)
    if found is None:
        return None, spec.choices
    program = found.program
    mode = next((s for s in program.states if s.name == program.field.mode), None)
    if mode is None:
        message = f"'{program.name}' has no modes, and a plan's modes are the choices"
        findings.error("S324", path, message, "give it modes: `field: {modes: ...}`")
        return None, spec.choices
    if set(mode.values) != set(spec.choices):
        odd = sorted(set(mode.values) ^ set(spec.choices))
        message = f"the plan's modes are not the choices: {', '.join(odd)}"
        findings.error("S324", path, message, f"write 'choices: [{', '.join(mode.values)}]'")
        return None, spec.choices
    _check_plan_reads(program, declared, path, findings)
    return program, mode.values


def _check_plan_reads(
    program: Program, declared: Declarations, path: Path, findings: Findings
) -> None:
    """A finding for each sensed state of a plan that the arbiter reads not, or otherwise."""
    known = {variable.name: variable for variable in declared.variables}
    for state in program.states:
        if state.role is Role.DRIVEN or state.name == program.field.mode:
            continue
        own = known.get(state.name)
        if own is None:
            message = f"the plan senses '{state.name}', and the arbiter does not read it"
            findings.error("S324", path, message, f"declare '{state.name}' under `reads`")
        elif parse_unit(own.unit.text).dimension != parse_unit(state.unit.text).dimension:
            message = (
                f"'{state.name}' is in {state.unit.text} for the plan, here in {own.unit.text}"
            )
            findings.error("S324", path, message, "declare it in the same kind of unit")
        elif own.low < state.low or own.high > state.high:
            message = f"the arbiter reads '{state.name}' beyond what the plan knows"
            findings.error("S324", path, message, "give both the same domain")

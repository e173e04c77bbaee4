"""Learned arbiters: boxes of what is read, the first that holds, and what is chosen otherwise."""

from compiler.architecture.boxes import Limit, boxes_of, is_covered
from compiler.architecture.choices import check_choice
from compiler.architecture.learned_conditions import read_condition
from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.lower_parts import code_of
from runtime.arbiter import Rule
from runtime.program import Kind, State
from spec_schema.arbiter import ArbiterSpec, BySpec, LearnedRuleSpec, LearnedSpec
from spec_schema.dimension import describe
from spec_schema.expressions.tree import Expr
from spec_schema.load import Loaded
from spec_schema.places import Path
from spec_schema.units import Unit


def learned_in(by: BySpec) -> tuple[str, LearnedSpec] | None:
    """The learner of an arbiter, and what it learned; None of one that does not learn."""
    given = (("alcsr", by.alcsr), ("xcsr", by.xcsr))
    return next(((key, learned) for key, learned in given if learned is not None), None)


def learned_rules(
    learner: str,
    learned: LearnedSpec,
    spec: ArbiterSpec,
    declared: Declarations,
    loaded: Loaded,
    findings: Findings,
) -> tuple[Rule, ...]:
    """Its rules, and a last one that always holds, with a finding for each mistake."""
    base: Path = ("by", learner)
    otherwise = spec.choices[0] if learned.otherwise is None else learned.otherwise
    at = base if learned.otherwise is None else (*base, "otherwise")
    check_choice(otherwise, spec.choices, at, findings)
    rules, conditions = [], []
    for i, rule in enumerate(learned.rules):
        path = (*base, "rules", i)
        check_choice(rule.choose, spec.choices, (*path, "choose"), findings)
        expr, limits = _condition(rule, path, declared, findings)
        rules.append(_rule(rule, expr, spec.choices, loaded.origin(path)))
        conditions.append(limits)
    last = Rule(_place(otherwise, spec.choices), None, None, 0.0, loaded.origin(at))
    if not learned.rules:
        message = f"it has learned nothing yet: it always chooses '{otherwise}'"
        remedy = "run `specc train` with a scenario that trains it"
        findings.warning("S390", base, message, remedy, key=True)
    elif not findings.has_errors:
        _warn_of_unreached(conditions, (*base, "rules"), declared, findings)
        _warn_of_unchosen(learned, otherwise, spec.choices, findings)
    return (*rules, last)


def _rule(rule: LearnedRuleSpec, expr: Expr | None, choices: tuple[str, ...], origin: str) -> Rule:
    when = None if expr is None else code_of(expr)
    choice = _place(rule.choose, choices)
    return Rule(choice, when, None, 0.0, origin, rule.right, rule.wrong)


def _place(choice: str, choices: tuple[str, ...]) -> int:
    return choices.index(choice) if choice in choices else 0


def _condition(
    rule: LearnedRuleSpec, path: Path, declared: Declarations, findings: Findings
) -> tuple[Expr | None, list[Limit]]:
    """The condition of a rule, and its limits; None and none where it always holds."""
    if rule.when is None:
        return None, []
    at = (*path, "when")
    expr, limits = read_condition(rule.when, at, declared, findings)
    for limit in limits:
        if _is_beyond(limit, declared):
            _warn_of_beyond(limit, at, declared, findings)
    return expr, limits


def _state(limit: Limit, declared: Declarations) -> State:
    return next(state for state in declared.states if state.name == limit.read)


def _is_beyond(limit: Limit, declared: Declarations) -> bool:
    """Whether a limit lies outside what is read, and so decides nothing."""
    state = _state(limit, declared)
    return state.kind is not Kind.DISCRETE and not state.low <= limit.value <= state.high


def _warn_of_beyond(limit: Limit, at: Path, declared: Declarations, findings: Findings) -> None:
    state = _state(limit, declared)
    in_unit = _in_si(declared.units.get(limit.read))
    holds = "always" if (limit.value > state.high) == (limit.op in {"lt", "le"}) else "never"
    span = f"{state.low:.4g}{in_unit} to {state.high:.4g}{in_unit}"
    message = f"'{limit}' {holds} holds: {limit.read} is from {span}"
    remedy = f"write a number in SI, here in{in_unit}" if in_unit else "write a number between them"
    findings.warning("S329", at, message, remedy)


def _in_si(unit: Unit | None) -> str:
    """The SI unit like this one, behind a space; nothing of plain numbers."""
    if unit is None:
        return ""
    radians = unit.text.replace("deg", "rad")
    si = radians if radians != unit.text else describe(unit.dimension)
    return "" if si == "1" else f" {si}"


def _warn_of_unreached(
    conditions: list[list[Limit]], base: Path, declared: Declarations, findings: Findings
) -> None:
    """A warning for each rule that never holds, or only where an earlier one does."""
    boxes = boxes_of(conditions, declared.states)
    for i, box in enumerate(boxes):
        if 0 in box:
            if not any(_is_beyond(limit, declared) for limit in conditions[i]):
                name = declared.states[box.index(0)].name
                message = f"this rule never holds: it asks of '{name}' what can't hold at once"
                findings.warning("S329", (*base, i, "when"), message, "remove the rule")
        elif is_covered(box, boxes[:i]):
            message = "this rule is never reached: wherever it holds, an earlier one does"
            findings.warning("S329", (*base, i), message, "remove it, or put it earlier")


def _warn_of_unchosen(
    learned: LearnedSpec, otherwise: str, choices: tuple[str, ...], findings: Findings
) -> None:
    chosen = {otherwise, *(rule.choose for rule in learned.rules)}
    for i, choice in enumerate(choices):
        if choice not in chosen:
            message = f"no rule that was learned chooses '{choice}'"
            remedy = "train it again or for longer, or remove the choice"
            findings.warning("S329", ("choices", i), message, remedy)

"""Conditions of learned rules: comparisons of single reads with numbers in SI, joined by `and`.

The numbers have no units, and need none: nobody writes them by hand. So dimensions are not checked.
"""

from collections.abc import Iterator

from compiler.architecture.boxes import Limit
from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.guard_sign import OPPOSITE
from compiler.plain_numbers import parsed
from runtime.program import Kind, State
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.printers.text import to_text
from spec_schema.expressions.rewrite import names_in, resolve_texts, unknown_names
from spec_schema.expressions.tree import COMPARISONS, Apply, Expr, Name
from spec_schema.faults import Fault
from spec_schema.places import Path
from spec_schema.wording import number

TURNED = {"lt": "gt", "le": "ge", "gt": "lt", "ge": "le", "eq": "eq", "ne": "ne"}
"""What a comparison becomes where its sides change places."""
ONE_READ = "a learned rule compares one read with a number"


def read_condition(
    text: str, path: Path, declared: Declarations, findings: Findings
) -> tuple[Expr | None, list[Limit]]:
    """The condition and its limits, all of which must hold; None, and findings, of a bad one."""
    tree = parsed(text, path, findings)
    if tree is None:
        return None, []
    expr, faults = resolve_texts(tree, declared.values)
    limits: list[Limit] = []
    for part in _joined(expr):
        unknown = unknown_names(part, declared.register)
        found = None if unknown else _limit(part, declared)
        if isinstance(found, Limit):
            limits.append(found)
        faults += [*unknown, *([found] if isinstance(found, Fault) else [])]
    for fault in faults:
        findings.fault(path, fault)
    return (None, []) if faults else (expr, limits)


def _joined(expr: Expr) -> Iterator[Expr]:
    """What `and` joins, from left to right."""
    waiting = [expr]
    while waiting:
        part = waiting.pop()
        if isinstance(part, Apply) and part.op == "and":
            waiting.extend(reversed(part.operands))
        else:
            yield part


def _limit(part: Expr, declared: Declarations) -> Limit | Fault:
    """A comparison of a read with a number, or why it is none."""
    if not isinstance(part, Apply) or part.op not in COMPARISONS:
        return _no_comparison(part, declared)
    left, right = part.operands
    op = part.op
    if not isinstance(left, Name):
        left, right, op = right, left, TURNED[op]
    states = {state.name: state for state in declared.states}
    others = (names_in(left) | names_in(right)) - states.keys()
    if others:
        return _of_no_read(part, min(others), declared)
    if not isinstance(left, Name) or names_in(right):
        return _refused(part, ONE_READ, _example(declared))
    found = Limit(left.name, op, evaluate(right, {}), part.start, part.end)
    return _comparable(found, states[left.name], part)


def _comparable(limit: Limit, state: State, part: Apply) -> Limit | Fault:
    """The limit, where it is one of a box."""
    equality = limit.op in {"eq", "ne"}
    if state.kind is Kind.DISCRETE:
        message = f"'{state.name}' is one of {', '.join(state.values)}: none is more than another"
        return limit if equality else _refused(part, message, _example_of(state))
    if equality:
        value = number(limit.value)
        remedy = f"write `{state.name} < {value}` or `{state.name} > {value}`"
        return _refused(part, "two numbers are hardly ever equal", remedy)
    return limit


def _of_no_read(part: Expr, name: str, declared: Declarations) -> Fault:
    """A control or a constant stands in a condition."""
    constant = next((one for one in declared.constants if one.name == name), None)
    if constant is None:
        message = f"'{name}' is a control, and a learned rule compares reads with numbers"
        return _refused(part, message, "write a number in SI, or decide by `rules`")
    message = f"'{name}' is a constant, and a learned rule compares reads with numbers"
    return _refused(part, message, f"write its value in SI: {number(constant.value)}")


def _no_comparison(part: Expr, declared: Declarations) -> Fault:
    op = part.op if isinstance(part, Apply) else ""
    if op == "or":
        return _refused(part, "a learned rule is one box, and `or` makes two", "write two rules")
    if isinstance(part, Apply) and op == "not":
        message = "a learned rule is made of comparisons, without `not`"
        inner = part.operands[0]
        if isinstance(inner, Apply) and inner.op in OPPOSITE:
            turned = to_text(Apply(OPPOSITE[inner.op], inner.operands))
            return _refused(part, message, f"write `{turned}`")
        return _refused(part, message, _example(declared))
    return _refused(part, ONE_READ, _example(declared))


def _example(declared: Declarations) -> str:
    return _example_of(declared.states[0]) if declared.states else "remove the condition"


def _example_of(state: State) -> str:
    if state.kind is Kind.DISCRETE:
        return f"write e.g. `{state.name} == '{state.values[0]}'`"
    return f"write e.g. `{state.name} < {number((state.low + state.high) / 2)}`"


def _refused(part: Expr, message: str, remedy: str) -> Fault:
    return Fault(part.start, part.end, "S391", message, remedy)

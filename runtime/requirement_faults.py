"""What keeps a requirement from being judged: one that was read from a file may hold anything."""

import math
from collections.abc import Iterator

from runtime.requirement import Formula, Operator, Requirement
from runtime.tape import check_code


def faults_of(requirement: Requirement) -> Iterator[str]:
    """What is wrong with a requirement, each in a sentence; nothing where it can be judged."""
    for problem in _problems(requirement):
        yield f"'{requirement.text}' can't be judged: {problem}"


def _problems(requirement: Requirement) -> Iterator[str]:
    if not (math.isfinite(requirement.scale) and requirement.scale > 0.0):
        yield f"its unit has the scale {requirement.scale!r}"
    if len(set(requirement.quantities)) != len(requirement.quantities):
        yield "it names a quantity twice"
    yield from _of_order(requirement.formula)
    for part in requirement.formula:
        yield from _of_part(part, requirement.quantities)


def _of_order(formula: tuple[Formula, ...]) -> Iterator[str]:
    """In postfix order each operator finds its operands before it, and one part is left."""
    left = 0
    for part in formula:
        if left < part.operator.operands:
            yield f"'{part.operator}' lacks an operand"
            return
        left += 1 - part.operator.operands
    if left != 1:
        yield f"it consists of {left} formulas, not of one"


def _of_part(part: Formula, quantities: tuple[str, ...]) -> Iterator[str]:
    last = part.first if part.last is None else part.last
    if not (0.0 <= part.first <= last < math.inf):
        yield f"'{part.operator}' has a window from {part.first!r} s to {part.last!r} s"
    if (part.operator is Operator.PREDICATE) != (part.margin is not None):
        yield f"'{part.operator}' has {'no' if part.margin is None else 'a'} margin"
    if part.margin is not None:
        try:
            check_code(part.margin, quantities)
        except ValueError as problem:
            yield str(problem)

"""The robustness of a formula as a course, and what of it the run's end leaves open.

Each part of a formula has two courses, a lower and an upper bound, which are apart where it depends
on what was not seen. A window of so many seconds reaches beyond the end of the run near it; "the
rest of the run" does not. There `always` and `eventually` look at those instants only whose own
windows fit into the run; others count where what was seen of them decides them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import final

from runtime.requirement import Formula, Operator, Requirement
from verifier.requirements.course import (
    BEYOND,
    Course,
    advanced,
    greater,
    highest_until,
    highest_within,
    holds_until,
    kept_until,
    less,
    negated,
)
from verifier.requirements.signals import Signal, Span, margins


@final
@dataclass(frozen=True, eq=False, slots=True)
class Part:
    """A part of a formula with its operands.

    lower, upper: bounds of its robustness at every instant. reach: how many seconds after an
    instant it looks, apart from the rest of the run.
    """

    formula: Formula
    operands: tuple["Part", ...]
    lower: Course
    upper: Course
    reach: float


def robustness(requirement: Requirement, signals: Mapping[str, Signal], span: Span) -> Part:
    """The requirement's formula with the robustness of all of its parts."""
    parts: list[Part] = []
    for formula in requirement.formula:
        count = formula.operator.operands
        operands = tuple(parts[len(parts) - count :])
        del parts[len(parts) - count :]
        parts.append(_part(formula, operands, requirement, signals, span))
    assert len(parts) == 1, "a formula in postfix order leaves one part"
    return parts[0]


def _part(
    formula: Formula,
    operands: tuple[Part, ...],
    requirement: Requirement,
    signals: Mapping[str, Signal],
    span: Span,
) -> Part:
    reach = max((each.reach for each in operands), default=0.0)
    if formula.operator is Operator.PREDICATE:
        assert formula.margin is not None, "a predicate has a margin"
        lower, upper = margins(formula.margin, requirement.quantities, signals, span)
    else:
        lower, upper = _combined(formula, operands, span.end - reach, span.end)
    return Part(formula, operands, lower, upper, reach + _own_reach(formula))


def _own_reach(formula: Formula) -> float:
    return formula.first if formula.last is None else formula.last


def _combined(  # noqa: PLR0911  one for each operator
    formula: Formula, operands: Sequence[Part], decided: float, end: float
) -> tuple[Course, Course]:
    """Both bounds; `decided`: until when the operands' windows fit into the run."""
    one, other = operands[0], operands[-1]
    match formula.operator:
        case Operator.NOT:
            return negated(one.upper), negated(one.lower)
        case Operator.AND:
            return less(one.lower, other.lower), less(one.upper, other.upper)
        case Operator.OR:
            return greater(one.lower, other.lower), greater(one.upper, other.upper)
        case Operator.IMPLIES:
            return (
                greater(negated(one.upper), other.lower),
                greater(negated(one.lower), other.upper),
            )
        case Operator.EVENTUALLY:
            return _eventually(formula, one.lower, one.upper, decided, end)
        case Operator.ALWAYS:
            lower, upper = _eventually(
                formula, negated(one.upper), negated(one.lower), decided, end
            )
            return negated(upper), negated(lower)
        case _:
            return _until(formula, one, other, decided, end)


def _eventually(
    formula: Formula, lower: Course, upper: Course, decided: float, end: float
) -> tuple[Course, Course]:
    first, last = formula.first, formula.last
    if last is not None:
        return highest_within(lower, first, last), highest_within(upper, first, last)
    found = highest_until(lower, first, end)
    possible = kept_until(highest_until(upper, first, decided), decided - first, BEYOND)
    return found, greater(possible, found)


def _until(
    formula: Formula, holds: Part, reached: Part, decided: float, end: float
) -> tuple[Course, Course]:
    """By the law that `a until in [p, q] b` is: a in [0, p], b in [p, q], then a until b."""
    bounds = []
    sides = ((holds.lower, reached.lower, end), (holds.upper, reached.upper, decided))
    for held, wanted, seen_until in sides:
        target = wanted if formula.last is not None else kept_until(wanted, seen_until, -BEYOND)
        found = advanced(holds_until(held, target), formula.first)
        if formula.last is not None:
            found = less(found, highest_within(wanted, formula.first, formula.last))
        if formula.first > 0.0:
            found = less(found, negated(highest_within(negated(held), 0.0, formula.first)))
        bounds.append(found)
    lower, upper = bounds
    if formula.last is None:
        upper = greater(kept_until(upper, decided - formula.first, BEYOND), lower)
    return lower, upper

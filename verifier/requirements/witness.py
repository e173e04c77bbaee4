"""Which instant, and which predicate there, makes a formula as robust as it is.

A maximum of maxima and minima is the value of one predicate at one instant, which is found from
the top downwards: at each operator the operand, and the instant in its window, of that value.
"""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array
from runtime.code import Code
from runtime.requirement import Operator
from verifier.requirements.course import BEYOND, Course
from verifier.requirements.robustness import Part


@final
@dataclass(frozen=True, slots=True)
class Deciding:
    """The predicate that decides, and when (seconds)."""

    time: float
    margin: Code


@final
@dataclass(frozen=True, slots=True)
class _Sought:
    """A value of a part at an instant: of its upper or its lower bound."""

    time: float
    is_upper: bool

    def of(self, part: Part) -> Course:
        """The course whose value is sought."""
        return part.upper if self.is_upper else part.lower


def deciding(part: Part, time: float, end: float, *, is_upper: bool) -> Deciding | None:
    """What decides the bound of `part` at `time`; None where that was not seen."""
    sought = _Sought(time, is_upper)
    value = float(sought.of(part).values_at(np.array([time]))[1][0])
    while abs(value) < BEYOND:
        if part.formula.margin is not None:
            return Deciding(sought.time, part.formula.margin)
        part, sought, value = _operand(part, sought, value, end)
    return None


def _operand(part: Part, sought: _Sought, value: float, end: float) -> tuple[Part, _Sought, float]:
    """The operand and the instant from which `value` comes, and its value there."""
    best: tuple[float, Part, _Sought, float] | None = None
    for operand, is_turned, first, last in _windows(part, end):
        upper = sought.is_upper is not is_turned
        at = _Sought(sought.time, upper)
        wanted = -value if is_turned else value
        time, found = _nearest(at.of(operand), wanted, sought.time + first, sought.time + last)
        if best is None or abs(found - wanted) < best[0]:
            best = (abs(found - wanted), operand, _Sought(time, upper), found)
    assert best is not None, "an operator has operands"
    return best[1], best[2], best[3]


def _windows(part: Part, end: float) -> list[tuple[Part, bool, float, float]]:
    """The operands, whether they are negated, and where the operator looks (from now)."""
    formula, operands = part.formula, part.operands
    last = end if formula.last is None else formula.last
    match formula.operator:
        case Operator.NOT:
            return [(operands[0], True, 0.0, 0.0)]
        case Operator.IMPLIES:
            return [(operands[0], True, 0.0, 0.0), (operands[1], False, 0.0, 0.0)]
        case Operator.ALWAYS | Operator.EVENTUALLY:
            return [(operands[0], False, formula.first, last)]
        case Operator.UNTIL:
            return [(operands[0], False, 0.0, last), (operands[1], False, formula.first, last)]
        case _:
            return [(each, False, 0.0, 0.0) for each in operands]


def _nearest(course: Course, value: float, first: float, last: float) -> tuple[float, float]:
    """The earliest instant of a window whose value is the nearest to `value`, and that value."""
    ends = np.array([first, last])
    left, right = course.values_at(ends)
    inside = (course.times > first) & (course.times <= last)
    passed = passages(course, value)
    passed = passed[(passed > first) & (passed < last)]
    times = np.concatenate([ends, course.times[inside], course.times[inside], passed])
    values = np.concatenate(
        [
            [right[0], left[1] if last > first else right[1]],
            course.before[inside],
            course.after[inside],
            np.full(passed.size, value),
        ]
    )
    apart = np.abs(values - value)
    near = np.flatnonzero(apart <= apart.min() * (1.0 + 1e-9))
    chosen = near[np.argmin(times[near])]
    return float(times[chosen]), float(values[chosen])


def lowest_within(course: Course, first: float, last: float) -> float:
    """The earliest instant of a window at which, or just before which, a course is the least."""
    left, right = course.values_at(np.array([first, last]))
    inside = (course.times > first) & (course.times <= last)
    values = [right[:1], left[1:], course.before[inside], course.after[inside]]
    return _nearest(course, float(np.concatenate(values).min()), first, last)[0]


def passages(course: Course, value: float) -> Array:
    """Where the course passes through `value` inside of its pieces."""
    start, end = course.after[:-1] - value, course.before[1:] - value
    pieces = np.flatnonzero(np.sign(start) * np.sign(end) < 0.0)
    share = start[pieces] / (start[pieces] - end[pieces])
    passed: Array = course.times[pieces] + share * (course.times[pieces + 1] - course.times[pieces])
    return passed

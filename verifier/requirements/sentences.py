"""What a run says of a requirement, in a sentence."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.program import Unit
from runtime.requirement import ROUNDING, TIE, Operator
from verifier.report.requirement_results import Outcome, RequirementResult
from verifier.report.wording import listed, number, quantity
from verifier.requirements.course import Course, negated
from verifier.requirements.robustness import Part
from verifier.requirements.signals import Signal, Span, names_in
from verifier.requirements.witness import Deciding, deciding, lowest_within, passages

TIED: Final = TIE + ROUNDING
"""In SI: so near to 0 is at the bound."""
BARE: Final = Unit("1", 1.0)
WINDOW: Final = re.compile(r"^(?:(?:within|after) \S+ ?[a-z]+|from \S+ ?[a-z]+ to \S+ ?[a-z]+)\s+")
WORD: Final = re.compile(r"[()]|\buntil\b")


@final
@dataclass(frozen=True, eq=False, slots=True)
class Told:
    """A requirement on a run: its parts, the span, its quantities with their units."""

    part: Part
    span: Span
    quantities: tuple[str, ...]
    signals: Mapping[str, Signal]
    units: Mapping[str, Unit]


def sentence_of(result: RequirementResult, decides: Deciding | None, told: Told) -> str:
    """The outcome, by how much, when, and what was so then."""
    part, span = told.part, told.span
    if result.outcome is Outcome.OPEN:
        seconds = number(span.end - span.start)
        return f"open: {_why_open(part, span)} (the run is {seconds} s long)"
    if part.formula.operator is Operator.UNTIL:
        return f"{result.outcome}{_of_until(result, told)}"
    if decides is None:
        return str(result.outcome)
    if _is_discrete(decides, told):
        return _of_discrete(result, decides, told)
    where = _when_and_where(decides, told)
    never = _never(result) if part.formula.operator is Operator.EVENTUALLY else ""
    if never:
        return f"{result.outcome}{_by(result)}: {never} never came (nearest at {where})"
    return f"{result.outcome}{_by(result)} at {where}"


def _never(result: RequirementResult) -> str:
    """What a lone `eventually` waited for in vain; empty where it came, or missed by nothing."""
    if result.outcome is not Outcome.VIOLATED or abs(result.robustness) <= TIED:
        return ""
    awaited = _bare(result.text.strip()).removeprefix("eventually").strip()
    return _bare(WINDOW.sub("", awaited))


def _of_discrete(result: RequirementResult, decides: Deciding, told: Told) -> str:
    """Without a number: a choice is not nearer to one than to another."""
    is_met = result.outcome is Outcome.SATISFIED
    if not is_met and told.part.formula.operator is Operator.EVENTUALLY:
        return f"{result.outcome}: it never was so"
    if is_met and decides.time <= told.span.start:
        return str(result.outcome)
    return f"{result.outcome} at {_when_and_where(decides, told)}"


def _of_until(result: RequirementResult, told: Told) -> str:
    """When what is waited for came, and whether what should hold until then did."""
    holds, reached = told.part.operands
    first = told.span.start + told.part.formula.first
    last = told.part.formula.last
    end = told.span.end if last is None else min(told.span.start + last, told.span.end)
    hold, come = _texts(result.text)
    if result.outcome is Outcome.SATISFIED:
        came = _first(reached.lower, first, end, is_met=True)
        if came is None:  # it came as a limit only
            return _by(result)
        least = lowest_within(holds.lower, told.span.start, came)
        nearest = deciding(holds, least, told.span.end, is_upper=False)
        tail = ""
        if came > told.span.start and nearest is not None and not _is_discrete(nearest, told):
            tail = f"; until then {hold} was nearest to its bound at "
            tail += _when_and_where(nearest, told)
        return f": {come} came {_at(reached, came, told, is_upper=False)}{tail}"
    came = _first(reached.upper, first, end, is_met=True)
    broke = _first(holds.upper, told.span.start, end, is_met=False)
    waited = f"{come} came only at {_time(came, told)} s" if came is not None else ""
    waited = waited or f"{come} never came{_nearest(reached, first, end, told)}"
    if broke is None:
        return f"{_by(result)}: {waited}"
    when = _at(holds, broke, told, is_upper=True)
    return f": {hold} no longer held {when}, and {waited}"


def _nearest(part: Part, first: float, last: float, told: Told) -> str:
    """When what never held was the nearest to it, in brackets; nothing where that says nothing."""
    if last < first:
        return ""
    time = lowest_within(negated(part.upper), first, last)
    decides = deciding(part, time, told.span.end, is_upper=True)
    if decides is None or _is_discrete(decides, told):
        return ""
    return f" (nearest at {_when_and_where(decides, told)})"


def _at(part: Part, time: float, told: Told, *, is_upper: bool) -> str:
    """`at 3 s, where r.x is 2 m`; without values where other instants decide."""
    decides = deciding(part, time, told.span.end, is_upper=is_upper)
    if decides is None or abs(decides.time - time) > ROUNDING:
        return f"at {_time(time, told)} s"
    return f"at {_when_and_where(decides, told)}"


def _first(course: Course, first: float, last: float, *, is_met: bool) -> float | None:
    """The first instant of a window from which a course is 0 or more (else: below), if any."""
    if last < first:
        return None

    def fits(values: Array) -> Booleans:
        found: Booleans = (values >= -ROUNDING) == is_met
        return found

    if fits(course.values_at(np.array([first]))[1])[0]:
        return first
    starts = course.times[fits(course.after)]
    times = np.concatenate([starts, passages(course, -ROUNDING)])
    inside = times[(times > first) & (times <= last)]
    return float(inside.min()) if inside.size else None


def _texts(text: str) -> tuple[str, str]:
    """What stands before and after the outermost `until`.

    >>> _texts("(a > 1 until b > 2) until within 5 s (c > 3)")
    ('a > 1 until b > 2', 'c > 3')
    """
    depth = 0
    for found in WORD.finditer(text):
        depth += {"(": 1, ")": -1}.get(found.group(), 0)
        if found.group() == "until" and depth == 0:
            before, after = text[: found.start()].strip(), text[found.end() :].strip()
            return _bare(before), _bare(WINDOW.sub("", after))
    return "what should hold", "what is waited for"


def _bare(text: str) -> str:
    """Without brackets around all of it."""
    depth = 0
    for place, letter in enumerate(text):
        depth += {"(": 1, ")": -1}.get(letter, 0)
        if depth == 0 and place < len(text) - 1:
            return text
    return text[1:-1].strip() if text.startswith("(") else text


def _is_discrete(decides: Deciding, told: Told) -> bool:
    names = names_in(decides.margin, told.quantities)
    return any(told.signals[name].is_discrete for name in names)


def _when_and_where(decides: Deciding, told: Told) -> str:
    names = names_in(decides.margin, told.quantities)
    values = [_shown(name, decides.time, told) for name in names]
    return f"{_time(decides.time, told)} s, where {listed(values)}"


def _time(time: float, told: Told) -> str:
    return number(time - told.span.start)


def value_at(signal: Signal, time: float) -> float:
    """What a quantity is at an instant."""
    if signal.is_held:
        place = int(np.searchsorted(signal.times, time, "right")) - 1
        return float(signal.values[max(place, 0)])
    return float(np.interp(time, signal.times, signal.values))


def _by(result: RequirementResult) -> str:
    """By how much, where that has one unit."""
    robustness, unit = abs(result.robustness), result.unit
    if not unit.text or math.isinf(robustness):
        return ""
    if robustness <= TIED:
        is_met = result.outcome is Outcome.SATISFIED
        return f", {'but ' if is_met else ''}exactly at its bound,"
    return f" by {quantity(robustness, unit)}"


def _shown(name: str, time: float, told: Told) -> str:
    signal = told.signals[name]
    value = value_at(signal, time)
    value = 0.0 if abs(value) <= TIED else value
    if not signal.labels:
        return f"{name} is {quantity(value, told.units.get(name, BARE))}"
    is_one = value >= 0.0
    return f"{name} is '{signal.labels[int(value)]}'" if is_one else f"{name} is none of its values"


def _why_open(part: Part, span: Span) -> str:
    if part.reach > span.end - span.start:
        return f"its windows reach {number(part.reach)} s ahead"
    return "what it reads was not measured where that decides"

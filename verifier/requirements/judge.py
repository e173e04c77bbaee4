"""Requirements judged on a run: satisfied, violated or open, by how much, and what decides it."""

import math
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from runtime.program import Unit
from runtime.requirement import Requirement
from verifier.report.requirement_results import Outcome, RequirementResult, Witness
from verifier.report.wording import listed, number, quantity, suffix
from verifier.requirements.course import BEYOND
from verifier.requirements.robustness import Part, robustness
from verifier.requirements.signals import Signal, Span, names_in, span_of
from verifier.requirements.witness import deciding

ROUNDING: Final = 1e-9
"""In SI: so little below 0 is 0."""


def judge_requirements(
    requirements: Sequence[Requirement],
    signals: Mapping[str, Signal],
    end: float | None = None,
    units: Mapping[str, Unit] | None = None,
) -> tuple[RequirementResult, ...]:
    """Each requirement on one run, from its first sample to its `end` (None: the last sample).

    units: of quantities, for sentences.

    Raises:
        KeyError: a requirement reads a quantity that has no signal with a sample.
    """
    span = span_of([each for each in signals.values() if each.times.size], end)
    return tuple(judge_requirement(each, signals, span, units or {}) for each in requirements)


def judge_requirement(
    requirement: Requirement,
    signals: Mapping[str, Signal],
    span: Span,
    units: Mapping[str, Unit],
) -> RequirementResult:
    """One requirement on the run of that span."""
    part = robustness(requirement, signals, span)
    low, high = float(part.lower.after[0]), float(part.upper.after[0])
    outcome = _outcome(low, high)
    is_upper = outcome is Outcome.VIOLATED or (outcome is Outcome.OPEN and high < BEYOND)
    decides = deciding(part, span.start, span.end, is_upper=is_upper)
    unit = Unit(requirement.unit, requirement.scale)
    witness = None
    if decides is not None:
        names = names_in(decides.margin, requirement.quantities)
        values = {name: _value_at(signals[name], decides.time) for name in names}
        witness = Witness(decides.time - span.start, values)
    low, high = _unbounded(low), _unbounded(high)
    told = RequirementResult(
        requirement.text, outcome, low, high, unit, witness, "", requirement.origin
    )
    sentence = _sentence(told, part, span, units)
    return RequirementResult(
        requirement.text, outcome, low, high, unit, witness, sentence, requirement.origin
    )


def _outcome(low: float, high: float) -> Outcome:
    if low >= -ROUNDING:
        return Outcome.SATISFIED
    return Outcome.VIOLATED if high < -ROUNDING else Outcome.OPEN


def _unbounded(value: float) -> float:
    return math.copysign(math.inf, value) if abs(value) >= BEYOND else value


def _value_at(signal: Signal, time: float) -> float:
    if signal.is_held:
        place = int(np.searchsorted(signal.times, time, "right")) - 1
        return float(signal.values[max(place, 0)])
    return float(np.interp(time, signal.times, signal.values))


def _sentence(result: RequirementResult, part: Part, span: Span, units: Mapping[str, Unit]) -> str:
    if result.outcome is Outcome.OPEN:
        seconds = number(span.end - span.start)
        return f"open: {_why_open(part, span)} (the run is {seconds} s long)"
    how = f"{result.outcome}{_by(result)}"
    if result.witness is None:
        return how
    values = [_shown(name, value, units) for name, value in result.witness.values.items()]
    return f"{how} at {number(result.witness.time)} s, where {listed(values)}"


def _by(result: RequirementResult) -> str:
    """By how much, where that has one unit."""
    robustness, unit = abs(result.robustness), result.unit
    if not unit.text or math.isinf(robustness):
        return ""
    if robustness <= ROUNDING:
        return ", but exactly at its bound,"
    return f" by {number(robustness / unit.scale)}{suffix(unit)}"


def _shown(name: str, value: float, units: Mapping[str, Unit]) -> str:
    return f"{name} is {quantity(value, units.get(name, Unit('1', 1.0)))}"


def _why_open(part: Part, span: Span) -> str:
    if part.reach > span.end - span.start:
        return f"its windows reach {number(part.reach)} s ahead"
    return "what it reads was not measured where that decides"

"""Requirements judged on a run: satisfied, violated or open, by how much, and what decides it."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

from runtime.program import Unit
from runtime.requirement import ROUNDING, Requirement
from verifier.report.requirement_results import Outcome, RequirementResult, Witness
from verifier.requirements.course import BEYOND
from verifier.requirements.robustness import robustness
from verifier.requirements.sentences import TIED, Told, sentence_of, value_at
from verifier.requirements.signals import Signal, Span, names_in, span_of
from verifier.requirements.witness import deciding


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
        values = {name: value_at(signals[name], decides.time) for name in names}
        witness = Witness(decides.time - span.start, values)
    low, high = _shown(low), _shown(high)
    found = RequirementResult(
        requirement.text, outcome, low, high, unit, witness, "", requirement.origin
    )
    told = Told(part, span, requirement.quantities, signals, units)
    return replace(found, sentence=sentence_of(found, decides, told))


def _outcome(low: float, high: float) -> Outcome:
    if low >= -ROUNDING:
        return Outcome.SATISFIED
    return Outcome.VIOLATED if high < -ROUNDING else Outcome.OPEN


def _shown(value: float) -> float:
    """Robustness as it is told: 0 at the bound, infinite where nothing bounds it."""
    if abs(value) <= TIED:
        return 0.0
    return math.copysign(math.inf, value) if abs(value) >= BEYOND else value

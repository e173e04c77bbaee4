"""A recorded run held against what its scenario requires: the verdict, and each requirement."""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from runtime.program import Kind
from runtime.recording.tracks import Quantity
from runtime.requirement import Requirement
from verifier.report.examination import Examination
from verifier.report.report import Report, SpecIdentity, TraceIdentity, Verdict
from verifier.report.requirement_results import Outcome, RequirementResult
from verifier.requirements.judge import judge_requirements
from verifier.requirements.signals import Signal
from verifier.traces.trace import Loss

CONFIDENCE: Final = 1.0
"""Nothing is estimated: what was seen of a run decides, or leaves open."""
VERDICTS: Final = {
    Outcome.VIOLATED: Verdict.FAIL,
    Outcome.OPEN: Verdict.INCONCLUSIVE,
    Outcome.SATISFIED: Verdict.PASS,
}
"""The worst first."""


def results_on(
    requirements: Sequence[Requirement], quantities: Mapping[str, Quantity], duration: float
) -> tuple[RequirementResult, ...]:
    """What a run of that many seconds says of each requirement.

    Raises:
        KeyError: a requirement reads a quantity that the run has not.
    """
    units = {name: quantity.unit for name, quantity in quantities.items()}
    signals = {name: signal_of(quantity) for name, quantity in quantities.items()}
    return judge_requirements(requirements, signals, duration, units)


def examine_requirements(
    results: Sequence[RequirementResult],
    spec: SpecIdentity,
    source: str,
    duration: float,
    losses: tuple[Loss, ...] = (),
) -> Examination:
    """The requirements on a run as an examination: the worst of them is the verdict."""
    outcomes = {each.outcome for each in results}
    verdict = next(word for outcome, word in VERDICTS.items() if outcome in outcomes)
    broken = [each for each in results if each.outcome is not Outcome.SATISFIED]
    broken.sort(key=lambda each: list(VERDICTS).index(each.outcome))
    reasons = [f"{each.text}: {each.sentence}" for each in broken]
    count = len(results)
    met = "what is required is met" if count == 1 else f"all {count} requirements are met"
    report = Report(
        verdict=verdict,
        reasons=tuple(reasons) or (met,),
        advice=("run it for longer",) if verdict is Verdict.INCONCLUSIVE else (),
        horizon=0.0,
        confidence=CONFIDENCE,
        variables=(),
        coverage=None,
        exclusions=(),
        losses=losses,
        notes=(),
        spec=spec,
        trace=TraceIdentity(source, 0.0, duration, duration),
        starts=np.zeros(0),
        places={},
        units={},
    )
    origins = {"fidelity": results[0].origin}
    return Examination(report, origins=origins, requirements=tuple(results))


def signal_of(quantity: Quantity) -> Signal:
    """A quantity as requirements read it; one without a sample was never known."""
    turns = quantity.kind is Kind.PERIODIC
    times, values = quantity.times, quantity.values
    return Signal(
        name=quantity.name,
        times=times if times.size else np.zeros(1),
        values=values if values.size else np.full(1, np.nan),
        is_held=quantity.is_held,
        period=quantity.high - quantity.low if turns else 0.0,
        low=quantity.low if turns else 0.0,
        is_discrete=quantity.kind is Kind.DISCRETE,
        labels=quantity.labels,
    )

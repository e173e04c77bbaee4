"""What is required of a recorded run, judged on its quantities."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from runtime.recording.tracks import Quantity
from runtime.requirement import Requirement
from spec_schema.diagnostics import Diagnostic, SpecError
from spec_schema.suggest import did_you_mean
from specc.faults import fault
from specc.verifying.standard import Carried
from verifier.architectures.log import RunLog
from verifier.architectures.required import results_on
from verifier.report.requirement_results import RequirementResult

MOST_NAMED: Final = 12
"""So many quantities are listed."""


def judged_on(
    trace: Path,
    requirements: Sequence[Requirement],
    quantities: Mapping[str, Quantity],
    carried: Carried,
    log: RunLog,
) -> tuple[tuple[RequirementResult, ...], float]:
    """The results, and how many seconds they are about: of a torn recording what is left of it.

    Raises:
        SpecError: a quantity that is required was not recorded (V394).
    """
    _refuse_unknown(trace, requirements, quantities)
    ends = [float(each.times[-1]) for each in quantities.values() if each.times.size]
    duration = max(ends, default=0.0)
    document = carried.document
    if document is not None and not log.losses:
        duration = round(document.duration / document.step) * document.step
    return results_on(requirements, quantities, duration), duration


def _refuse_unknown(
    trace: Path, requirements: Sequence[Requirement], quantities: Mapping[str, Quantity]
) -> None:
    """Every quantity that is read was recorded.

    Raises:
        SpecError: one was not (V394).
    """
    mistakes: list[Diagnostic] = []
    for each in requirements:
        for name in each.quantities:
            if name in quantities:
                continue
            message = f"'{each.text}' is about '{name}', which is not in this recording"
            error = fault("V394", trace, message, _there(name, quantities))
            mistakes += error.diagnostics
    if mistakes:
        raise SpecError(mistakes)


def _there(name: str, quantities: Mapping[str, Quantity]) -> str:
    """What may be meant, and what there is of the same robot, or at all."""
    alike = [other for other in quantities if other.partition(".")[0] == name.partition(".")[0]]
    last = name.rpartition(".")[2]
    known = sorted(alike or quantities, key=lambda each: (not each.endswith(f".{last}"), each))
    more = f" and {len(known) - MOST_NAMED} more" if len(known) > MOST_NAMED else ""
    there = f"there are: {', '.join(known[:MOST_NAMED])}{more}"
    return "\n".join(part for part in (did_you_mean(name, quantities), there) if part)

"""Requirements whose windows reach beyond the run: what can't be decided in it is told."""

from typing import Final

from compiler.architecture.times import seconds
from compiler.findings import Findings
from runtime.requirement import Operator, Requirement
from spec_schema.places import Path

SLACK: Final = 1.0 + 1e-9
"""A window as long as the run fits into it."""


def check_window(requirement: Requirement, path: Path, duration: float, findings: Findings) -> None:
    """A warning where a requirement looks further ahead than the run lasts."""
    reach = reach_of(requirement)
    if not 0.0 < duration * SLACK < reach:
        return
    last = requirement.formula[-1]
    outcome = "may be able to decide nothing but that it is open"
    if last.last is not None and last.operator is Operator.EVENTUALLY:
        outcome = "can satisfy it or leave it open, and never violate it"
    elif last.last is not None and last.operator is Operator.ALWAYS:
        outcome = "can violate it or leave it open, and never satisfy it"
    message = f"this looks {seconds(reach)} ahead: a run of {seconds(duration)} {outcome}"
    remedy = f"write 'duration: {seconds(reach)}' or more, or a shorter window"
    findings.warning("S375", path, message, remedy)


def reach_of(requirement: Requirement) -> float:
    """How many seconds ahead its windows look, apart from the rest of the run."""
    reaches: list[float] = []
    for formula in requirement.formula:
        count = formula.operator.operands
        inner = max(reaches[len(reaches) - count :], default=0.0) if count else 0.0
        del reaches[len(reaches) - count :]
        own = formula.first if formula.last is None else formula.last
        reaches.append(inner + own)
    return reaches[-1]

"""The examination: the report with all the sections that explain it, as data."""

from dataclasses import dataclass, field
from typing import Literal, TypeAlias, final

from verifier.report.arbitration import Arbitration
from verifier.report.diagnosis import Diagnosis
from verifier.report.features import Features
from verifier.report.limits import Limits
from verifier.report.report import Report
from verifier.report.requirement_results import RequirementResult
from verifier.report.scores import Scores
from verifier.report.switching import Switching

Depth: TypeAlias = Literal["verdict", "reasons", "all"]
"""What is found out: the verdict; why, where it is no PASS; or also how far a verdict reaches."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Examination:
    """What was found in one trace; a section that was not computed is None.

    switching: the changes of mode. diagnosis: why the robot departs. limits: what this trace
    can't tell, and what it would have caught. features: the robot's topology beside the spec's.
    scores: those of similarity, for comparison only. arbitration: of an arbiter, how it decides.
    requirements: of a scenario's run, what is required and whether it holds.
    origins: where in the spec, `file:line:column`, each thing stands that a finding may be about:
    its name for a state or control, `fidelity` for what is demanded of the robot.
    """

    report: Report
    switching: Switching | None = None
    diagnosis: Diagnosis | None = None
    limits: Limits | None = None
    features: Features | None = None
    scores: Scores | None = None
    origins: dict[str, str] = field(default_factory=dict)
    arbitration: Arbitration | None = None
    requirements: tuple[RequirementResult, ...] = ()

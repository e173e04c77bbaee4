"""The examination: the report with all the sections that explain it, as data."""

from dataclasses import dataclass, field
from typing import final

from verifier.report.report import Report
from verifier.report.scores import Scores


@final
@dataclass(frozen=True, eq=False, slots=True)
class Examination:
    """What was found in one trace; a section that was not computed is None.

    origins: where in the spec, `file:line:column`, each thing stands that a finding may be about:
    its name for a state or control, `fidelity` for what is demanded of the robot.
    """

    report: Report
    scores: Scores | None = None
    origins: dict[str, str] = field(default_factory=dict)

"""How an arbiter is trained in a scenario: what each of its decisions is rewarded for.

A *measure* is a number per decision, of what happened since the decision before. The reward is an
expression of the measures. All of it is in SI.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import final

from runtime.code import Code
from runtime.requirement import Requirement


@final
class How(StrEnum):
    """What of a quantity between two decisions is the measure.

    RISE: the last value minus the first; FALL: the first minus the last. MOST, LEAST: the greatest
    and the smallest. MEAN: over time. LAST: at the later decision. ROBUSTNESS: by how much the
    whole run satisfies a requirement, given at its last decision; 0 before.
    """

    RISE = "rise"
    FALL = "fall"
    MOST = "most"
    LEAST = "least"
    MEAN = "mean"
    LAST = "last"
    ROBUSTNESS = "robustness"


@final
@dataclass(frozen=True, slots=True)
class Measure:
    """What happened since the decision before, as one number.

    code: what is measured, over `Training.quantities`; None of ROBUSTNESS, which has a
    `requirement` instead.
    """

    name: str
    how: How
    code: Code | None
    requirement: Requirement | None
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Training:
    """What `specc train` makes an arbiter learn from.

    robot, node: whose arbiter it is. reward: of each decision, over the names of the measures in
    their order. quantities: names of the run, the register of the measures' code and of
    `ends_when`. ends_when: a margin; an episode ends (for learning) where it first is 0 or more;
    None where only the run ends it. discount: what a reward is worth one decision later.
    """

    robot: str
    node: str
    reward: Code
    measures: tuple[Measure, ...]
    quantities: tuple[str, ...]
    ends_when: Code | None
    discount: float
    origin: str

    @property
    def arbiter(self) -> str:
        """`robot.node`, by which a run knows its learners."""
        return f"{self.robot}.{self.node}"

    @property
    def register(self) -> tuple[str, ...]:
        """The names that the reward may read."""
        return tuple(measure.name for measure in self.measures)

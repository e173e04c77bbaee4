"""Learners by name, each with the config that it begins with."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final, Protocol, final

import numpy as np

from lcs.alcsr import config as alcsr
from lcs.alcsr.config import GROWN
from lcs.alcsr.learner import ALCSR
from lcs.alcsr.readings import RangeIs
from lcs.arrays import Array
from lcs.course import Learner
from lcs.faults import LearnerError
from lcs.problems.problem import Problem
from lcs.state import Saved
from lcs.steps import config as steps
from lcs.xcsr import config as xcsr
from lcs.xcsr.learner import XCSR


class SavedLearner(Learner, Saved, Protocol):
    """A learner that can be saved, and go on."""


@final
@dataclass(frozen=True, slots=True)
class Known:
    """A learner of problems by name: what it is, its config, and how it is made for a problem."""

    about: str
    config: Any
    make: Callable[[Problem, Any, int], SavedLearner]


@final
@dataclass(frozen=True, slots=True)
class KnownOfWorlds:
    """A learner of several steps by name: what it is, and its config."""

    about: str
    config: steps.Config


def _alcsr(problem: Problem, config: alcsr.Config, seed: int) -> SavedLearner:
    if config.readings.range_is is not RangeIs.DECLARED:
        return ALCSR(problem.classes, problem.inputs, config, seed=seed)
    low, high = ranges_of(problem)
    for each, least, most in zip(problem.described, low, high, strict=True):
        if least == most:
            raise LearnerError(
                f"'{each.name}' has no range: it is {least:g} in all rows; leave the column out"
            )
    return ALCSR(problem.classes, problem.inputs, config, low=low, high=high, seed=seed)


def _xcsr(problem: Problem, config: xcsr.Config, seed: int) -> SavedLearner:
    low, high = ranges_of(problem)
    return XCSR(problem.classes, problem.inputs, config, low=low, high=high, seed=seed)


def ranges_of(problem: Problem) -> tuple[Array, Array]:
    """The least and the most of each input (n,): as declared, or from 0 to 1."""
    low = [0.0 if each.low is None else each.low for each in problem.described]
    high = [1.0 if each.high is None else each.high for each in problem.described]
    return np.array(low), np.array(high)


LEARNERS: Final[Mapping[str, Known]] = {
    "alcsr": Known("artificial life, with all that goes beyond the thesis", GROWN, _alcsr),
    "thesis": Known(
        "artificial life, to the letter of the thesis's chapter 4", alcsr.Config(), _alcsr
    ),
    "xcsr": Known("accuracy-based fitness (Wilson 2000), the usual peer", xcsr.Config(), _xcsr),
}
"""In the order in which they are listed."""

STEPS: Final = "steps"

OF_WORLDS: Final[Mapping[str, KnownOfWorlds]] = {
    STEPS: KnownOfWorlds("boxes that divide, for the delayed rewards of a world", steps.Config()),
}

ALL: Final[Mapping[str, Known | KnownOfWorlds]] = {**LEARNERS, **OF_WORLDS}


def called(learner: str) -> str:
    """A learner in a sentence: `steps` alone would be read as the word."""
    return f"the learner {learner}" if learner in OF_WORLDS else learner


def learner_for(problem: Problem, name: str, config: Any, seed: int) -> SavedLearner:
    """A learner that knows nothing yet, with as many inputs and actions as the problem."""
    return LEARNERS[name].make(problem, config, seed)

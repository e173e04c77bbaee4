"""Learners by name, each with the config that it begins with."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final, Protocol, final

from lcs.alcsr.config import Config
from lcs.alcsr.learner import ALCSR
from lcs.course import Learner
from lcs.problems.problem import Problem
from lcs.state import Saved


class Kept(Learner, Saved, Protocol):
    """A learner that can be saved, and go on."""


@final
@dataclass(frozen=True, slots=True)
class Known:
    """A learner by name: what it is, its config, and how it is made for a problem."""

    about: str
    config: Any
    make: Callable[[int, int, Any, int], Kept]


def _alcsr(actions: int, inputs: int, config: Config, seed: int) -> Kept:
    return ALCSR(actions, inputs, config, seed=seed)


LEARNERS: Final[Mapping[str, Known]] = {
    "alcsr": Known("artificial life, with all that goes beyond the thesis", Config(), _alcsr),
    "thesis": Known("artificial life, to the letter of the thesis's chapter 4", Config(), _alcsr),
}
"""In the order in which they are listed."""


def learner_for(problem: Problem, name: str, config: Any, seed: int) -> Kept:
    """A learner that knows nothing yet, with as many inputs and actions as the problem."""
    return LEARNERS[name].make(problem.classes, problem.inputs, config, seed)

"""The learners' kernels are compiled once per installation."""

from typing import Final

import numpy as np

from lcs.compiled import cache_folder
from lcs.problems.classes import checkerboard
from lcs.problems.steps import gridworld
from lcs.rules.compaction import compact
from lcs.rules.experience import remembered
from lcs.steps.config import Config
from specc.learning.learners import LEARNERS, OF_WORLDS, learner_for
from specc.learning.teaching_worlds import WorldTeacher

CYCLES: Final = 500
EPISODES: Final = 20


def is_warm(learner: str) -> bool:
    """Whether the kernels of a learner were compiled here, and are kept."""
    folder = cache_folder()
    return folder is not None and (folder / f"warm-{learner}").exists()


def warm(learner: str) -> None:
    """Learn something small, by which all kernels are compiled."""
    if learner in OF_WORLDS:
        _warm_worlds()
    else:
        _warm_problems(learner)
    folder = cache_folder()
    if folder is not None:
        (folder / f"warm-{learner}").touch()


def _warm_worlds() -> None:
    teacher = WorldTeacher(gridworld(), Config(memories=500, first=200), EPISODES)
    run = teacher.begun(0)
    teacher.advance(run, EPISODES)
    teacher.concluded([run], lambda _what, _done, _of: None)


def _warm_problems(learner: str) -> None:
    problem = checkerboard(2)
    pupil = learner_for(problem, learner, LEARNERS[learner].config, 0)
    x, rewards, _ = problem.drawn(CYCLES, np.random.default_rng(0))
    pupil.run(x, rewards)
    pupil.decide(x)
    tried = np.zeros(CYCLES, np.int64)
    compact(pupil.rules(), remembered(x, tried, rewards[:, 0], problem.classes))

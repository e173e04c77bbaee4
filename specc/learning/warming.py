"""The learners' kernels are compiled once per installation."""

from typing import Final

import numpy as np

from lcs.compiled import cache_folder
from lcs.problems.classes import checkerboard
from lcs.rules.compaction import compact
from lcs.rules.experience import remembered
from specc.learning.learners import LEARNERS, learner_for

CYCLES: Final = 500


def is_warm(learner: str) -> bool:
    """Whether the kernels of a learner were compiled here, and are kept."""
    folder = cache_folder()
    return folder is not None and (folder / f"warm-{learner}").exists()


def warm(learner: str) -> None:
    """Learn something small, by which all kernels are compiled."""
    problem = checkerboard(2)
    pupil = learner_for(problem, learner, LEARNERS[learner].config, 0)
    x, rewards, _ = problem.drawn(CYCLES, np.random.default_rng(0))
    pupil.run(x, rewards)
    pupil.decide(x)
    tried = np.zeros(CYCLES, np.int64)
    compact(pupil.rules(), remembered(x, tried, rewards[:, 0], problem.classes))
    folder = cache_folder()
    if folder is not None:
        (folder / f"warm-{learner}").touch()

"""The kernels that make policies of what was lived are compiled once per installation."""

from typing import Final

import numpy as np

from lcs.compiled import cache_folder
from lcs.policies.learner import Voting, found_policy
from lcs.policies.steps import Steps

STEPS: Final = 200


def is_warm(learner: str) -> bool:
    """Whether the kernels were compiled here, and are kept."""
    folder = cache_folder()
    return folder is not None and (folder / f"warm-policies-{learner}").exists()


def warm(learner: str) -> None:
    """Learn a policy of something small, by which all kernels are compiled."""
    chance = np.random.default_rng(0)
    x, action = chance.random((STEPS, 2)), chance.integers(2, size=STEPS)
    reward = (action == (x[:, 0] > 0.5)).astype(float)
    ends = np.zeros(STEPS, np.bool_)
    steps = Steps(x, action, reward, np.roll(x, -1, axis=0), ends, ends)
    ranges = np.zeros(2), np.ones(2)
    found = found_policy(steps, ranges, 2, discount=0.5, learner=learner, seed=0)
    Voting(found.tables[0], 0).decide(x)
    folder = cache_folder()
    if folder is not None:
        (folder / f"warm-policies-{learner}").touch()

"""What runs meet: it depends on the seed and the number of the cycle or episode alone.

So it is the same wherever a run was stopped, and nothing of a problem's chance has to be kept.
Problems come in blocks, each drawn from a seed of its own; each episode has a seed of its own.
"""

from typing import Final

import numpy as np

from lcs.arrays import Array, Integers
from lcs.problems.problem import Problem
from lcs.problems.steps import Plane

BLOCK: Final = 1_000
"""Problems that are drawn at once; another number gives other problems."""

DRAWN_TO_LEARN, DRAWN_TO_TEST, DRAWN_TO_FOLLOW, DRAWN_TO_JUDGE = 1, 2, 3, 4
"""What sets the seeds apart, and those from the learner's own."""


def block(problem: Problem, seed: int, number: int) -> tuple[Array, Array, Integers]:
    """The problems of a block: inputs, rewards of all classes, and right ones."""
    return problem.drawn(BLOCK, np.random.default_rng([seed, DRAWN_TO_LEARN, number]))


def fresh(problem: Problem, seed: int, count: int) -> tuple[Array, Integers]:
    """Problems to test on, and their classes: the same for all learners of one seed."""
    return problem.fresh(count, np.random.default_rng([seed, DRAWN_TO_TEST]))


def outside(seed: int, episode: int) -> np.random.Generator:
    """All chance of a world in an episode."""
    return np.random.default_rng([seed, DRAWN_TO_LEARN, episode])


def starts(world: Plane, seed: int, count: int) -> Array:
    """So many places (E, 2) to begin test episodes at: the same for all learners of one seed."""
    chance = np.random.default_rng([seed, DRAWN_TO_TEST])
    return np.array([world.reset(chance) for _ in range(count)])


def followed(seed: int) -> np.random.Generator:
    """All chance of a world while the best actions are followed: each time the same."""
    return np.random.default_rng([seed, DRAWN_TO_FOLLOW])


def places(world: Plane, seed: int, count: int) -> Array:
    """So many places (T, 2) that few rules are to say all of."""
    chance = np.random.default_rng([seed, DRAWN_TO_JUDGE])
    return np.array([world.reset(chance) for _ in range(count)])

"""What each action is worth where rewards come late: fitted Q iteration over all that was lived.

Source: Ernst, Geurts and Wehenkel (2005); the regression is that of `lcs.steps`, boxes that divide
at random, which settle whatever they hold (Gordon 1995).
"""

from typing import Final

import numpy as np

from lcs.arrays import Array
from lcs.policies.steps import Steps
from lcs.steps.config import Config
from lcs.steps.learner import StepsLearner

FAMILIES: Final = 10
FED: Final = 10
"""Of the boxes: how many divisions vote together, and how many steps of an action one box needs."""
GENERATIONS: Final = 3


def worth_of(lived: Steps, actions: int, discount: float, seed: int) -> Array:
    """What each action is worth at each of the places lived.x, (D, A).

    What was never tried anywhere near is worth as little as the least.

    Raises:
        LearnerError: something is not finite.
    """
    config = Config(
        discount=discount,
        memories=len(lived),
        fed=FED,
        families=FAMILIES,
        generations=GENERATIONS,
    )
    learner = StepsLearner(actions, lived.x.shape[1], config, seed=seed)
    learner.remember(lived.x, lived.action, lived.reward, lived.after, lived.ends)
    learner.grow()
    worth = learner.decide(lived.x)[1]
    known = np.isfinite(worth)
    least = worth[known].min(initial=np.inf)
    return np.where(known, worth, least)

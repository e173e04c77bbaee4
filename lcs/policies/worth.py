"""What each action is worth where rewards come late: fitted Q iteration over all that was lived.

Source: Ernst, Geurts and Wehenkel (2005).
"""

from typing import Final

import numpy as np

from lcs.arrays import Array
from lcs.faults import LearnerError
from lcs.given import inputs_of
from lcs.policies.held import held
from lcs.policies.kernels.fitting import Lived, Numbers, fitted
from lcs.policies.steps import Steps

FAMILIES: Final = 20
"""Trees of each action, which expect their mean together."""
FED: Final = 10, 30
"""Steps in a leaf, at least: a share of all, within these."""
SHARE: Final = 1 / 400
GENERATIONS: Final = 3
"""How often trees grow, each time for what those before expected."""
LONGEST: Final = 64
"""A choice is taken for what it brings while it is held, for so many decisions at most."""


def worth_of(lived: Steps, actions: int, discount: float, seed: int) -> Array:
    """What each action is worth at each of the places lived.x, (D, A).

    What was never taken is worth as little as the least.

    Raises:
        LearnerError: something is not finite.
    """
    if not np.isfinite(lived.reward).all():
        row = int(np.flatnonzero(~np.isfinite(lived.reward))[0])
        raise LearnerError(f"the reward of decision {row} is not finite: {lived.reward[row]}")
    n, longer = lived.x.shape[1], held(lived, discount, LONGEST)
    x, after = inputs_of(lived.x, n), inputs_of(longer.after, n)
    steps = Lived(x, lived.action, longer.reward, after, longer.ends, longer.discount)
    fed = int(np.clip(SHARE * len(lived), *FED))
    numbers = Numbers(actions, FAMILIES, fed, GENERATIONS)
    worth = fitted(steps, numbers, np.random.default_rng(seed)).T
    known = np.isfinite(worth)
    return np.where(known, worth, worth[known].min(initial=np.inf))

"""What the cycle stops for: births where food is left, growth, and the end of a season.

It is compiled apart, so that whoever stays with the thesis need not wait for it.
"""

import numpy as np

from lcs.alcsr.kernels.layout import (
    ACTION,
    DONE,
    LIVED,
    STAGE,
    UNCOVERED,
    UNEATEN,
    Land,
    Numbers,
    Rules,
    Scratch,
)
from lcs.alcsr.kernels.living import grow_again, settle
from lcs.alcsr.kernels.seasons import end_season
from lcs.alcsr.kernels.sorting import sort_in
from lcs.arrays import Array
from lcs.compiled import kernel


@kernel
def tend(
    rules: Rules,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    x: Array,
    reward: float,
    rng: np.random.Generator,
) -> None:
    """Go on where a cycle stopped, at x (n,), after the reward of `scratch.progress[ACTION]`."""
    progress = scratch.progress
    a = progress[ACTION]
    sort_in(land, scratch, a)
    if progress[STAGE] == UNEATEN:
        is_settled = settle(rules, land, numbers, scratch, a, x, reward, rng)
        progress[STAGE] = LIVED if is_settled else UNCOVERED
        return
    if numbers.grows == 1:
        grow_again(rules, land, scratch, a, x, rng)
    end_season(rules, land, numbers, scratch, a, rng)
    progress[STAGE] = DONE

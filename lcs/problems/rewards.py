"""The reward of each class: one for the right one, another for all others."""

from typing import Final

import numpy as np

from lcs.arrays import Array, Integers

RIGHT: Final = 1000.0
WRONG: Final = -1000.0
"""Both are those of the thesis (4.3.2)."""


def rewards_of(right: Integers, classes: int, flipped: float, chance: np.random.Generator) -> Array:
    """The rewards of all classes (T, A) where `right` (T,) are the right ones.

    flipped: the chance that a reward is the other one, of each class by itself.
    """
    is_right = np.arange(classes) == right[:, None]
    if flipped > 0.0:
        is_right ^= chance.random(is_right.shape) < flipped
    return np.where(is_right, RIGHT, WRONG)

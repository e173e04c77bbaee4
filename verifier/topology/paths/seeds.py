"""Evenly spread points of a slice, the same every time."""

from typing import Final

import numpy as np

from runtime.arrays import Array
from verifier.topology.slices import Slice

MARGIN: Final = 0.03
"""The share of the width that is left free at each edge."""

GENERATORS: Final = {
    1: 1.6180339887498949,
    2: 1.3247179572447460,
    3: 1.2207440846057596,
    4: 1.1673039782614187,
}
"""The positive roots of x^(m+1) = x + 1."""


def spread(view: Slice, count: int) -> Array:
    """`count` points (count, m) of the additive recurrence R_m (M. Roberts 2018)."""
    m = len(view.axes)
    steps = GENERATORS[m] ** -np.arange(1.0, m + 1.0)
    fractions = np.mod(0.5 + np.outer(np.arange(count), steps), 1.0)
    return np.asarray(view.low + (MARGIN + (1.0 - 2.0 * MARGIN) * fractions) * view.width)

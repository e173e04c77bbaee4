"""What comes in over the wires of a node; compiled."""

import math

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.kernels.cache import kernel


@kernel
def read(
    board: Array,
    signals: Integers,
    scales: Array,
    values: Array,
    low: Array,
    high: Array,
    turns: Array,
    inhibits: Booleans,
    found: Array,
) -> bool:
    """Fill `found` (m,) with the values within their domains; whether none keeps from acting.

    The arrays (m,) are as in `runtime.scheduler.inputs.Inputs`. What is no number is `low`, and
    keeps from acting. What is periodic is turned into its domain, and is never outside.
    """
    acts = True
    for place in range(len(signals)):
        wired = signals[place] >= 0
        value = board[signals[place]] * scales[place] if wired else values[place]
        if not low[place] <= value <= high[place]:
            turn = turns[place]
            if turn > 0.0:
                value -= turn * np.floor((value - low[place]) / turn)
            lost = math.isnan(value)
            acts = acts and not (lost or (inhibits[place] and turn == 0.0))
            value = low[place] if lost else min(max(value, low[place]), high[place])
        found[place] = value
    return acts

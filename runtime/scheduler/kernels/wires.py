"""What comes in over the wires of a node; compiled."""

import math

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
    inhibits: Booleans,
    found: Array,
) -> bool:
    """Fill `found` (m,) with the values within their domains; whether none keeps from acting.

    The arrays (m,) are as in `runtime.scheduler.inputs.Inputs`. What is no number is `low`, and
    keeps from acting.
    """
    acts = True
    for place in range(len(signals)):
        wired = signals[place] >= 0
        value = board[signals[place]] * scales[place] if wired else values[place]
        if not low[place] <= value <= high[place]:
            lost = math.isnan(value)
            acts = acts and not (lost or inhibits[place])
            value = high[place] if value > high[place] else low[place]
        found[place] = value
    return acts

"""How much rules believe in each action, and how far the nearest are that do."""

import numpy as np

from lcs.arrays import Array, Booleans, Integers
from lcs.compiled import kernel, part


@part
def holds(lower: Array, upper: Array, high: Array, x: Array) -> bool:
    """Whether a rule holds on x (n,); a condition on a gap holds."""
    for i in range(x.size):
        if x[i] < lower[i] or x[i] > upper[i] or (x[i] == upper[i] and x[i] != high[i]):
            return False
    return True


@part
def distance(lower: Array, upper: Array, width: Array, x: Array) -> float:
    """From x (n,) to a box, squared, in parts of `width`; a gap is no way off."""
    squared = 0.0
    for i in range(x.size):
        off = max(lower[i] - x[i], x[i] - upper[i])
        if off > 0.0:
            squared += (off / width[i]) ** 2
    return squared


@kernel
def assess(
    lower: Array,
    upper: Array,
    high: Array,
    width: Array,
    action: Integers,
    weight: Array,
    share: Array,
    is_for: Booleans,
    inputs: Array,
    belief: Array,
    far: Array,
) -> None:
    """Write belief (T, A), NaN where no rule holds, and far (T, A) for inputs (T, n).

    share (R,): how probable the action is by a rule. is_for (R,): whether it is for the action.
    belief: the mean share of the rules that hold, by their weight. far: to the nearest for it.
    """
    total = np.zeros(belief.shape[1])
    for t in range(inputs.shape[0]):
        x = inputs[t]
        belief[t] = 0.0
        total[:] = 0.0
        for k in range(action.size):
            if holds(lower[k], upper[k], high, x):
                belief[t, action[k]] += weight[k] * share[k]
                total[action[k]] += weight[k]
        belief[t] /= total
        far[t] = np.inf
        if total.min() > 0.0:
            continue
        for k in range(action.size):
            if is_for[k] and total[action[k]] == 0.0:
                squared = distance(lower[k], upper[k], width, x)
                far[t, action[k]] = min(far[t, action[k]], squared)
        far[t] = np.sqrt(far[t])

"""What the action set learns of a payoff, and how its most general member takes others in."""

import numpy as np

from lcs.compiled import part
from lcs.xcsr.kernels.deleting import remove
from lcs.xcsr.kernels.layout import ACTING, Classifiers, Numbers, Scratch, Space

LEAST_ACCURACY = 1e-100


@part
def update(them: Classifiers, numbers: Numbers, scratch: Scratch, payoff: float) -> None:
    """Move all of [A] towards what came."""
    acting = scratch.sets[ACTING, : scratch.sizes[ACTING]]
    size, total = 0, 0.0
    for k in acting:
        size += them.numerosity[k]
    for j in range(acting.size):
        k = acting[j]
        them.experience[k] += 1
        rate = max(numbers.beta, 1.0 / them.experience[k])
        them.prediction[k] += rate * (payoff - them.prediction[k])
        missed = abs(payoff - them.prediction[k])
        them.error[k] += rate * (missed - them.error[k])
        them.set_size[k] += rate * (size - them.set_size[k])
        is_right = missed < numbers.epsilon_0
        them.right[k] += is_right
        them.wrong[k] += not is_right
        scratch.shares[j] = accuracy(them, numbers, k) * them.numerosity[k]
        total += scratch.shares[j]
    for j in range(acting.size):
        k = acting[j]
        them.fitness[k] += numbers.beta * (scratch.shares[j] / total - them.fitness[k])


@part
def accuracy(them: Classifiers, numbers: Numbers, k: int) -> float:
    """Accuracy: 1 below epsilon_0, and steeply down beyond."""
    if them.error[k] < numbers.epsilon_0:
        return 1.0
    steep: float = (them.error[k] / numbers.epsilon_0) ** -numbers.nu
    return max(numbers.alpha * steep, LEAST_ACCURACY)


@part
def could_subsume(them: Classifiers, numbers: Numbers, k: int) -> bool:
    """Experienced and accurate."""
    is_old: bool = them.experience[k] > numbers.theta_sub
    return is_old and them.error[k] < numbers.epsilon_0


@part
def subsume_within(them: Classifiers, space: Space, numbers: Numbers, scratch: Scratch) -> None:
    """The widest of [A] that could subsume takes in all within it."""
    widest, most = -1, -np.inf
    for k in scratch.sets[ACTING, : scratch.sizes[ACTING]]:
        if could_subsume(them, numbers, k):
            wide = width(them, space, k)
            if wide > most:
                widest, most = k, wide
    if widest < 0:
        return
    for j in range(scratch.sizes[ACTING] - 1, -1, -1):
        k = scratch.sets[ACTING, j]
        if is_more_general(them, widest, k):
            them.numerosity[widest] += them.numerosity[k]
            remove(them, scratch, k)
            if widest == them.counts[0]:  # it was the last, and took the place of k
                widest = k


@part
def width(them: Classifiers, space: Space, k: int) -> float:
    """The sum of its widths, as shares of the ranges."""
    total = 0.0
    for i in range(space.low.size):
        low, high = space.low[i], space.high[i]
        total += (min(them.upper[i, k], high) - them.lower[i, k]) / (high - low)
    return total


@part
def is_more_general(them: Classifiers, one: int, other: int) -> bool:
    """Whether it holds wherever the other does, and elsewhere."""
    is_equal = True
    for i in range(them.lower.shape[0]):
        if them.lower[i, one] > them.lower[i, other] or them.upper[i, one] < them.upper[i, other]:
            return False
        if them.lower[i, one] != them.lower[i, other] or them.upper[i, one] != them.upper[i, other]:
            is_equal = False
    return not is_equal

"""How a classifier comes into the population and leaves it."""

import numpy as np

from lcs.arrays import Array
from lcs.compiled import part
from lcs.xcsr.kernels.layout import (
    BIRTHS,
    COPIES,
    DEATHS,
    LINES,
    Classifiers,
    Numbers,
    Scratch,
    Space,
)


@part
def append(
    them: Classifiers, space: Space, numbers: Numbers, first: Array, second: Array, a: int
) -> int:
    """Its place, with these genes (n,) and all counts at their start."""
    k = them.counts[LINES]
    them.counts[LINES] += 1
    them.counts[COPIES] += 1
    them.counts[BIRTHS] += 1
    for i in range(first.size):
        them.first[i, k], them.second[i, k] = first[i], second[i]
        them.lower[i, k], them.upper[i, k] = interval(space, numbers, i, first[i], second[i])
    them.action[k] = a
    them.numerosity[k] = 1
    them.experience[k] = 0
    them.right[k] = 0
    them.wrong[k] = 0
    return int(k)


@part
def interval(
    space: Space, numbers: Numbers, i: int, first: float, second: float
) -> tuple[float, float]:
    """Where these genes of input i hold: from the first on, below the second."""
    low, up = first, second
    if numbers.bounds == 0:
        low, up = first - second, first + second
    elif first > second:
        low, up = second, first
    return max(low, space.low[i]), np.inf if up >= space.high[i] else up


@part
def delete(them: Classifiers, numbers: Numbers, scratch: Scratch, rng: np.random.Generator) -> None:
    """Delete copies until N are left; [M] and [A] lose who dies."""
    while them.counts[COPIES] > numbers.most:
        count = them.counts[LINES]
        fitness = 0.0
        for k in range(count):
            fitness += them.fitness[k]
        mean = fitness / them.counts[COPIES]
        total = 0.0
        for k in range(count):
            vote = them.set_size[k] * them.numerosity[k]
            own = them.fitness[k] / them.numerosity[k]
            if them.experience[k] > numbers.theta_del and own < numbers.delta * mean:
                vote *= mean / own
            scratch.shares[k] = vote
            total += vote
        k = on_wheel(scratch.shares[:count], total, rng)
        them.numerosity[k] -= 1
        them.counts[COPIES] -= 1
        if them.numerosity[k] == 0:
            remove(them, scratch, k)


@part
def on_wheel(shares: Array, total: float, rng: np.random.Generator) -> int:
    """One of the places, each with a chance in proportion to its share of `total`."""
    point = rng.random() * total
    passed = 0.0
    for j in range(shares.size):
        passed += shares[j]
        if passed > point:
            return j
    return shares.size - 1


@part
def remove(them: Classifiers, scratch: Scratch, k: int) -> None:
    """Take line k out, of the sets too; the last line takes its place."""
    last = them.counts[LINES] - 1
    them.counts[LINES] = last
    them.counts[DEATHS] += 1
    for which in range(2):
        kept, members = 0, scratch.sets[which]
        for j in range(scratch.sizes[which]):
            if members[j] != k:
                members[kept] = k if members[j] == last else members[j]
                kept += 1
        scratch.sizes[which] = kept
    if k != last:
        place(them, last, k)


@part
def place(them: Classifiers, source: int, target: int) -> None:
    """Copy a line."""
    for i in range(them.first.shape[0]):
        them.first[i, target] = them.first[i, source]
        them.second[i, target] = them.second[i, source]
        them.lower[i, target] = them.lower[i, source]
        them.upper[i, target] = them.upper[i, source]
    them.action[target] = them.action[source]
    them.prediction[target] = them.prediction[source]
    them.error[target] = them.error[source]
    them.fitness[target] = them.fitness[source]
    them.numerosity[target] = them.numerosity[source]
    them.experience[target] = them.experience[source]
    them.set_size[target] = them.set_size[source]
    them.born[target] = them.born[source]
    them.right[target] = them.right[source]
    them.wrong[target] = them.wrong[source]

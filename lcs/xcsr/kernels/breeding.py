"""The genetic algorithm of an action set."""

import numpy as np

from lcs.arrays import Array
from lcs.compiled import part
from lcs.xcsr.kernels.deleting import append, delete, interval, on_wheel
from lcs.xcsr.kernels.layout import (
    ACTING,
    COPIES,
    LINES,
    MATCHED,
    TIME,
    Classifiers,
    Numbers,
    Scratch,
    Space,
)
from lcs.xcsr.kernels.matching import pick
from lcs.xcsr.kernels.updating import could_subsume


@part
def breed(
    them: Classifiers, space: Space, numbers: Numbers, scratch: Scratch, rng: np.random.Generator
) -> None:
    """Two children, if the last birth in [A] is long ago on average; the sets are no more."""
    acting = scratch.sets[ACTING, : scratch.sizes[ACTING]]
    size, born = 0, 0
    for k in acting:
        size += them.numerosity[k]
        born += them.born[k] * them.numerosity[k]
    if size == 0 or them.counts[TIME] - born / size <= numbers.theta_ga:
        return
    for k in acting:
        them.born[k] = them.counts[TIME]
    one = select(them, numbers, scratch, rng)
    other = select(them, numbers, scratch, rng)
    raise_both(them, space, numbers, scratch, one, other, rng)
    scratch.sizes[MATCHED] = 0
    scratch.sizes[ACTING] = 0
    delete(them, numbers, scratch, rng)


@part
def select(them: Classifiers, numbers: Numbers, scratch: Scratch, rng: np.random.Generator) -> int:
    """A parent: by fitness on a wheel, or the fittest copy of a random sample."""
    acting = scratch.sets[ACTING, : scratch.sizes[ACTING]]
    if numbers.selection == 0:
        total = 0.0
        for j in range(acting.size):
            scratch.shares[j] = them.fitness[acting[j]]
            total += scratch.shares[j]
        return int(acting[on_wheel(scratch.shares[: acting.size], total, rng)])
    best, fittest = acting[pick(rng, acting.size)], 0.0
    for k in acting:
        enters = 1.0 - (1.0 - numbers.tau) ** them.numerosity[k]
        if rng.random() < enters and them.fitness[k] / them.numerosity[k] > fittest:
            best, fittest = k, them.fitness[k] / them.numerosity[k]
    return int(best)


@part
def raise_both(
    them: Classifiers,
    space: Space,
    numbers: Numbers,
    scratch: Scratch,
    one: int,
    other: int,
    rng: np.random.Generator,
) -> None:
    """The children of two parents: crossed, changed and inserted."""
    prediction = them.prediction[one], them.prediction[other]
    error = them.error[one], them.error[other]
    fitness = (
        them.fitness[one] / them.numerosity[one],
        them.fitness[other] / them.numerosity[other],
    )
    for i in range(space.low.size):
        scratch.first[0, i], scratch.second[0, i] = them.first[i, one], them.second[i, one]
        scratch.first[1, i], scratch.second[1, i] = them.first[i, other], them.second[i, other]
    if rng.random() < numbers.chi:
        cross(scratch.first, scratch.second, rng)
        shared = (prediction[0] + prediction[1]) / 2.0
        prediction = shared, shared
        shared = (error[0] + error[1]) / 2.0
        error = shared, shared
        shared = (fitness[0] + fitness[1]) / 2.0
        fitness = shared, shared
    for c in range(2):
        parent = one if c == 0 else other
        first, second = scratch.first[c], scratch.second[c]
        mutate(space, numbers, first, second, rng)
        a = mutated_action(numbers, scratch.votes.size, them.action[parent], rng)
        if is_taken_in(them, space, numbers, one, other, first, second, a):
            continue
        k = append(them, space, numbers, first, second, a)
        them.prediction[k] = prediction[c]
        them.error[k] = error[c] * 0.25
        them.fitness[k] = fitness[c] * 0.1
        them.set_size[k] = them.set_size[parent]
        them.born[k] = them.counts[TIME]


@part
def cross(first: Array, second: Array, rng: np.random.Generator) -> None:
    """Exchange the genes (2, n) between two points, which may lie within an interval."""
    genes = 2 * first.shape[1]
    start, end = pick(rng, genes + 1), pick(rng, genes + 1)
    for at in range(min(start, end), max(start, end)):
        i = at // 2
        if at % 2 == 0:
            first[0, i], first[1, i] = first[1, i], first[0, i]
        else:
            second[0, i], second[1, i] = second[1, i], second[0, i]


@part
def mutate(
    space: Space, numbers: Numbers, first: Array, second: Array, rng: np.random.Generator
) -> None:
    """A step in each gene (n,) with the chance mu, and back into the range."""
    for i in range(first.size):
        low, high = space.low[i], space.high[i]
        least, most = low, high
        if numbers.bounds == 0:
            least, most = 0.0, high - low
        if rng.random() < numbers.mu:
            step = (2.0 * rng.random() - 1.0) * numbers.m_0 * (high - low)
            first[i] = min(max(first[i] + step, low), high)
        if rng.random() < numbers.mu:
            step = (2.0 * rng.random() - 1.0) * numbers.m_0 * (high - low)
            second[i] = min(max(second[i] + step, least), most)
        if numbers.bounds == 1 and first[i] > second[i]:
            first[i], second[i] = second[i], first[i]


@part
def mutated_action(numbers: Numbers, actions: int, a: int, rng: np.random.Generator) -> int:
    """Another action with the chance mu, else a."""
    if actions > 1 and rng.random() < numbers.mu:
        other = pick(rng, actions - 1)
        return other + 1 if other >= a else other
    return a


@part
def is_taken_in(
    them: Classifiers,
    space: Space,
    numbers: Numbers,
    one: int,
    other: int,
    first: Array,
    second: Array,
    a: int,
) -> bool:
    """Whether a parent subsumes these genes (n,) with action a, or an equal one is there."""
    if numbers.ga_subsumption:
        for parent in (one, other):
            if (
                them.action[parent] == a
                and could_subsume(them, numbers, parent)
                and is_within(them, space, numbers, parent, first, second)
            ):
                them.numerosity[parent] += 1
                them.counts[COPIES] += 1
                return True
    for k in range(them.counts[LINES]):
        if (
            them.first[0, k] == first[0]
            and them.action[k] == a
            and is_equal(them, k, first, second)
        ):
            them.numerosity[k] += 1
            them.counts[COPIES] += 1
            return True
    return False


@part
def is_within(
    them: Classifiers, space: Space, numbers: Numbers, k: int, first: Array, second: Array
) -> bool:
    """Whether line k holds wherever these genes (n,) do, and elsewhere."""
    is_same = True
    for i in range(first.size):
        low, up = interval(space, numbers, i, first[i], second[i])
        if them.lower[i, k] > low or them.upper[i, k] < up:
            return False
        if them.lower[i, k] != low or them.upper[i, k] != up:
            is_same = False
    return not is_same


@part
def is_equal(them: Classifiers, k: int, first: Array, second: Array) -> bool:
    """Whether line k has these genes (n,)."""
    for i in range(first.size):
        if them.first[i, k] != first[i] or them.second[i, k] != second[i]:
            return False
    return True

"""Where conditions hold, the match set, the prediction array and the action."""

import numpy as np

from lcs.arrays import Array
from lcs.compiled import part
from lcs.xcsr.kernels.deleting import append, delete
from lcs.xcsr.kernels.layout import (
    ACTING,
    LINES,
    MATCHED,
    TIME,
    Classifiers,
    Numbers,
    Scratch,
    Space,
)


@part
def pick(rng: np.random.Generator, count: int) -> int:
    """One of so many, at random."""
    return int(rng.random() * count)


@part
def match(
    them: Classifiers,
    space: Space,
    numbers: Numbers,
    scratch: Scratch,
    x: Array,
    rng: np.random.Generator,
) -> bool:
    """Fill [M], covering while it has too few actions; whether it had. [A] loses who dies."""
    find(them, scratch, x)
    actions = scratch.votes.size
    asked = numbers.theta_mna if numbers.theta_mna > 0 else actions
    was_covered = False
    while True:
        unknown = actions_without(them, scratch)
        if actions - unknown >= asked:
            return was_covered
        a = scratch.actions[pick(rng, unknown)]
        cover(them, space, numbers, scratch, x, a, rng)
        delete(them, numbers, scratch, rng)
        was_covered = True


@part
def find(them: Classifiers, scratch: Scratch, x: Array) -> None:
    """Fill [M] with those whose condition holds on x (n,)."""
    count, holds = them.counts[LINES], scratch.holds
    for i in range(x.size):
        at, lower, upper = x[i], them.lower[i], them.upper[i]
        if i == 0:
            for k in range(count):
                holds[k] = (lower[k] <= at) & (at < upper[k])
        else:
            for k in range(count):
                holds[k] &= (lower[k] <= at) & (at < upper[k])
    found, matched = 0, scratch.sets[MATCHED]
    for k in range(count):
        matched[found] = k
        found += holds[k]
    scratch.sizes[MATCHED] = found


@part
def actions_without(them: Classifiers, scratch: Scratch) -> int:
    """How many actions nobody in [M] has; they are the first of `scratch.actions`."""
    for a in range(scratch.totals.size):
        scratch.totals[a] = 0.0
    for k in scratch.sets[MATCHED, : scratch.sizes[MATCHED]]:
        scratch.totals[them.action[k]] = 1.0
    unknown = 0
    for a in range(scratch.totals.size):
        if scratch.totals[a] == 0.0:
            scratch.actions[unknown] = a
            unknown += 1
    return unknown


@part
def cover(
    them: Classifiers,
    space: Space,
    numbers: Numbers,
    scratch: Scratch,
    x: Array,
    a: int,
    rng: np.random.Generator,
) -> None:
    """Cover x (n,) by a classifier of action a, which joins [M]."""
    first, second = scratch.first[0], scratch.second[0]
    for i in range(x.size):
        low, high = space.low[i], space.high[i]
        is_free = numbers.p_hash > 0.0 and rng.random() < numbers.p_hash
        reach = numbers.s_0 * (high - low)
        if numbers.bounds == 0:
            first[i] = x[i]
            second[i] = high - low if is_free else rng.random() * reach
        else:
            first[i] = low if is_free else max(x[i] - rng.random() * reach, low)
            second[i] = high if is_free else min(x[i] + rng.random() * reach, high)
    k = append(them, space, numbers, first, second, a)
    them.prediction[k] = numbers.prediction
    them.error[k] = numbers.error
    them.fitness[k] = numbers.fitness
    them.set_size[k] = 1.0
    them.born[k] = them.counts[TIME]
    scratch.sets[MATCHED, scratch.sizes[MATCHED]] = k
    scratch.sizes[MATCHED] += 1


@part
def predict(them: Classifiers, scratch: Scratch) -> None:
    """The prediction array: means weighed by fitness, NaN for actions that [M] has not."""
    votes, totals = scratch.votes, scratch.totals
    for a in range(votes.size):
        votes[a] = 0.0
        totals[a] = 0.0
    for k in scratch.sets[MATCHED, : scratch.sizes[MATCHED]]:
        a = them.action[k]
        votes[a] += them.prediction[k] * them.fitness[k]
        totals[a] += them.fitness[k]
    for a in range(votes.size):
        votes[a] = votes[a] / totals[a] if totals[a] > 0.0 else np.nan


@part
def highest(scratch: Scratch) -> float:
    """Of the prediction array, without its NaNs."""
    best = -np.inf
    for each in scratch.votes:
        if each > best:  # noqa: PLR1730  of NaN and a number `max` may be either
            best = each
    return best


@part
def best_of(scratch: Scratch, rng: np.random.Generator) -> int:
    """The action with the highest prediction; of several, one at random."""
    best, most = 0, highest(scratch)
    for a in range(scratch.votes.size):
        if scratch.votes[a] == most:
            scratch.actions[best] = a
            best += 1
    chosen: int = scratch.actions[0 if best == 1 else pick(rng, best)]
    return chosen


@part
def any_of(them: Classifiers, scratch: Scratch, rng: np.random.Generator) -> int:
    """One of the actions of [M], at random."""
    actions_without(them, scratch)
    known = 0
    for a in range(scratch.totals.size):
        if scratch.totals[a] > 0.0:
            scratch.actions[known] = a
            known += 1
    chosen: int = scratch.actions[pick(rng, known)]
    return chosen


@part
def act_on(them: Classifiers, scratch: Scratch, a: int) -> None:
    """Fill [A]: those of [M] that have action a."""
    count = 0
    for k in scratch.sets[MATCHED, : scratch.sizes[MATCHED]]:
        if them.action[k] == a:
            scratch.sets[ACTING, count] = k
            count += 1
    scratch.sizes[ACTING] = count

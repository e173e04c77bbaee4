"""The operating cycle, once or over many inputs."""

import numpy as np

from lcs.arrays import Array, Integers
from lcs.compiled import kernel, part
from lcs.kernels.kinds import FORCED, TEST, TRIED
from lcs.xcsr.kernels.breeding import breed
from lcs.xcsr.kernels.deleting import delete
from lcs.xcsr.kernels.layout import (
    ACTING,
    BIRTHS,
    DEATHS,
    LINES,
    TIME,
    Classifiers,
    Numbers,
    Scratch,
    Space,
)
from lcs.xcsr.kernels.matching import (
    act_on,
    actions_without,
    any_of,
    best_of,
    cover,
    find,
    highest,
    match,
    predict,
)
from lcs.xcsr.kernels.updating import subsume_within, update


@part
def choose(
    them: Classifiers,
    space: Space,
    numbers: Numbers,
    scratch: Scratch,
    x: Array,
    rng: np.random.Generator,
) -> tuple[int, int]:
    """The action on x (n,), whose set is [A], and whether it is `TEST`, `TRIED` or `FORCED`."""
    was_covered = match(them, space, numbers, scratch, x, rng)
    if was_covered or rng.random() < numbers.explore:
        a, kind = any_of(them, scratch, rng), FORCED if was_covered else TRIED
    else:
        predict(them, scratch)
        a, kind = best_of(scratch, rng), TEST
    act_on(them, scratch, a)
    return a, kind


@kernel
def act(
    them: Classifiers,
    space: Space,
    numbers: Numbers,
    scratch: Scratch,
    x: Array,
    rng: np.random.Generator,
) -> tuple[int, int]:
    """The action on x (n,), and whether it is `TEST`, `TRIED` or `FORCED`."""
    return choose(them, space, numbers, scratch, x, rng)


@part
def take(
    them: Classifiers,
    space: Space,
    numbers: Numbers,
    scratch: Scratch,
    payoff: float,
    rng: np.random.Generator,
) -> None:
    """What [A] makes of a payoff."""
    update(them, numbers, scratch, payoff)
    if numbers.action_set_subsumption:
        subsume_within(them, space, numbers, scratch)
    breed(them, space, numbers, scratch, rng)


@kernel
def learn(
    them: Classifiers,
    space: Space,
    numbers: Numbers,
    scratch: Scratch,
    reward: float,
    following: Array,
    rng: np.random.Generator,
) -> None:
    """The reward of [A], and the input that follows it: one (1, n), or none (0, n)."""
    them.counts[TIME] += 1
    payoff = reward
    if following.shape[0] > 0:
        match(them, space, numbers, scratch, following[0], rng)
        predict(them, scratch)
        payoff += numbers.gamma * highest(scratch)
    take(them, space, numbers, scratch, payoff, rng)


@kernel
def run(
    them: Classifiers,
    space: Space,
    numbers: Numbers,
    scratch: Scratch,
    inputs: Array,
    rewards: Array,
    told: Integers,
    errors: Array,
    rng: np.random.Generator,
) -> None:
    """Cycles on inputs (T, n) with rewards (T, A).

    told (T, 5): `TEST`, `TRIED` or `FORCED`; the action; rules; births; deaths so far.
    errors (T,): of a test |expected - reward|, else NaN.
    """
    for t in range(inputs.shape[0]):
        a, kind = choose(them, space, numbers, scratch, inputs[t], rng)
        errors[t] = np.nan
        if kind == TEST:
            errors[t] = abs(scratch.votes[a] - rewards[t, a])
        else:
            them.counts[TIME] += 1
            take(them, space, numbers, scratch, rewards[t, a], rng)
        told[t, 0] = kind
        told[t, 1] = a
        told[t, 2] = them.counts[LINES]
        told[t, 3] = them.counts[BIRTHS]
        told[t, 4] = them.counts[DEATHS]


@kernel
def teach(
    them: Classifiers,
    space: Space,
    numbers: Numbers,
    scratch: Scratch,
    inputs: Array,
    rewards: Array,
    rng: np.random.Generator,
) -> None:
    """For each input (T, n) a try of each action in turn, with rewards (T, A)."""
    for t in range(inputs.shape[0]):
        for a in range(rewards.shape[1]):
            match(them, space, numbers, scratch, inputs[t], rng)
            act_on(them, scratch, a)
            while scratch.sizes[ACTING] == 0:
                cover(them, space, numbers, scratch, inputs[t], a, rng)
                delete(them, numbers, scratch, rng)
                act_on(them, scratch, a)
            them.counts[TIME] += 1
            take(them, space, numbers, scratch, rewards[t, a], rng)


@kernel
def decide(
    them: Classifiers,
    scratch: Scratch,
    inputs: Array,
    actions: Integers,
    expected: Array,
    rng: np.random.Generator,
) -> None:
    """The best action (T,) for inputs (T, n), -1 where one is not covered; expected (T, A)."""
    for t in range(inputs.shape[0]):
        find(them, scratch, inputs[t])
        unknown = actions_without(them, scratch)
        predict(them, scratch)
        for a in range(scratch.votes.size):
            expected[t, a] = scratch.votes[a]
        actions[t] = -1 if unknown > 0 else best_of(scratch, rng)

"""What actions are worth, fitted to steps that were lived: an average of trees for each action."""

from typing import NamedTuple

import numpy as np

from lcs.arrays import Array, Booleans, Indices, Integers
from lcs.compiled import kernel, part
from lcs.policies.kernels.trees import grow_tree, leaf_at, seedlings

ROUNDS = 1_000
"""Rounds of settling at most."""
NEAR = 1e-4
"""Expectations have settled when a round changes none by more than this, of their range."""


class Lived(NamedTuple):
    """N steps of all episodes; see `lcs.policies.steps.Steps`.

    discount (N,): what a reward right after each is worth.
    """

    x: Array
    action: Integers
    reward: Array
    after: Array
    ends: Booleans
    discount: Array


class Numbers(NamedTuple):
    """actions: how many; families: trees for each; fed: steps that a leaf needs, at least.

    generations: how often trees grow, from what those before expected.
    """

    actions: int
    families: int
    fed: int
    generations: int


@part
def value(lived: Lived, then: Array, target: Array) -> None:
    """What each step led to: its reward, and the best of what is expected after it, (A, N)."""
    for k in range(target.size):
        target[k] = lived.reward[k]
        if not lived.ends[k]:
            best = -np.inf
            for a in range(len(then)):
                best = max(best, then[a, k])
            target[k] += lived.discount[k] * best


@part
def digest(own: Integers, leaves: Indices, target: Array, expected: Array) -> float:
    """Each leaf expects (F, M) the mean of what its steps, `own`, led to; the largest change."""
    change = 0.0
    for f in range(expected.shape[0]):
        total, count = np.zeros(expected.shape[1]), np.zeros(expected.shape[1])
        for k in own:
            total[leaves[f, k]] += target[k]
            count[leaves[f, k]] += 1.0
        for leaf in range(count.size):
            if count[leaf] > 0.0:
                mean = total[leaf] / count[leaf]
                change = max(change, abs(mean - expected[f, leaf]))
                expected[f, leaf] = mean
    return change


@part
def means(leaves: Indices, expected: Array, worth: Array) -> None:
    """What the trees expect together where they have these leaves (F, N), as (N,)."""
    worth[:] = 0.0
    for f in range(len(leaves)):
        for k in range(worth.size):
            worth[k] += expected[f, leaves[f, k]]
    worth /= len(leaves)


@part
def grow_all(
    lived: Lived,
    numbers: Numbers,
    target: Array,
    leaves: tuple[Indices, Indices],
    chance: np.random.Generator,
) -> None:
    """New trees for what each step led to; which leaves hold x and after, (A, F, N) each."""
    here, there = leaves
    for a in range(numbers.actions):
        own = np.flatnonzero(lived.action == a)
        trees = seedlings(numbers.families, own.size, numbers.fed)
        x, led_to = lived.x[own], target[own]
        for f in range(numbers.families):
            if own.size:
                grow_tree(trees, f, x, led_to, numbers.fed, chance)
            for k in range(target.size):
                here[a, f, k] = leaf_at(trees, f, lived.x[k])
                there[a, f, k] = leaf_at(trees, f, lived.after[k])


@part
def settle(
    lived: Lived,
    target: Array,
    leaves: tuple[Indices, Indices],
    expected: Array,
) -> None:
    """Let what leaves expect (A, F, M), and what steps led to, agree.

    Means of means weigh all with shares that sum to one, so a round brings any two sets of
    expectations nearer to each other by the discount (Gordon 1995).
    """
    here, there = leaves
    then = np.full((len(expected), target.size), -np.inf)
    for _ in range(ROUNDS):
        change = 0.0
        for a in range(len(expected)):
            own = np.flatnonzero(lived.action == a)
            if own.size:
                change = max(change, digest(own, here[a], target, expected[a]))
                means(there[a], expected[a], then[a])
        value(lived, then, target)
        if change <= NEAR * (target.max() - target.min()):
            return


@kernel
def fitted(lived: Lived, numbers: Numbers, chance: np.random.Generator) -> Array:
    """What each action is worth at each of the steps' places, (A, N); -inf if it was never taken.

    Trees grow for what was expected last; then what they expect settles.
    """
    target = lived.reward.copy()
    worth = np.full((numbers.actions, target.size), -np.inf)
    expected = np.zeros((numbers.actions, numbers.families, 2 * (target.size // numbers.fed) + 3))
    here = np.zeros((numbers.actions, numbers.families, target.size), np.int32)
    leaves = here, np.zeros_like(here)
    for _ in range(numbers.generations):
        grow_all(lived, numbers, target, leaves, chance)
        settle(lived, target, leaves, expected)
    for a in range(numbers.actions):
        if (lived.action == a).any():
            means(here[a], expected[a], worth[a])
    return worth

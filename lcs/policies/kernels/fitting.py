"""What actions are worth, fitted to steps that were lived: an average of trees for each action."""

from typing import NamedTuple

import numpy as np

from lcs.arrays import Array, Booleans, Integers
from lcs.compiled import kernel, part
from lcs.policies.kernels.trees import grow_tree, leaf_at, seedlings

ROUNDS = 1_000
"""Rounds of settling at most."""
NEAR = 1e-4
"""Expectations have settled when a round changes none by more than this, of their range."""


class Lived(NamedTuple):
    """N steps of all episodes; see `lcs.policies.steps.Steps`."""

    x: Array
    action: Integers
    reward: Array
    after: Array
    ends: Booleans


class Numbers(NamedTuple):
    """actions: how many; families: trees for each; fed: steps that a leaf needs, at least.

    generations: how often trees grow, from what those before expected.
    """

    actions: int
    families: int
    fed: int
    generations: int
    discount: float


@part
def value(lived: Lived, discount: float, then: Array, target: Array) -> None:
    """What each step led to: its reward, and the best of what is expected after it, (A, N)."""
    for k in range(target.size):
        target[k] = lived.reward[k]
        if not lived.ends[k]:
            best = -np.inf
            for a in range(len(then)):
                best = max(best, then[a, k])
            target[k] += discount * best


@part
def digest(own: Integers, leaves: Integers, target: Array, expected: Array) -> float:
    """Each leaf expects (F, M) the mean of what its steps, `own`, led to; the largest change."""
    change = 0.0
    for f in range(expected.shape[0]):
        total, count = np.zeros(expected.shape[1]), np.zeros(expected.shape[1])
        for k in own:
            total[leaves[k, f]] += target[k]
            count[leaves[k, f]] += 1.0
        for leaf in range(count.size):
            if count[leaf] > 0.0:
                mean = total[leaf] / count[leaf]
                change = max(change, abs(mean - expected[f, leaf]))
                expected[f, leaf] = mean
    return change


@part
def means(leaves: Integers, expected: Array, worth: Array) -> None:
    """What the trees expect together where they have these leaves (N, F), as (N,)."""
    for k in range(worth.size):
        total = 0.0
        for f in range(leaves.shape[1]):
            total += expected[f, leaves[k, f]]
        worth[k] = total / leaves.shape[1]


@kernel
def fitted(lived: Lived, numbers: Numbers, chance: np.random.Generator) -> Array:
    """What each action is worth at each of the steps' places, (A, N); -inf if it was never taken.

    Trees grow for what was expected last; then what they expect settles: means of means weigh all
    with shares that sum to one, so a round brings any two sets of expectations nearer to each
    other by the discount (Gordon 1995).
    """
    count, n = lived.x.shape
    target = lived.reward.copy()
    worth, then = np.empty((numbers.actions, count)), np.empty((numbers.actions, count))
    here = np.zeros((numbers.actions, count, numbers.families), np.int64)
    there = np.zeros((numbers.actions, count, numbers.families), np.int64)
    expected = np.zeros((numbers.actions, numbers.families, 2 * (count // numbers.fed) + 3))
    for _ in range(numbers.generations):
        for a in range(numbers.actions):
            own = np.flatnonzero(lived.action == a)
            trees = seedlings(numbers.families, own.size, numbers.fed)
            x, led_to = lived.x[own], target[own]
            for f in range(numbers.families):
                if own.size:
                    grow_tree(trees, f, x, led_to, numbers.fed, chance)
                for k in range(count):
                    here[a, k, f] = leaf_at(trees, f, lived.x[k])
                    there[a, k, f] = leaf_at(trees, f, lived.after[k])
        for _ in range(ROUNDS):
            change = 0.0
            for a in range(numbers.actions):
                own = np.flatnonzero(lived.action == a)
                change = max(change, digest(own, here[a], target, expected[a]))
                means(there[a], expected[a], then[a])
                if own.size == 0:
                    then[a] = -np.inf
            value(lived, numbers.discount, then, target)
            if change <= NEAR * (target.max() - target.min()):
                break
    for a in range(numbers.actions):
        means(here[a], expected[a], worth[a])
        if not (lived.action == a).any():
            worth[a] = -np.inf
    return worth

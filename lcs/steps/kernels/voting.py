"""What is expected of the actions at a place, and which is taken."""

import numpy as np

from lcs.arrays import Array, Integers
from lcs.compiled import kernel, part
from lcs.steps.kernels.layout import Bodies, Land


@part
def body_at(bodies: Bodies, family: int, x: Array) -> int:
    """The body of a family that holds a place."""
    for b in range(bodies.first[family], bodies.first[family + 1]):
        is_in = True
        for i in range(x.size):
            if x[i] < bodies.lower[b, i] or x[i] >= bodies.upper[b, i]:
                is_in = False
                break
        if is_in:
            return b
    return -1


@part
def best_worth(bodies: Bodies, holders: Integers, worth: Array) -> float:
    """What each action is worth (A,) by the mean of its holders, -inf if unknown; the best."""
    best = -np.inf
    for a in range(worth.size):
        total, voters = 0.0, 0
        for b in holders:
            if bodies.meals[b, a] > 0:
                total += bodies.expected[b, a]
                voters += 1
        worth[a] = total / voters if voters > 0 else -np.inf
        best = max(best, worth[a])
    return best


@part
def chosen(bodies: Bodies, x: Array, chance: np.random.Generator, worth: Array) -> int:
    """The action that is worth most at a place; of equal ones any, of unknown ones too."""
    holders = np.empty(bodies.first.size - 1, np.int64)
    for family in range(holders.size):
        holders[family] = body_at(bodies, family, x)
    best = best_worth(bodies, holders, worth)
    taken, equal = 0, 0
    for a in range(worth.size):
        if worth[a] == best:
            equal += 1
            if chance.random() * equal < 1.0:
                taken = a
    return taken


@part
def tried(
    bodies: Bodies, x: Array, explore: float, chance: np.random.Generator, worth: Array
) -> int:
    """With the chance `explore` any action a, to be remembered; else the best one, as -1 - a."""
    if chance.random() < explore:
        return int(chance.random() * worth.size)
    return -1 - chosen(bodies, x, chance, worth)


@part
def remember(
    land: Land,
    x: Array,
    action: int,
    reward: float,
    after: Array,
    ends: bool,  # noqa: FBT001 numba knows no keyword-only arguments
    chance: np.random.Generator,
) -> None:
    """Keep a step; where there is no room, so that each step ever made is kept equally likely.

    Source: Vitter (1985), algorithm R.
    """
    seen = land.seen[0]
    at = seen if seen < land.action.size else int(chance.random() * (seen + 1))
    land.seen[0] = seen + 1
    if at < land.action.size:
        land.x[at], land.after[at] = x, after
        land.action[at], land.reward[at], land.ends[at] = action, reward, ends


@kernel
def try_once(bodies: Bodies, x: Array, explore: float, chance: np.random.Generator) -> int:
    """`tried`, for Python."""
    return tried(bodies, x, explore, chance, np.empty(bodies.meals.shape[1]))


@kernel
def remember_once(
    land: Land,
    x: Array,
    action: int,
    reward: float,
    after: Array,
    ends: bool,  # noqa: FBT001 numba knows no keyword-only arguments
    chance: np.random.Generator,
) -> None:
    """`remember`, for Python."""
    remember(land, x, action, reward, after, ends, chance)


@kernel
def decide(
    bodies: Bodies, x: Array, actions: Integers, worth: Array, chance: np.random.Generator
) -> None:
    """The best actions (T,) at places (T, n), and what all are worth there (T, A)."""
    for t in range(len(x)):
        actions[t] = chosen(bodies, x[t], chance, worth[t])

"""Bodies grown anew from what the land remembers, and what they expect, settled."""

import numpy as np

from lcs.arrays import Array, Integers
from lcs.compiled import kernel, part
from lcs.steps.kernels.dividing import divide
from lcs.steps.kernels.layout import Bodies, Land, Numbers
from lcs.steps.kernels.voting import best_worth, body_at

ROUNDS = 1_000
"""Rounds of settling at most."""
NEAR = 1e-6
"""Expectations have settled when a round changes none by more than this, of their range."""


@part
def holders_of(bodies: Bodies, places: Array, count: int) -> Integers:
    """The bodies that hold each place, one of each family (count, F)."""
    found = np.empty((count, bodies.first.size - 1), np.int64)
    for k in range(count):
        for family in range(bodies.first.size - 1):
            found[k, family] = body_at(bodies, family, places[k])
    return found


@part
def value(land: Land, bodies: Bodies, holders: Integers, discount: float, target: Array) -> None:
    """What each remembered step led to: its reward, and the best that is expected after it."""
    worth = np.empty(bodies.meals.shape[1])
    for k in range(target.size):
        target[k] = land.reward[k]
        if not land.ends[k]:
            after = best_worth(bodies, holders[k], worth)
            if after > -np.inf:
                target[k] += discount * after


@part
def digest(land: Land, bodies: Bodies, holders: Integers, target: Array) -> float:
    """Each body expects the mean of what its memories led to; the largest change."""
    total = np.zeros_like(bodies.expected)
    for k in range(target.size):
        for b in holders[k]:
            total[b, land.action[k]] += target[k]
    change = 0.0
    for b in range(len(total)):
        for a in range(bodies.meals.shape[1]):
            if bodies.meals[b, a] > 0:
                mean = total[b, a] / bodies.meals[b, a]
                change = max(change, abs(mean - bodies.expected[b, a]))
                bodies.expected[b, a] = mean
    return change


@part
def settle(land: Land, bodies: Bodies, discount: float, target: Array) -> int:
    """Value and digest until nothing changes; how many rounds.

    Means of means weigh all with shares that sum to one, so a round brings any two sets of
    expectations nearer to each other by `discount` (Gordon 1995): they can't run away or swing.
    """
    at, after = holders_of(bodies, land.x, target.size), holders_of(bodies, land.after, target.size)
    digest(land, bodies, at, target)
    for done in range(ROUNDS):
        value(land, bodies, after, discount, target)
        span = target.max() - target.min()
        if digest(land, bodies, at, target) <= NEAR * span:
            return done + 1
    return ROUNDS


@part
def born(
    land: Land, target: Array, numbers: Numbers, actions: int, chance: np.random.Generator
) -> Bodies:
    """The families that the memories divide into, each by chance of its own."""
    count, n = target.size, land.x.shape[1]
    most = count // (numbers.fed * actions) + 2
    lower, upper = np.empty((0, n)), np.empty((0, n))
    first = np.zeros(numbers.families + 1, np.int64)
    room_lower, room_upper = np.empty((most, n)), np.empty((most, n))
    for family in range(numbers.families):
        found = divide(land, target, numbers.fed, room_lower, room_upper, actions, chance)
        lower = np.concatenate((lower, room_lower[:found]))
        upper = np.concatenate((upper, room_upper[:found]))
        first[family + 1] = len(lower)
    meals = np.zeros((len(lower), actions), np.int64)
    return Bodies(lower, upper, meals, np.zeros((len(lower), actions)), first)


@part
def feed(land: Land, bodies: Bodies, count: int) -> None:
    """Count how many memories of each action a body holds."""
    holders = holders_of(bodies, land.x, count)
    for k in range(count):
        for b in holders[k]:
            bodies.meals[b, land.action[k]] += 1


@kernel
def grow(land: Land, before: Bodies, numbers: Numbers, chance: np.random.Generator) -> Bodies:
    """New bodies, from what those before expect of the places that memories lead to."""
    count = min(land.seen[0], land.action.size)
    target = land.reward[:count].copy()
    value(land, before, holders_of(before, land.after, count), numbers.discount, target)
    bodies = before
    for _ in range(numbers.generations):
        bodies = born(land, target, numbers, before.meals.shape[1], chance)
        feed(land, bodies, count)
        settle(land, bodies, numbers.discount, target)
    return bodies

"""Genetic generalization pressure (4.3.4): pools of neighbors, and what is born in them."""

import numpy as np

from lcs.alcsr.kernels.burying import insert
from lcs.alcsr.kernels.covering import clear
from lcs.alcsr.kernels.layout import BRED, POOL, SEED, Land, Numbers, Rules, Scratch
from lcs.alcsr.kernels.matching import can_breed, is_mature, pick, volume_of
from lcs.compiled import part

BEYOND = 0.1
"""By how much of its width a hull may be moved out, where a reading has it so."""


@part
def breed(
    rules: Rules,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    a: int,
    rng: np.random.Generator,
) -> bool:
    """Breed around each rule fed that may start a pool; False where there is no room for more.

    Called again with more room it goes on where it stood (`scratch.progress`).
    """
    progress = scratch.progress
    while progress[SEED] < scratch.fed_count[a]:
        seed = scratch.fed[a, progress[SEED]]
        if progress[POOL] == 0 and starts_pool(rules, numbers, a, seed):
            progress[POOL] = form_pool(rules, numbers, scratch, a, seed)
        if progress[POOL] > 0 and not breed_in_pool(rules, land, numbers, scratch, a, rng):
            return False
        progress[POOL] = 0
        progress[SEED] += 1
    progress[SEED] = 0
    return True


@part
def starts_pool(rules: Rules, numbers: Numbers, a: int, k: int) -> bool:
    """Whether a pool forms around rule k, if there are enough others."""
    if numbers.seeds_are == 1 and rules.was_able[a, k]:
        return False
    return is_mature(rules, numbers, a, k) and can_breed(rules, numbers, a, k)


@part
def form_pool(rules: Rules, numbers: Numbers, scratch: Scratch, a: int, seed: int) -> int:
    """The seed and its nearest neighbors in `scratch.pool`; how many."""
    found = 0
    lower, upper = rules.lower[a], rules.upper[a]
    n = lower.shape[1]
    for k in range(rules.living[a]):
        other = rules.prediction[a, k] != rules.prediction[a, seed]
        if k == seed or (numbers.neighbors_are == 1 and other):
            continue
        far = scratch.distance[found - 1] if found == numbers.breeding_neighbors else np.inf
        squared = 0.0
        for i in range(n):
            apart = 0.5 * (lower[k, i] + upper[k, i]) - 0.5 * (lower[seed, i] + upper[seed, i])
            squared += apart * apart
            if squared >= far:
                break
        found = insert(scratch, found, numbers.breeding_neighbors, k, squared)
    scratch.pool[0] = seed
    for j in range(found):
        scratch.pool[1 + j] = scratch.near[j]
    return 1 + found


@part
def breed_in_pool(
    rules: Rules,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    a: int,
    rng: np.random.Generator,
) -> bool:
    """Breed while enough of the pool are fit for it; False where there is no room for more."""
    size = scratch.progress[POOL]
    asked = 1 + numbers.breeding_neighbors
    if numbers.half_of == 1:
        asked = size
    food = rules.prediction[a, scratch.pool[0]]
    while True:
        able = 0
        for j in range(size):
            k = scratch.pool[j]
            if (
                rules.prediction[a, k] == food
                and is_mature(rules, numbers, a, k)
                and can_breed(rules, numbers, a, k)
            ):
                scratch.able[able] = k
                able += 1
        if able < max(2.0, numbers.breeding_share * asked):
            return True
        if rules.living[a] == rules.prediction.shape[1]:
            return False
        first = pick(rng, able)
        second = pick(rng, able - 1)
        if second >= first:
            second += 1
        bear(rules, land, numbers, scratch, a, scratch.able[first], scratch.able[second], rng)
        if numbers.offspring_in == 1:
            scratch.pool[size] = rules.living[a] - 1
            size += 1
            scratch.progress[POOL] = size


@part
def bear(
    rules: Rules,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    a: int,
    one: int,
    other: int,
    rng: np.random.Generator,
) -> None:
    """An offspring by crossover, mutation and transfer of strength."""
    k = rules.living[a]
    clear(rules, a, k, rules.prediction[a, one])
    cross(rules, land, numbers, a, k, one, other, rng)
    if numbers.mutation_is == 1:
        mutate(rules, land, numbers, a, k, rng)
    while is_duplicate(rules, a, k):
        mutate(rules, land, numbers, a, k, rng)
    rules.volume[a, k] = volume_of(rules.lower[a, k], rules.upper[a, k], land)
    both = rules.volume[a, one] + rules.volume[a, other]
    for parent in (one, other):
        share = rules.volume[a, parent] / both if both > 0.0 else 0.5
        given = min(rules.volume[a, parent], rules.volume[a, k] * share)
        given *= numbers.transfer * numbers.breed_level
        rules.strength[a, parent] -= given
        rules.strength[a, k] += given
    rules.fed_at[a, k] = land.met[a]
    rules.living[a] = k + 1
    scratch.tally[BRED] += 1


@part
def cross(
    rules: Rules,
    land: Land,
    numbers: Numbers,
    a: int,
    k: int,
    one: int,
    other: int,
    rng: np.random.Generator,
) -> None:
    """In each dimension the hull of both, or else a copy of one of them."""
    lower, upper = rules.lower[a], rules.upper[a]
    for i in range(lower.shape[1]):
        if rng.random() < numbers.generalize:
            low = min(lower[one, i], lower[other, i])
            up = max(upper[one, i], upper[other, i])
            if numbers.generalization == 1:
                width = up - low
                low = max(land.low[i], low - rng.random() * BEYOND * width)
                up = min(land.high[i], up + rng.random() * BEYOND * width)
        else:
            parent = one if rng.random() < 0.5 else other
            low, up = lower[parent, i], upper[parent, i]
        lower[k, i] = low
        upper[k, i] = up


@part
def mutate(
    rules: Rules, land: Land, numbers: Numbers, a: int, k: int, rng: np.random.Generator
) -> None:
    """Move each bound, by chance, a little."""
    lower, upper = rules.lower[a, k], rules.upper[a, k]
    for i in range(lower.size):
        low, high = land.low[i], land.high[i]
        if rng.random() < numbers.mutate:
            moved = lower[i] + (2.0 * rng.random() - 1.0) * numbers.mutation * (high - low)
            lower[i] = min(max(moved, low), high)
        if rng.random() < numbers.mutate:
            moved = upper[i] + (2.0 * rng.random() - 1.0) * numbers.mutation * (high - low)
            upper[i] = min(max(moved, low), high)
        if lower[i] > upper[i]:
            lower[i], upper[i] = upper[i], lower[i]


@part
def is_duplicate(rules: Rules, a: int, k: int) -> bool:
    """Whether another rule of the sub-species has the body of rule k, the last."""
    for other in range(k):
        if rules.prediction[a, other] != rules.prediction[a, k]:
            continue
        same = True
        for i in range(rules.lower.shape[2]):
            if (
                rules.lower[a, other, i] != rules.lower[a, k, i]
                or rules.upper[a, other, i] != rules.upper[a, k, i]
            ):
                same = False
                break
        if same:
            return True
    return False

"""A new rule around an input that none covers (4.3.5)."""

import numpy as np

from lcs.alcsr.kernels.burying import nearest_corpses
from lcs.alcsr.kernels.feeding import eat
from lcs.alcsr.kernels.layout import COVERED, Corpses, Land, Numbers, Rules, Scratch
from lcs.alcsr.kernels.matching import volume_of
from lcs.arrays import Array
from lcs.compiled import part


@part
def cover(
    rules: Rules,
    corpses: Corpses,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    a: int,
    x: Array,
    reward: float,
    rng: np.random.Generator,
) -> None:
    """A new rule of landscape a around x (n,)."""
    fractions(corpses, numbers, scratch, a, x, reward)
    k = rules.living[a]
    clear(rules, a, k, reward)
    for i in range(x.size):
        width = land.high[i] - land.low[i]
        low = x[i] - rng.random() * scratch.fractions[0, i] * width
        up = x[i] + rng.random() * scratch.fractions[1, i] * width
        rules.lower[a, k, i] = max(low, land.low[i])
        rules.upper[a, k, i] = min(up, land.high[i])
    rules.volume[a, k] = volume_of(rules.lower[a, k], rules.upper[a, k], land)
    rules.fed_at[a, k] = land.met[a]
    rules.living[a] = k + 1
    scratch.tally[COVERED] += 1
    if numbers.covered_is == 1:
        eat(rules, numbers, a, k, x, reward, 1.0)


@part
def clear(rules: Rules, a: int, k: int, prediction: float) -> None:
    """A newborn in place k: all but its body."""
    rules.prediction[a, k] = prediction
    rules.strength[a, k] = 0.0
    rules.experience[a, k] = 0
    rules.right[a, k] = 0
    rules.wrong[a, k] = 0
    rules.right_center[a, k] = 0.0
    rules.wrong_center[a, k] = 0.0
    rules.damaged[a, k] = False
    rules.was_able[a, k] = False
    rules.fed_at[a, k] = 0
    rules.grows_at[a, k] = 0
    rules.meals[a, k] = 0
    rules.poisoned[a, k] = 0
    rules.core_meals[a, k] = 0
    rules.core_wrong[a, k] = 0


@part
def fractions(
    corpses: Corpses, numbers: Numbers, scratch: Scratch, a: int, x: Array, reward: float
) -> None:
    """Write the cover fractions at x: a half while seeding, later the nearest corpses' vote."""
    count = corpses.buried[a]
    if numbers.seeding_by == 1:
        count = 0
        for k in range(corpses.buried[a]):
            count += corpses.prediction[a, k] == reward
    lower, upper = scratch.fractions[0], scratch.fractions[1]
    if count < numbers.corpses:
        lower[:] = numbers.seeding
        upper[:] = numbers.seeding
        return
    found = nearest_corpses(corpses, numbers, scratch, a, x, reward)
    if scratch.distance[0] == 0.0:
        lower[:] = corpses.lower[a, scratch.near[0]]
        upper[:] = corpses.upper[a, scratch.near[0]]
        return
    lower[:] = 0.0
    upper[:] = 0.0
    total = 0.0
    for j in range(found):
        weight = 1.0 / scratch.distance[j]
        total += weight
        for i in range(x.size):
            lower[i] += weight * corpses.lower[a, scratch.near[j], i]
            upper[i] += weight * corpses.upper[a, scratch.near[j], i]
    for i in range(x.size):
        lower[i] /= total
        upper[i] /= total

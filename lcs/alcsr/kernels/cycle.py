"""The operating cycle, once or over many inputs.

A kernel that has no room for another rule or corpse stops, says so, and is called again with more:
`scratch.progress` keeps where it stood, so that nothing is drawn twice.
"""

import numpy as np

from lcs.alcsr.kernels.breeding import breed
from lcs.alcsr.kernels.covering import cover
from lcs.alcsr.kernels.feeding import die, feed, fight
from lcs.alcsr.kernels.layout import (
    ACTION,
    BRED,
    COVERED,
    POISONED,
    STAGE,
    Corpses,
    Land,
    Numbers,
    Rules,
    Scratch,
)
from lcs.alcsr.kernels.matching import best_of, choose, match, widen
from lcs.arrays import Array, Integers
from lcs.compiled import kernel, part

DIE, FIGHT, BREED = range(3)
ORDERS = ((DIE, FIGHT, BREED), (FIGHT, DIE, BREED), (DIE, BREED, FIGHT))
TEST, TRIED, FORCED = range(3)


@part
def has_room(rules: Rules, corpses: Corpses, scratch: Scratch) -> bool:
    """Whether whatever is fed may die, and an input be covered."""
    for a in range(rules.living.size):
        if rules.living[a] == rules.prediction.shape[1]:
            return False
        if corpses.buried[a] + scratch.fed_count[a] > corpses.prediction.shape[1]:
            return False
    return True


@part
def live_on(
    rules: Rules,
    corpses: Corpses,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    a: int,
    rng: np.random.Generator,
) -> bool:
    """Deaths, fights and births among those fed; False where there is no room for a birth."""
    while scratch.progress[STAGE] < 3:
        what = ORDERS[numbers.order][scratch.progress[STAGE]]
        if what == DIE:
            die(rules, corpses, land, numbers, scratch, a)
        elif what == FIGHT:
            fight(rules, numbers, scratch, a)
        elif not breed(rules, land, numbers, scratch, a, rng):
            return False
        scratch.progress[STAGE] += 1
    return True


@part
def ready(
    rules: Rules, corpses: Corpses, land: Land, numbers: Numbers, scratch: Scratch, x: Array
) -> bool:
    """Look who covers x (n,); False where there is no room for what may follow."""
    widen(rules, land, numbers, x)
    match(rules, land, x, scratch)
    return has_room(rules, corpses, scratch)


@kernel
def begin(
    rules: Rules,
    corpses: Corpses,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    x: Array,
    rng: np.random.Generator,
) -> int:
    """The action on x (n,); -1 - action of a test, A where there is no room."""
    if not ready(rules, corpses, land, numbers, scratch, x):
        return int(rules.living.size)
    a, is_test = choose(rules, numbers, scratch, rng)
    scratch.progress[ACTION] = a
    return -1 - a if is_test else a


@kernel
def learn(
    rules: Rules,
    corpses: Corpses,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    x: Array,
    reward: float,
    rng: np.random.Generator,
) -> bool:
    """What follows the reward of `scratch.progress[ACTION]`; False where there is no room."""
    progress = scratch.progress
    a = progress[ACTION]
    if progress[STAGE] < 0:
        progress[STAGE] = 0
        if scratch.fed_count[a] == 0:
            cover(rules, corpses, land, numbers, scratch, a, x, reward, rng)
            progress[STAGE] = 3
        else:
            feed(rules, numbers, scratch, a, x, reward)
    if not live_on(rules, corpses, land, numbers, scratch, a, rng):
        return False
    progress[STAGE] = -1
    return True


@kernel
def run(
    rules: Rules,
    corpses: Corpses,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    inputs: Array,
    rewards: Array,
    first: int,
    told: Integers,
    errors: Array,
    rng: np.random.Generator,
) -> int:
    """Cycles on inputs (T, n) from `first` on, with rewards (T, A); where it stopped, T at the end.

    told (T, 5): `TEST`, `TRIED` or `FORCED`; the action; rules; births; deaths so far.
    errors (T,): of a test |vote - reward|, else NaN.
    """
    for t in range(first, inputs.shape[0]):
        x = inputs[t]
        if scratch.progress[STAGE] < 0:
            said = begin(rules, corpses, land, numbers, scratch, x, rng)
            if said == rules.living.size:
                return t
            is_test = said < 0
            a = -1 - said if is_test else said
            told[t, 1] = a
            told[t, 0] = TRIED if scratch.fed_count[a] > 0 else FORCED
            errors[t] = np.nan
            if is_test:
                told[t, 0] = TEST
                errors[t] = abs(scratch.votes[a] - rewards[t, a])
        if told[t, 0] != TEST:
            reward = rewards[t, told[t, 1]]
            if not learn(rules, corpses, land, numbers, scratch, x, reward, rng):
                return t
        told[t, 2] = rules.living.sum()
        told[t, 3] = scratch.tally[COVERED] + scratch.tally[BRED]
        told[t, 4] = scratch.tally[POISONED:].sum()
    return len(inputs)


@kernel
def teach(
    rules: Rules,
    corpses: Corpses,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    inputs: Array,
    rewards: Array,
    first: int,
    rng: np.random.Generator,
) -> int:
    """Learn all rewards (T, A) of inputs (T, n) from `first` on; where it stopped, T at the end."""
    progress = scratch.progress
    for t in range(first, inputs.shape[0]):
        x = inputs[t]
        if progress[STAGE] < 0:
            if not ready(rules, corpses, land, numbers, scratch, x):
                return t
            progress[ACTION] = 0
        while progress[ACTION] < rules.living.size:
            reward = rewards[t, progress[ACTION]]
            if not learn(rules, corpses, land, numbers, scratch, x, reward, rng):
                return t
            progress[ACTION] += 1
    return len(inputs)


@kernel
def decide(
    rules: Rules,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    inputs: Array,
    actions: Integers,
    expected: Array,
    rng: np.random.Generator,
) -> None:
    """The best action (T,) for inputs (T, n), -1 where one is not covered; expected (T, A)."""
    for t in range(inputs.shape[0]):
        match(rules, land, inputs[t], scratch)
        known = True
        expected[t] = np.nan
        for a in range(rules.living.size):
            known = known and scratch.fed_count[a] > 0
        if known:
            actions[t] = best_of(rules, numbers, scratch, rng)
            expected[t] = scratch.votes
        else:
            actions[t] = -1

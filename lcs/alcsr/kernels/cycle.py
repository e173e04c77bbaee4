"""The operating cycle, once or over many inputs.

A kernel that has no room for another rule or corpse stops, says so, and is called again with more:
`scratch.progress` keeps where it stood, so that nothing is drawn twice.
"""

import numpy as np

from lcs.alcsr.kernels.breeding import breed
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
from lcs.alcsr.kernels.living import grow_again, settle, starve_hungry
from lcs.alcsr.kernels.matching import EVEN, best_of, choose, match, weight_of, widen
from lcs.alcsr.kernels.remembering import penalty_of, remember
from lcs.alcsr.kernels.seasons import end_season
from lcs.alcsr.kernels.withdrawing import withdraw
from lcs.arrays import Array, Integers
from lcs.compiled import kernel, part

DIE, FIGHT, BREED = range(3)
ORDERS = ((DIE, FIGHT, BREED), (FIGHT, DIE, BREED), (DIE, BREED, FIGHT))
TEST, TRIED, FORCED = range(3)
CYCLES, OWED, ALL = range(3)


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
        elif numbers.breeds == 1 and not breed(rules, land, numbers, scratch, a, rng):
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
    a, is_test = choose(rules, land, numbers, scratch, rng)
    scratch.progress[ACTION] = a
    return -1 - a if is_test else a


@part
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
        remember(land, a, x, reward)
        is_borne = numbers.withdraws == 1 and withdraw(rules, land, scratch, a, x, reward)
        if scratch.fed_count[a] == 0:
            if not is_borne:
                settle(rules, corpses, land, numbers, scratch, a, x, reward, rng)
            progress[STAGE] = 3
        else:
            feed(rules, land, numbers, scratch, a, x, reward)
    if not live_on(rules, corpses, land, numbers, scratch, a, rng):
        return False
    if numbers.grows == 1:
        grow_again(rules, land, scratch, a, x, rng)
    if numbers.hunger > 0:
        starve_hungry(rules, land, numbers, scratch, a)
    if numbers.remembers > 0:
        end_season(rules, land, numbers, scratch, a, rng)
    progress[STAGE] = -1
    return True


@part
def choose_and_learn(
    rules: Rules,
    corpses: Corpses,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    x: Array,
    rewards: Array,
    told: Integers,
    rng: np.random.Generator,
) -> bool:
    """A cycle on x (n,) with rewards (A,); False where there is no room."""
    if scratch.progress[STAGE] < 0:
        said = begin(rules, corpses, land, numbers, scratch, x, rng)
        if said == rules.living.size:
            return False
        a = -1 - said if said < 0 else said
        told[0] = TRIED if scratch.fed_count[a] > 0 else FORCED
        told[1] = a
        if said < 0:
            told[0] = TEST
    if told[0] == TEST:
        return True
    return learn(rules, corpses, land, numbers, scratch, x, rewards[told[1]], rng)


@part
def learn_all(
    rules: Rules,
    corpses: Corpses,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    x: Array,
    rewards: Array,
    rng: np.random.Generator,
) -> bool:
    """Learn each action's reward (A,) on x (n,); False where there is no room."""
    progress = scratch.progress
    if progress[STAGE] < 0:
        if not ready(rules, corpses, land, numbers, scratch, x):
            return False
        progress[ACTION] = 0
    while progress[ACTION] < rules.living.size:
        reward = rewards[progress[ACTION]]
        if not learn(rules, corpses, land, numbers, scratch, x, reward, rng):
            return False
        progress[ACTION] += 1
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
    what: int,
    told: Integers,
    errors: Array,
    rng: np.random.Generator,
) -> int:
    """Learn from inputs (T, n) and rewards (T, A) from `first` on; where it stopped, T at the end.

    what: `CYCLES`, `OWED` (the reward of the action that `begin` chose), or `ALL` rewards.
    told (T, 5): `TEST`, `TRIED` or `FORCED`; the action; rules; births; deaths so far.
    errors (T,): of a test |vote - reward|, else NaN.
    One kernel for all three, since it is the compilation of what follows a reward that takes long.
    """
    for t in range(first, inputs.shape[0]):
        x = inputs[t]
        errors[t] = np.nan
        if what == ALL:
            done = learn_all(rules, corpses, land, numbers, scratch, x, rewards[t], rng)
        elif what == OWED:
            reward = rewards[t, scratch.progress[ACTION]]
            done = learn(rules, corpses, land, numbers, scratch, x, reward, rng)
        else:
            done = choose_and_learn(
                rules, corpses, land, numbers, scratch, x, rewards[t], told[t], rng
            )
            if told[t, 0] == TEST:
                errors[t] = abs(scratch.votes[told[t, 1]] - rewards[t, told[t, 1]])
        if not done:
            return t
        told[t, 2] = rules.living.sum()
        told[t, 3] = scratch.tally[COVERED] + scratch.tally[BRED]
        told[t, 4] = scratch.tally[POISONED:].sum()
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
            actions[t] = best_of(rules, land, numbers, scratch, rng)
            expected[t] = scratch.votes
        else:
            actions[t] = -1


@kernel
def weigh(rules: Rules, land: Land, numbers: Numbers, weights: Array) -> None:
    """Write what the vote of each rule counts, (A, C)."""
    for a in range(rules.living.size):
        penalty = penalty_of(EVEN, land.noise[a])
        for k in range(rules.living[a]):
            weights[a, k] = weight_of(rules, numbers, a, k, penalty)

"""The operating cycle, once or over many inputs.

A kernel that has no room for another rule or corpse stops, says so, and is called again with more:
`scratch.progress` keeps where it stood, so that nothing is drawn twice. It stops too where bodies
are to grow, which is compiled apart.
"""

import numpy as np

from lcs.alcsr.kernels.breeding import breed
from lcs.alcsr.kernels.covering import cover
from lcs.alcsr.kernels.feeding import die, feed, fight
from lcs.alcsr.kernels.hunger import needs_tending, starve_hungry
from lcs.alcsr.kernels.layout import (
    ACTION,
    BEGINNING,
    BRED,
    COVERED,
    DONE,
    LIVED,
    POISONED,
    STAGE,
    UNCOVERED,
    UNEATEN,
    UNTENDED,
    Corpses,
    Land,
    Numbers,
    Rules,
    Scratch,
)
from lcs.alcsr.kernels.matching import EVEN, best_of, choose, match, weight_of, widen
from lcs.alcsr.kernels.remembering import penalty_of, remember
from lcs.alcsr.kernels.withdrawing import withdraw
from lcs.arrays import Array, Integers
from lcs.compiled import kernel, part
from lcs.kernels.kinds import FORCED, TEST, TRIED

DIE, FIGHT, BREED = range(3)
ORDERS = ((DIE, FIGHT, BREED), (FIGHT, DIE, BREED), (DIE, BREED, FIGHT))
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
    while scratch.progress[STAGE] < LIVED:
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
    """What follows the reward of `scratch.progress[ACTION]`.

    False where it has to stop: there is no room, or `lcs.alcsr.kernels.tending` has to go on.
    """
    progress = scratch.progress
    a = progress[ACTION]
    if progress[STAGE] == BEGINNING:
        progress[STAGE] = 0
        remember(land, a, x, reward)
        is_borne = numbers.withdraws == 1 and withdraw(rules, land, scratch, a, x, reward)
        if scratch.fed_count[a] > 0:
            feed(rules, land, numbers, scratch, a, x, reward)
        elif is_borne:
            progress[STAGE] = LIVED
        elif numbers.grows == 1 or numbers.sprouts > 0:
            progress[STAGE] = UNEATEN
        else:
            progress[STAGE] = UNCOVERED
    if progress[STAGE] == UNCOVERED:
        cover(rules, corpses, land, numbers, scratch, a, x, reward, rng)
        progress[STAGE] = LIVED
    if progress[STAGE] < LIVED and not live_on(rules, corpses, land, numbers, scratch, a, rng):
        return False
    if progress[STAGE] == LIVED:
        if numbers.hunger > 0:
            starve_hungry(rules, land, numbers, scratch, a)
        progress[STAGE] = UNTENDED if needs_tending(rules, land, numbers, scratch, a) else DONE
    if progress[STAGE] != DONE:
        return False
    progress[STAGE] = BEGINNING
    return True


@part
def start(
    rules: Rules,
    corpses: Corpses,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    x: Array,
    what: int,
    told: Integers,
    rng: np.random.Generator,
) -> bool:
    """See who covers x (n,) and which action comes first; False where there is no room."""
    told[0] = TRIED
    if what == ALL:
        scratch.progress[ACTION] = 0
        return ready(rules, corpses, land, numbers, scratch, x)
    if what == CYCLES:
        said = begin(rules, corpses, land, numbers, scratch, x, rng)
        if said == rules.living.size:
            return False
        told[1] = scratch.progress[ACTION]
        if said < 0:
            told[0] = TEST
        elif scratch.fed_count[told[1]] == 0:
            told[0] = FORCED
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
    progress = scratch.progress
    for t in range(first, inputs.shape[0]):
        x = inputs[t]
        if progress[STAGE] == BEGINNING:
            if not start(rules, corpses, land, numbers, scratch, x, what, told[t], rng):
                return t
            errors[t] = np.nan
            if told[t, 0] == TEST:
                errors[t] = abs(scratch.votes[told[t, 1]] - rewards[t, told[t, 1]])
        while told[t, 0] != TEST:
            reward = rewards[t, progress[ACTION]]
            if not learn(rules, corpses, land, numbers, scratch, x, reward, rng):
                return t
            if what != ALL or progress[ACTION] + 1 == rules.living.size:
                break
            progress[ACTION] += 1
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
            for a in range(rules.living.size):  # copying whole rows compiles for seconds
                expected[t, a] = scratch.votes[a]
        else:
            actions[t] = -1


@kernel
def weigh(rules: Rules, land: Land, numbers: Numbers, weights: Array) -> None:
    """Write what the vote of each rule counts, (A, C)."""
    for a in range(rules.living.size):
        penalty = penalty_of(EVEN, land.noise[a])
        for k in range(rules.living[a]):
            weights[a, k] = weight_of(rules, numbers, a, k, penalty)

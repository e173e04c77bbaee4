"""The performance system (4.3.2): who covers an input, what they expect, which action is taken."""

import numpy as np

from lcs.alcsr.kernels.layout import Land, Numbers, Rules, Scratch
from lcs.alcsr.kernels.remembering import penalty_of
from lcs.arrays import Array, Integers
from lcs.compiled import part

EVEN = 0.5
LEAST_WEIGHT = 0.1
"""What weighs evidence: it is held against food that is there half of the time."""


@part
def widen(rules: Rules, land: Land, numbers: Numbers, x: Array) -> None:
    """Widen the known range by x (n,); volumes are fractions of it."""
    if numbers.range_is == 1:
        return
    grown = False
    for i in range(x.size):
        if x[i] < land.low[i]:
            if numbers.grows == 1:
                move_ends(rules, rules.lower, i, land.low[i], x[i])
            land.low[i] = x[i]
            grown = True
        if x[i] > land.high[i]:
            if numbers.grows == 1:
                move_ends(rules, rules.upper, i, land.high[i], x[i])
            land.high[i] = x[i]
            grown = True
    if grown:
        for a in range(rules.living.size):
            for k in range(rules.living[a]):
                rules.volume[a, k] = volume_of(rules.lower[a, k], rules.upper[a, k], land)


@part
def move_ends(rules: Rules, bounds: Array, i: int, end: float, further: float) -> None:
    """Bounds where the known range ended go with it: they are no conditions."""
    for a in range(rules.living.size):
        for k in range(rules.living[a]):
            if bounds[a, k, i] == end:
                bounds[a, k, i] = further


@part
def volume_of(lower: Array, upper: Array, land: Land) -> float:
    """Of a body, as a share of the known range's."""
    volume = 1.0
    for i in range(lower.size):
        width = land.high[i] - land.low[i]
        if width > 0.0:
            volume *= (upper[i] - lower[i]) / width
    return volume


@part
def match(rules: Rules, land: Land, x: Array, scratch: Scratch) -> None:
    """Fill the potential action sets."""
    n = x.size
    for a in range(rules.living.size):
        found = 0
        lower, upper = rules.lower[a], rules.upper[a]
        for k in range(rules.living[a]):
            inside = True
            for i in range(n):
                at = x[i]
                if at < lower[k, i] or at > upper[k, i]:
                    inside = False
                    break
                if at == upper[k, i] and at != land.high[i]:
                    inside = False
                    break
            if inside:
                scratch.fed[a, found] = k
                found += 1
        scratch.fed_count[a] = found


@part
def is_mature(rules: Rules, numbers: Numbers, a: int, k: int) -> bool:
    """Table 4.3."""
    mature: bool = rules.experience[a, k] > numbers.mature_level * rules.volume[a, k]
    return mature


@part
def can_breed(rules: Rules, numbers: Numbers, a: int, k: int) -> bool:
    """Table 4.3."""
    able: bool = rules.strength[a, k] >= numbers.breed_level * rules.volume[a, k]
    return able


@part
def vote(rules: Rules, land: Land, numbers: Numbers, a: int, fed: Integers) -> float:
    """The reward that the rules fed (m,) of landscape a expect."""
    penalty = penalty_of(EVEN, land.noise[a])
    total = 0.0
    weighed = 0.0
    plain = 0.0
    for k in fed:
        weight = weight_of(rules, numbers, a, k, penalty)
        total += weight
        weighed += weight * rules.prediction[a, k]
        plain += rules.prediction[a, k]
    return weighed / total if total > 0.0 else plain / fed.size


@part
def weight_of(rules: Rules, numbers: Numbers, a: int, k: int, penalty: float) -> float:
    """What the vote of rule k counts: strength per volume, or the evidence for it."""
    if numbers.weighs_evidence == 1:
        return float(max(LEAST_WEIGHT, rules.right[a, k] - penalty * rules.wrong[a, k]))
    weight: float = rules.strength[a, k] / rules.volume[a, k]
    mature = is_mature(rules, numbers, a, k)
    weighed: float = weight if mature else weight * numbers.immature_vote
    return weighed


@part
def votes(rules: Rules, numbers: Numbers, scratch: Scratch, a: int) -> bool:
    """Whether anybody votes for action a."""
    if numbers.vote_of_none == 0:
        return bool(scratch.fed_count[a] > 0)
    for j in range(scratch.fed_count[a]):  # noqa: SIM110  numba closes over no array
        if rules.strength[a, scratch.fed[a, j]] > 0.0:
            return True
    return False


@part
def pick(rng: np.random.Generator, count: int) -> int:
    """One of so many, at random."""
    return int(rng.random() * count)


@part
def choose(
    rules: Rules, land: Land, numbers: Numbers, scratch: Scratch, rng: np.random.Generator
) -> tuple[int, bool]:
    """The action, and whether this is a test; `scratch.votes` are of a test."""
    actions = rules.living.size
    empty = 0
    for a in range(actions):
        if not votes(rules, numbers, scratch, a):
            scratch.order[empty] = a
            empty += 1
    if empty > 0:
        return scratch.order[pick(rng, empty)], False
    if rng.random() < numbers.explore:
        return pick(rng, actions), False
    return best_of(rules, land, numbers, scratch, rng), True


@part
def best_of(
    rules: Rules, land: Land, numbers: Numbers, scratch: Scratch, rng: np.random.Generator
) -> int:
    """The action with the highest vote; of several, one at random."""
    best = 0
    for a in range(rules.living.size):
        scratch.votes[a] = vote(rules, land, numbers, a, scratch.fed[a, : scratch.fed_count[a]])
    highest = scratch.votes.max()
    for a in range(rules.living.size):
        if scratch.votes[a] == highest:
            scratch.order[best] = a
            best += 1
    chosen: int = scratch.order[0 if best == 1 else pick(rng, best)]
    return chosen

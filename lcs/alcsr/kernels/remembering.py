"""The land remembers the last foods that it grew, and knows how noisy they are."""

import numpy as np

from lcs.alcsr.kernels.layout import Land
from lcs.arrays import Array, Counts
from lcs.compiled import part

HARDEST = 20.0
SOFTEST = 0.5
"""Penalties beyond these change no body any more."""

FINEST = 1e-9
"""The least noise that is told from none."""


@part
def remember(land: Land, a: int, x: Array, reward: float) -> None:
    """Food at x (n,); the oldest is forgotten where there is no room."""
    room = land.rewards.shape[1]
    if room > 0:
        at = land.met[a] % room
        for i in range(x.size):
            land.foods[a, i, at] = x[i]
        land.rewards[a, at] = reward
    land.met[a] += 1


@part
def known(land: Land, a: int) -> int:
    """How many foods landscape a remembers."""
    count: int = min(land.met[a], land.rewards.shape[1])
    return count


@part
def share_of(land: Land, a: int, reward: float) -> float:
    """The share of remembered food that is of this type."""
    count = 0
    rewards = land.rewards[a]
    total = known(land, a)
    for k in range(total):
        count += rewards[k] == reward
    return count / total if total > 0 else 1.0


@part
def penalty_of(share: float, noise: float) -> float:
    """What a wrong food in a body outweighs, in right ones of its own type.

    A body says that its food is there with probability 1 - noise, where else it is there with
    `share`; the evidence for it is a log-likelihood ratio, log((1 - noise) / share) for each right
    food, log(noise / (1 - share)) for each wrong one. This is their ratio.
    """
    if share >= 1.0:
        return HARDEST
    noise = max(noise, FINEST)
    gain = np.log((1.0 - noise) / share)
    if gain <= FINEST:
        return HARDEST
    return float(min(HARDEST, max(SOFTEST, np.log((1.0 - share) / noise) / gain)))


@part
def least_evidence(land: Land, a: int, noise: float) -> float:
    """How many right foods, wrong ones taken off, nobody would take for noise: one without any."""
    if noise <= 0.0:
        return 1.0
    places = known(land, a) * land.foods.shape[1]
    return float(1.0 + np.log(places) / np.log(1.0 / noise))


@part
def is_inside(value: float, lower: float, upper: float, high: float) -> bool:
    """Whether a body holds a value in one dimension; it is closed where the known range ends."""
    return value >= lower and (value < upper or (value == upper and upper >= high))


@part
def top_of(upper: float, high: float) -> float:
    """The first value above a body: its upper bound, or just beyond the end of the known range."""
    return float(np.nextafter(upper, np.inf)) if upper >= high else upper


@part
def count_outside(
    land: Land, a: int, total: int, lower: Array, upper: Array, outside: Counts
) -> None:
    """In how many dimensions each of the first `total` foods lies outside of a body (n,)."""
    outside[:total] = 0
    for i in range(lower.size):
        low, top = lower[i], top_of(upper[i], land.high[i])
        if low <= land.low[i] and top > land.high[i]:
            continue
        foods = land.foods[a, i]
        for k in range(total):
            outside[k] += foods[k] < low or foods[k] >= top


@part
def meals_in(land: Land, a: int, reward: float, outside: Counts) -> tuple[int, int]:
    """How many remembered foods inside are of this type, and how many are not."""
    right, wrong = 0, 0
    rewards = land.rewards[a]
    for k in range(known(land, a)):
        if outside[k] == 0:
            if rewards[k] == reward:
                right += 1
            else:
                wrong += 1
    return right, wrong

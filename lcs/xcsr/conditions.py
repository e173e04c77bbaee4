"""Conditions of XCSR in plain Python: where they hold, and how they are covered and changed.

Wilson 2000 and Stone and Bull 2003. The definition of the cycle uses them; kernels give the same
bits. Chance is drawn in the order of the lines.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, final

from lcs.xcsr.config import Bounds, Config


class Chance(Protocol):
    """Where random numbers come from."""

    def random(self) -> float:
        """The next one, uniform in [0, 1)."""
        ...


def pick(rng: Chance, count: int) -> int:
    """One of so many, at random."""
    return int(rng.random() * count)


@final
@dataclass(slots=True)
class Condition:
    """The genes of each input: two numbers, which `Bounds` explains."""

    first: list[float]
    second: list[float]


@final
@dataclass(frozen=True, slots=True)
class Space:
    """How conditions are written, and the range of each input."""

    config: Config
    low: list[float]
    high: list[float]

    def interval(self, condition: Condition, i: int) -> tuple[float, float]:
        """Where it holds in input i, from the first on, below the second: inf at its end."""
        low, up = condition.first[i], condition.second[i]
        if self.config.bounds is Bounds.CENTER_SPREAD:
            low, up = low - up, low + up
        elif low > up:
            low, up = up, low
        return max(low, self.low[i]), math.inf if up >= self.high[i] else up

    def intervals(self, condition: Condition) -> list[tuple[float, float]]:
        """Of all inputs."""
        return [self.interval(condition, i) for i in range(len(self.low))]


def holds(space: Space, condition: Condition, x: Sequence[float]) -> bool:
    """Whether it holds on `x`."""
    return all(low <= x[i] < up for i, (low, up) in enumerate(space.intervals(condition)))


def is_more_general(space: Space, one: Condition, other: Condition) -> bool:
    """Whether `one` holds wherever `other` does, and elsewhere."""
    ours, theirs = space.intervals(one), space.intervals(other)
    holds = all(a[0] <= b[0] and a[1] >= b[1] for a, b in zip(ours, theirs, strict=True))
    return holds and ours != theirs


def width(space: Space, condition: Condition) -> float:
    """The sum of its widths, as shares of the ranges."""
    total = 0.0
    for i, (start, end) in enumerate(space.intervals(condition)):
        low, high = space.low[i], space.high[i]
        total += (min(end, high) - start) / (high - low)
    return total


def covering(space: Space, x: Sequence[float], rng: Chance) -> Condition:
    """Intervals around `x` of random width, or all of the range with the chance P_hash."""
    config, born = space.config, Condition([], [])
    for value, low, high in zip(x, space.low, space.high, strict=True):
        is_free = config.P_hash > 0.0 and rng.random() < config.P_hash
        reach = config.s_0 * (high - low)
        if config.bounds is Bounds.CENTER_SPREAD:
            born.first.append(value)
            born.second.append(high - low if is_free else rng.random() * reach)
        else:
            born.first.append(low if is_free else max(value - rng.random() * reach, low))
            born.second.append(high if is_free else min(value + rng.random() * reach, high))
    return born


def cross(one: Condition, other: Condition, rng: Chance) -> None:
    """Exchange the genes between two points, which may lie within an interval."""
    genes = 2 * len(one.first)
    start, end = sorted((pick(rng, genes + 1), pick(rng, genes + 1)))
    for place in range(start, end):
        mine = one.second if place % 2 else one.first
        yours = other.second if place % 2 else other.first
        mine[place // 2], yours[place // 2] = yours[place // 2], mine[place // 2]


def mutate(space: Space, condition: Condition, rng: Chance) -> None:
    """A step in each gene with the chance mu, and back into the range; bounds put in order."""
    config = space.config
    is_spread = config.bounds is Bounds.CENTER_SPREAD
    for i, (low, high) in enumerate(zip(space.low, space.high, strict=True)):
        for genes, least, most in (
            (condition.first, low, high),
            (condition.second, 0.0 if is_spread else low, high - low if is_spread else high),
        ):
            if rng.random() < config.mu:
                step = (2.0 * rng.random() - 1.0) * config.m_0 * (high - low)
                genes[i] = min(max(genes[i] + step, least), most)
        if config.bounds is Bounds.ORDERED and condition.first[i] > condition.second[i]:
            condition.first[i], condition.second[i] = condition.second[i], condition.first[i]

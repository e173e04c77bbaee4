"""Means over switches against what is allowed, with their doubt.

The interval of a mean is Student's t over the switches, no narrower than their noise makes it.
WITHIN: the interval lies within what is allowed. EXCEEDED: the mean is shown to lie beyond it,
after Holm's correction (1979) for how many means the report judges. Else UNDECIDED.
"""

import math
from dataclasses import dataclass
from typing import final

import numpy as np
from scipy import special

from runtime.arrays import Array
from verifier.report.report import Interval, Standing
from verifier.report.switching import Sample

CONFIDENCE = 0.95
FEWEST = 3
"""Fewer switches decide nothing."""


@final
@dataclass(frozen=True, slots=True)
class Mean:
    """A mean of `count` values; `chance` of one at least so far beyond `allowed`, were it not.

    sample: what it is a mean of.
    """

    count: int
    mean: float
    interval: Interval
    allowed: float
    chance: float
    sample: Sample


def mean_of(values: Array, deviations: Array, allowed: float, bias: float) -> Mean:
    """The mean of values (N,) with known `deviations` (N,) of their noise."""
    count = len(values)
    mean = float(np.mean(values))
    sample = Sample(tuple(values.tolist()), tuple(deviations.tolist()), bias)
    if count < FEWEST:
        return Mean(count, mean, Interval(-math.inf, math.inf), allowed, 1.0, sample)
    spread = max(float(np.var(values, ddof=1)), float(np.mean(deviations**2)))
    error = math.sqrt(spread / count)
    freedom = float(count - 1)
    half = float(special.stdtrit(freedom, 0.5 + CONFIDENCE / 2.0)) * error + bias
    beyond = abs(mean) - bias - allowed
    if error == 0.0:
        chance = 0.0 if beyond > 0.0 else 1.0
    else:
        chance = float(special.stdtr(freedom, -beyond / error))
    return Mean(count, mean, Interval(mean - half, mean + half), allowed, chance, sample)


def standings_of(means: list[Mean]) -> list[Standing]:
    """Where each of the means stands, all of them judged together."""
    order = np.argsort([mean.chance for mean in means], kind="stable")
    standings = [_alone(mean) for mean in means]
    for rank, place in enumerate(order):
        if means[place].chance > (1.0 - CONFIDENCE) / (len(means) - rank):
            break
        standings[place] = Standing.EXCEEDED
    return standings


def _alone(mean: Mean) -> Standing:
    reach = max(abs(mean.interval.low), abs(mean.interval.high))
    return Standing.WITHIN if reach <= mean.allowed else Standing.UNDECIDED

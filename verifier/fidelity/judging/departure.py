"""How far the robot departs from its spec, and how sure that is.

The departure is the root mean square of measured minus predicted at the horizon, over windows,
with the measurement noise's contribution removed: sqrt(mean(e^2) - mean(var e)), floored at 0.

Its interval: errors of neighbouring windows depend on one another (they overlap, and what
departs in one place departs next to it), so the windows are cut into *blocks* of at least two
horizons, longer where the squared errors stay correlated for longer (Geyer's initial positive
sequence, 1992); the blocks' means count as independent. The interval of mean(e^2) is Student's t
on a logarithmic scale (a mean of squares is skew); the one of the noise's share is normal; their
difference is combined by MOVER (Zou and Donner 2008). Resampling blocks and reading percentiles
(the moving block bootstrap) looked the obvious way, but with 10 to 20 windows its 97.5 % upper
bound misses the truth in 20-40 % of cases; this interval's in 3-7 %.
"""

from dataclasses import dataclass
from typing import final

import numpy as np
from scipy import special

from runtime.arrays import Array, Integers
from verifier.fidelity.judging.neighbours import correlation_time, gathered, one_run
from verifier.report.report import Interval, Standing

CONFIDENCE = 0.95
BLOCK_HORIZONS = 2.0
FEWEST_BLOCKS = 2


@final
@dataclass(frozen=True, slots=True)
class Departure:
    """rmse as it is; departure and interval without the noise's contribution."""

    windows: int
    blocks: int
    rmse: float
    departure: float
    interval: Interval


def departure_of(
    plain: Array,
    mean: Array,
    variance: Array,
    noise_doubt: float,
    runs: Integers | None = None,
) -> Departure:
    """The departure from errors of windows in order of time (W,), none of them NaN.

    plain: errors of single samples, for the rmse. mean: errors averaged over a span, and their
    `variance` from noise, known up to the relative standard error `noise_doubt`. runs: the
    recording (W,) of each window, where they are of several.
    """
    if len(mean) == 0:
        return Departure(0, 0, 0.0, 0.0, Interval(0.0, np.inf))
    squares = mean**2
    total, share = float(np.mean(squares)), float(np.mean(variance))
    blocks = blocks_of(squares, runs)
    low, high = _mean_square_interval(squares, blocks)
    slack = special.ndtri(0.5 + CONFIDENCE / 2.0) * noise_doubt * share
    lower = total - share - np.hypot(total - low, slack)
    upper = total - share + np.hypot(high - total, min(slack, share))
    return Departure(
        windows=len(mean),
        blocks=int(blocks[-1]) + 1,
        rmse=float(np.sqrt(np.mean(plain**2))),
        departure=_root(total - share),
        interval=Interval(_root(lower), _root(upper)),
    )


def mean_of(errors: Array, blocks: Integers) -> tuple[float, Interval]:
    """The mean of errors (W,) with its interval; `blocks` (W,) say which belong together."""
    mean = float(np.mean(errors))
    half = t_quantile(count_of(blocks)) * standard_error(errors, blocks)
    return mean, Interval(mean - half, mean + half)


def standing_of(interval: Interval, tolerance: float) -> Standing:
    """Where a departure with this interval stands."""
    if interval.high <= tolerance:
        return Standing.WITHIN
    return Standing.EXCEEDED if interval.low > tolerance else Standing.UNDECIDED


def blocks_of(squares: Array, runs: Integers | None = None) -> Integers:
    """The block (W,) of each window, 0, 1, ...; windows start half a horizon apart.

    runs: the recording (W,) of each window, where they are of several.
    """
    least = BLOCK_HORIZONS / 0.5
    size = max(least, np.ceil(2.0 * correlation_time(squares, runs)))
    return gathered(one_run(len(squares)) if runs is None else runs, size)


def standard_error(values: Array, blocks: Integers) -> float:
    """Of the mean of values whose blocks are independent; infinite for a single block."""
    count = count_of(blocks)
    if count < FEWEST_BLOCKS:
        return np.inf
    _, place = np.unique(blocks, return_inverse=True)
    sums = np.bincount(place, weights=values - np.mean(values))
    return float(np.sqrt(np.sum(sums**2) * count / (count - 1.0)) / len(values))


def count_of(blocks: Integers) -> int:
    """How many blocks there are."""
    return len(np.unique(blocks))


def t_quantile(blocks: int) -> float:
    """Student's t, two-sided at the report's confidence."""
    return float(special.stdtrit(max(blocks - 1, 1), 0.5 + CONFIDENCE / 2.0))


def _mean_square_interval(squares: Array, blocks: Integers) -> tuple[float, float]:
    total = float(np.mean(squares))
    error = standard_error(squares, blocks)
    if not np.isfinite(error):
        return 0.0, np.inf
    if total == 0.0:
        return 0.0, 0.0
    width = min(t_quantile(count_of(blocks)) * error / total, 300.0)
    return total * float(np.exp(-width)), total * float(np.exp(width))


def _root(square: float) -> float:
    return float(np.sqrt(max(square, 0.0)))

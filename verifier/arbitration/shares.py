"""Shares of decisions with intervals that know that decisions follow one another.

A robot that decides nine times a second does not decide anew nine times: a run of like decisions
is one. So the interval is that of Clopper and Pearson for as many decisions as would tell as much
(Korn, Graubard: Confidence Intervals for Proportions with Small Expected Number of Positive Counts
Estimated from Survey Data, 1998), where the number is divided by the integrated time of
autocorrelation (Geyer: Practical Markov Chain Monte Carlo, 1992, initial positive sequence).
"""

from typing import Final

import numpy as np
from scipy.special import betaincinv
from scipy.stats import binomtest

from runtime.arrays import Array, Booleans, Integers
from verifier.report.arbitration import Share
from verifier.report.report import Interval

FEW: Final = 10
"""With fewer episodes of disagreement their own autocorrelation says nothing."""
MOST_LONGER: Final = 50.0
"""Nobody records so many times as much."""


def share_of(agrees: Booleans, slowness: float, confidence: float) -> Share:
    """The share of true in `agrees` (T,), which are in order of time.

    slowness: the autocorrelation time of the decisions themselves, in decisions; it is taken where
    disagreements are too few to show their own.
    """
    count = agrees.size
    agreeing = int(agrees.sum())
    if not count:
        return Share(0, 0, 0.0, Interval(0.0, 1.0))
    own = slowness_of((~agrees).astype(float))
    time = own if _episodes(~agrees) >= FEW else max(own, slowness)
    effective = max(1.0, count / max(time, 1.0))
    return Share(agreeing, count, effective, interval_of(agreeing / count, effective, confidence))


def slowness_of(values: Array) -> float:
    """The integrated time of autocorrelation of `values` (T,), in samples; 1 for white noise."""
    if values.size < 4:
        return 1.0
    centred = values - values.mean()
    power = float(centred @ centred)
    if power <= 0.0:
        return 1.0
    size = 1 << (2 * values.size - 1).bit_length()
    spectrum = np.fft.rfft(centred, size)
    correlation = np.fft.irfft(spectrum * spectrum.conj(), size)[: values.size] / power
    pairs = correlation[: values.size // 2 * 2].reshape(-1, 2).sum(axis=1)
    stops = np.flatnonzero(pairs <= 0.0)
    kept = pairs[: stops[0]] if stops.size else pairs
    return max(1.0, 2.0 * float(kept.sum()) - 1.0)


def slowness_of_choices(chosen: Integers, choices: int) -> float:
    """The greatest autocorrelation time of having chosen one of the choices."""
    return max(slowness_of((chosen == choice).astype(float)) for choice in range(choices))


def is_worse(losses: Integers, gains: Integers, slowness: float, confidence: float) -> bool:
    """Whether more is lost than gained, by the sign test on episodes.

    losses, gains: places (sorted) of decisions that one arbiter has right and another has not, and
    the reverse. Those within `slowness` of one another are one episode.
    """
    lost, won = _count(losses, slowness), _count(gains, slowness)
    if lost <= won:
        return False
    return float(binomtest(lost, lost + won).pvalue) < 1.0 - confidence


def _count(places: Integers, slowness: float) -> int:
    return int(np.count_nonzero(np.diff(places) > slowness)) + 1 if places.size else 0


def _episodes(flags: Booleans) -> int:
    return int(np.count_nonzero(np.diff(flags.astype(np.int8), prepend=0) == 1))


def interval_of(share: float, effective: float, confidence: float) -> Interval:
    """The interval of Clopper and Pearson, of a number of decisions that need not be whole."""
    tail = 0.5 * (1.0 - confidence)
    hits, misses = share * effective, (1.0 - share) * effective
    low = float(betaincinv(hits, misses + 1.0, tail)) if hits > 0.0 else 0.0
    high = float(betaincinv(hits + 1.0, misses, 1.0 - tail)) if misses > 0.0 else 1.0
    return Interval(low, high)


def times_longer(share: Share, required: float, confidence: float) -> float:
    """How many times as many decisions would decide, if they go on as they are; inf if none."""
    if share.value == required or not share.decisions:
        return float("inf")
    for factor in np.geomspace(1.0, MOST_LONGER, 200):
        interval = interval_of(share.value, share.effective * float(factor), confidence)
        if interval.low >= required or interval.high < required:
            return float(factor)
    return float("inf")

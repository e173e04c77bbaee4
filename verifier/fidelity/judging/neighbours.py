"""Which windows depend on one another: neighbours in time, never windows of two recordings.

Letters: W windows, in order of time within each recording, the recordings one after the other.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from runtime.arrays import Array, Integers

ROUNDING: Final = 1e-20
"""Values that differ by less than this share of their squares are the same."""


def one_run(windows: int) -> Integers:
    """The recording (W,) of windows that are all of one."""
    return np.zeros(windows, np.int64)


def lengths_of(runs: Integers) -> tuple[int, ...]:
    """How many windows each recording has, without those that have none; `runs`: (W,)."""
    return tuple(int(count) for count in np.bincount(runs) if count > 0)


def gathered(runs: Integers, size: float) -> Integers:
    """The group (W,) of each window, 0, 1, ...: of at least `size` neighbours of one recording.

    A recording with fewer windows is one group.
    """
    groups, first = [np.zeros(0, np.int64)], 0
    for length in lengths_of(runs):
        count = max(1, int(length // size))
        groups.append(first + np.arange(length) * count // length)
        first += count
    return np.concatenate(groups)


def correlation_time(values: Array, runs: Integers | None = None) -> float:
    """The integrated autocorrelation time, in samples; 1 for independent values.

    values: (W,), of the recordings `runs` (W,): a lag never leads from one to the next, and what
    is common to all values of a recording, but not to all recordings, counts as correlation.
    """
    lengths = (len(values),) if runs is None else lengths_of(runs)
    deviation = values - np.mean(values)
    power = float(np.sum(deviation**2))
    found = 1.0
    if power <= ROUNDING * float(np.sum(values**2)):
        return found
    for lag in range(1, min(len(values) // 3, max(lengths))):
        correlation = _lagged(deviation, lengths, lag) / power
        if correlation <= 0.0:
            break
        found += 2.0 * correlation
    return found


def _lagged(deviation: Array, lengths: Sequence[int], lag: int) -> float:
    """The sum of products of values `lag` apart, as for one recording of this length."""
    ends = np.cumsum(lengths)
    parts = [deviation[end - length : end] for end, length in zip(ends, lengths, strict=True)]
    pairs = sum(max(len(part) - lag, 0) for part in parts)
    total = sum(float(np.sum(part[:-lag] * part[lag:])) for part in parts if len(part) > lag)
    return total * ((len(deviation) - lag) / pairs)

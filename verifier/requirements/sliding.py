"""Maxima over ranges of an array, and clamps composed backwards: whole arrays at a time."""

import numpy as np

from runtime.arrays import Array, Integers


def range_maxima(values: Array, first: Integers, stop: Integers, empty: float) -> Array:
    """The maxima (q,) of values[first:stop] for each pair (q,); `empty` where there are none.

    By doubling (Bender, Farach-Colton: The LCA Problem Revisited, 2000): a range is covered by
    two of a power of two that overlap. One level is kept at a time, so that memory is O(n) and
    time O((n + q) log w) for ranges of at most w, without a loop over samples.

    >>> range_maxima(np.array([3.0, 1.0, 2.0]), np.array([0, 1, 2]), np.array([3, 3, 2]), -1.0)
    array([ 3.,  2., -1.])
    """
    counts = np.maximum(stop - first, 0)
    # frexp gives the exponent above: 2**(exponent - 1) <= count < 2**exponent.
    levels = np.frexp(counts.astype(float))[1] - 1
    found = np.full(first.shape, empty)
    of_powers = values
    for level in range(int(levels.max(initial=-1)) + 1):
        asked = np.flatnonzero(levels == level)
        left, right = first[asked], stop[asked] - (1 << level)
        found[asked] = np.maximum(of_powers[left], of_powers[right])
        of_powers = np.maximum(of_powers[: -(1 << level)], of_powers[1 << level :])
    return found


def clamped_backwards(low: Array, high: Array, last: float) -> Array:
    """The z (n + 1,) with z[n] = last and z[i] = max(low[i], min(high[i], z[i + 1])); low <= high.

    Clamps are closed under composition, so that all of them are composed in log n sweeps.
    """
    low, high = low.copy(), high.copy()
    reach = 1
    while reach < low.size:
        # Clamp i, which spans `reach` of them, after the one that begins where it ends.
        own_low, own_high = low[:-reach], high[:-reach]
        composed = [np.maximum(own_low, np.minimum(own_high, e[reach:])) for e in (low, high)]
        low[:-reach], high[:-reach] = composed
        reach *= 2
    return np.append(np.maximum(low, np.minimum(high, last)), last)

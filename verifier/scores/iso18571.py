"""The objective rating of ISO/TS 18571:2024, which crash engineers give to a simulation.

Two signals with equal steps, the measured one `t` (the test) and the predicted one `c`, both (N,).
The rating is 0.4 corridor + 0.2 phase + 0.2 magnitude + 0.2 slope:

corridor: every point scores 1 within 5 % of max |t|, 0 beyond 50 %, quadratic between.
phase: the shift of up to 20 % of the signal that correlates best costs in proportion.
magnitude: after that shift and a dynamic time warping within a tenth of the signal, the error's
    area over the area of t; 0 from one half on.
slope: the same of the derivatives, averaged over nine points, unwarped; 0 from two on.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array, Integers
from verifier.report.scores import IsoRating

INNER: Final = 0.05
OUTER: Final = 0.5
STEEPNESS: Final = 2
SHIFT: Final = 0.2
"""The largest shift, as a share of the signal."""
WARP: Final = 0.1
"""The band of the time warping, as a share of the signal."""
MAGNITUDE_ZERO: Final = 0.5
SLOPE_ZERO: Final = 2.0
SMOOTHED: Final = 9
SHORTEST: Final = 20
"""Shorter signals are not rated."""


def iso_rating(t: Array, c: Array) -> IsoRating | None:
    """The rating of prediction `c` against measurement `t`; None where `t` allows none."""
    if len(t) < SHORTEST or np.ptp(t) == 0.0:
        return None
    shift = _best_shift(t, c)
    near_t, near_c = (t[shift:], c[: len(c) - shift]) if shift >= 0 else (t[:shift], c[-shift:])
    corridor = _corridor(t, c)
    phase = max(0.0, 1.0 - abs(shift) / (SHIFT * len(t)))
    magnitude = _magnitude(near_t, near_c)
    slope = _slope(near_t, near_c)
    overall = 0.4 * corridor + 0.2 * (phase + magnitude + slope)
    return IsoRating(overall, corridor, phase, magnitude, slope)


def _corridor(t: Array, c: Array) -> float:
    widest = float(np.max(np.abs(t)))
    away = np.abs(t - c) / widest
    share = np.clip((OUTER - away) / (OUTER - INNER), 0.0, 1.0)
    return float(np.mean(share**STEEPNESS))


def _best_shift(t: Array, c: Array) -> int:
    """By how many steps `c` must be delayed to correlate best with `t`; small shifts win ties."""
    most = int(SHIFT * len(t))
    order = sorted(range(-most, most + 1), key=abs)
    scores = np.array([_correlation(t, c, shift) for shift in order])
    best = int(np.argmax(scores > np.max(scores) - 1e-12))
    return order[best]


def _correlation(t: Array, c: Array, shift: int) -> float:
    """Pearson's, over what overlaps once `c` is delayed by `shift` steps."""
    a, b = (t[shift:], c[: len(c) - shift]) if shift >= 0 else (t[:shift], c[-shift:])
    a, b = a - a.mean(), b - b.mean()
    size = np.sqrt(np.dot(a, a) * np.dot(b, b))
    return float(np.dot(a, b) / size) if size > 0.0 else -1.0


def _magnitude(t: Array, c: Array) -> float:
    at_t, at_c = warping(t, c, int(np.ceil(WARP * len(t))) - 1)
    area = float(np.sum(np.abs(t[at_t])))
    error = float(np.sum(np.abs(t[at_t] - c[at_c]))) / area if area > 0.0 else np.inf
    return max(0.0, 1.0 - error / MAGNITUDE_ZERO)


def _slope(t: Array, c: Array) -> float:
    of_t, of_c = _smooth_slope(t), _smooth_slope(c)
    area = float(np.sum(np.abs(of_t)))
    error = float(np.sum(np.abs(of_t - of_c))) / area if area > 0.0 else np.inf
    return max(0.0, 1.0 - error / SLOPE_ZERO)


def _smooth_slope(values: Array) -> Array:
    """Central differences, averaged over nine points, over fewer towards the ends (1, 3, 5, 7)."""
    slopes = np.gradient(values)
    total = np.concatenate([[0.0], np.cumsum(slopes)])
    at = np.arange(len(slopes))
    half = np.minimum(SMOOTHED // 2, np.minimum(at, len(slopes) - 1 - at))
    return np.asarray((total[at + half + 1] - total[at - half]) / (2 * half + 1))


def warping(t: Array, c: Array, band: int) -> tuple[Integers, Integers]:
    """The cheapest path by squared distance through pairs (i, j), |i - j| <= band.

    It steps by one in i, in j, or in both (Sakoe and Chiba 1978, without weights). Costs grow
    along anti-diagonals i + j, so that one is worked out at a time, as an array over i.

    Returns:
        Indices into t and c along the path, from the start on.
    """
    n = len(t)
    band = max(band, 1)
    width = band + 3
    before, last = np.full(width, np.inf), np.full(width, np.inf)
    lows = np.zeros(2 * n - 1, np.int64)
    steps = np.zeros((2 * n - 1, width), np.int8)
    for k in range(2 * n - 1):
        low = max(0, k - n + 1, -(-(k - band) // 2))
        high = min(n - 1, k, (k + band) // 2)
        i = np.arange(low, high + 1)
        # In `last` (diagonal k - 1) and `before` (k - 2), entry 1 + i - low stands for i.
        of_i = _reached(last, i - 1 - lows[k - 1]) if k > 0 else np.full(len(i), np.inf)
        of_j = _reached(last, i - lows[k - 1]) if k > 0 else np.full(len(i), np.inf)
        of_both = _reached(before, i - 1 - lows[k - 2]) if k > 1 else np.full(len(i), np.inf)
        choices = np.stack([of_i, of_j, of_both])
        steps[k, : len(i)] = np.argmin(choices, axis=0)
        reached = np.min(choices, axis=0) if k > 0 else np.zeros(1)
        lows[k] = low
        before, last = last, np.full(width, np.inf)
        last[1 : 1 + len(i)] = reached + (t[i] - c[k - i]) ** 2
    return _traced(n, lows, steps)


def _reached(costs: Array, at: Integers) -> Array:
    """Costs at entries counted from the diagonal's first; infinite beside it."""
    return costs[np.clip(at + 1, 0, len(costs) - 1)]


def _traced(
    n: int, lows: Integers, steps: np.ndarray[tuple[int, ...], np.dtype[np.int8]]
) -> tuple[Integers, Integers]:
    """The path backwards from its end, by the step that led to each pair."""
    i, j = n - 1, n - 1
    path = [(i, j)]
    while (i, j) != (0, 0):
        step = int(steps[i + j, i - lows[i + j]])
        i, j = i - (step != 1), j - (step != 0)
        path.append((i, j))
    found = np.array(path[::-1])
    return found[:, 0], found[:, 1]

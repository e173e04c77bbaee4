"""Windows of the declared horizon, spread over the judged stretches (multiple shooting).

Windows start every half horizon, so neighbours overlap by half. Around its start and around
every horizon, a window uses all samples within a short span (a twentieth of the horizon to either
side, at least the nearest sample): averaging over a *symmetric* span lowers the noise without
bias, because an error that grows evenly with time averages to its value at the middle.
"""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from verifier.fidelity.shooting.samples import Samples, nearest

STRIDE = 0.5
SPAN = 0.05
REACH = 0.51
"""A span reaches at least so many sample periods to either side: one sample is always in it."""
NEAR = 0.125
"""But a sample further than this share of the horizon from it does not stand for it."""
FAR = 2**62


@final
@dataclass(frozen=True, eq=False, slots=True)
class Windows:
    """W windows: their start `times`, the judged stretch each lies in, and knots (all (W,)).

    first, last: the knots between which each is predicted.
    """

    times: Array
    stretch: Array
    first: Integers
    last: Integers
    horizon: float

    def part(self, part: slice) -> "Windows":
        """Some of the windows."""
        times, stretch = self.times[part], self.stretch[part]
        return Windows(times, stretch, self.first[part], self.last[part], self.horizon)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Chosen:
    """Samples of one variable for each window: `index` (W, m), real where `used` (W, m)."""

    index: Integers
    used: Booleans


def windows_of(samples: tuple[Samples, ...], base: int, spans: Array, horizon: float) -> Windows:
    """Windows with samples of every predicted state at their start."""
    times, stretch = _starts(samples[base].times, spans, horizon)
    windows = Windows(times, stretch, np.zeros(0, np.int64), np.zeros(0, np.int64), horizon)
    at_start = [chosen_samples(each, windows, 0.0) for each in samples]
    at_end = [chosen_samples(each, windows, horizon) for each in samples]
    complete = np.all([np.any(c.used, axis=1) for c in at_start], axis=0)
    complete &= np.any([np.any(c.used, axis=1) for c in at_end], axis=0)
    first = np.min([_bound(s, c, 0) for s, c in zip(samples, at_start, strict=True)], axis=0)
    last = np.max([_bound(s, c, -1) for s, c in zip(samples, at_end, strict=True)], axis=0)
    return Windows(times[complete], stretch[complete], first[complete], last[complete], horizon)


def chosen_samples(samples: Samples, windows: Windows, after: float) -> Chosen:
    """The samples around `after` seconds from each window's start, inside its stretch."""
    middle = windows.times + after
    low = middle - _half_span(samples, windows.horizon, after)
    high = middle + _half_span(samples, windows.horizon, after)
    slack = 1e-6 * windows.horizon
    start = np.searchsorted(samples.times, np.maximum(low, windows.stretch[:, 0]) - slack)
    stop = np.searchsorted(
        samples.times, np.minimum(high, windows.stretch[:, 1]) + slack, side="right"
    )
    width = int(np.max(stop - start, initial=1))
    index = start[:, None] + np.arange(width)
    return Chosen(np.minimum(index, len(samples.times) - 1), index < stop[:, None])


def closest(samples: Samples, chosen: Chosen, times: Array) -> Integers:
    """Which of the chosen samples (as a column of `chosen.index`) is nearest to each time."""
    distance = np.abs(samples.times[chosen.index] - times[:, None])
    return np.asarray(np.argmin(np.where(chosen.used, distance, np.inf), axis=1))


def _half_span(samples: Samples, horizon: float, after: float) -> float:
    half = max(SPAN * horizon, REACH * samples.distance)
    return half if after == 0.0 else min(half, NEAR * after)


def _starts(base: Array, spans: Array, horizon: float) -> tuple[Array, Array]:
    """Start times on samples of the time base, and the stretch of each: (W,), (W, 2)."""
    times, stretches = [np.empty(0)], [np.empty((0, 2))]
    long_enough = spans[:, 1] - spans[:, 0] >= horizon * (1.0 - 1e-6)
    for span in spans[long_enough]:
        margin = min(SPAN * horizon, max(span[1] - span[0] - horizon, 0.0) / 2.0)
        wanted = np.arange(
            span[0] + margin, span[1] - horizon - margin + 1e-6 * horizon, STRIDE * horizon
        )
        inside = base[(base >= span[0]) & (base <= span[1])]
        if len(inside) and len(wanted):
            found = np.unique(inside[nearest(inside, wanted)])
            times.append(found)
            stretches.append(np.tile(span, (len(found), 1)))
    return np.concatenate(times), np.concatenate(stretches)


def _bound(samples: Samples, chosen: Chosen, side: int) -> Integers:
    """The first (side 0) or last (side -1) knot of the chosen samples."""
    knots = samples.knots[chosen.index]
    if side == 0:
        bound = np.min(np.where(chosen.used, knots, FAR), axis=1, initial=FAR)
    else:
        bound = np.max(np.where(chosen.used, knots, -1), axis=1, initial=-1)
    return np.asarray(bound)

"""Laps of the robot around a cycle of its spec, and how long they take.

The phase of a measured state is that of the nearest point of the spec's cycle, in which time runs
evenly. A lap ends where the unwound phase has grown by one. When the robot passes a phase is found
from all samples around (a line fitted to the phase), not from the two beside it; and the time from
one passage to the next at the *same* phase does not depend on how well the spec's cycle fits, so
the phase may be rough: its error is the same in each lap.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Final, final

import numpy as np
from scipy.spatial import KDTree

from runtime.arrays import Array
from verifier.flags import runs_of
from verifier.report.features import Estimate
from verifier.robot_topology.intervals import student
from verifier.robot_topology.scene import Scene, Stretch
from verifier.topology.features import Cycle

PHASES: Final = 512
"""Points on the spec's cycle, evenly spaced in time."""
SECTIONS: Final = 8
"""Phases at which passages are timed."""
REACH: Final = 0.04
"""A passage is fitted to samples within this share of a lap to either side."""
FEWEST: Final = 3
"""Samples that a passage needs on the whole."""
JUMP: Final = 0.3
"""The phase of successive samples differs by less, else the robot is not on its way round."""
SLOWEST: Final = 3.0
"""A lap takes at most so many times as long as the spec's, and at least the inverse."""
SETTLED: Final = 4.0
"""Deviations of a lap's size from that of the late ones, in their own deviations, at most."""
CALM: Final = 1e-3
"""Their deviations are taken to be at least this share of the size."""
MANY: Final = 12
"""From so many laps on, the correlation of successive ones is believed."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Laps:
    """Laps in one stretch: `starts` (k + 1,), when each begins and the last one ends.

    passages (sections, k + 1): times at which each section was passed, NaN where it is not told.
    stretch: that they lie in. arcs: phases (sections,) of the changes of mode that the sections
    are, empty for a smooth cycle. doubt: of one passage, s, by the sampling of the mode.
    """

    stretch: Stretch
    starts: Array
    passages: Array
    arcs: Array
    doubt: float

    @property
    def count(self) -> int:
        """How many."""
        return max(len(self.starts) - 1, 0)


def laps_of(scene: Scene, cycle: Cycle) -> tuple[Laps, ...]:
    """The robot's laps around `cycle` in each stretch, once they have settled."""
    tree, scale = _tree(scene, cycle)
    return tuple(
        laps for stretch in scene.stretches for laps in _laps(scene, cycle, stretch, tree, scale)
    )


def nearest_cycle(scene: Scene, laps: Laps) -> int:
    """Which cycle of the portrait the laps lie closest to."""
    cycles = scene.portrait.cycles
    if len(cycles) == 1:
        return 0
    first, last = np.searchsorted(laps.stretch.times, laps.starts[[0, -1]])
    values = _embedded(scene, laps.stretch.values[first:last])
    scale = _embedded_widths(scene)
    away = [
        np.median(KDTree(_embedded(scene, _sampled(cycle)) / scale).query(values / scale)[0])
        for cycle in cycles
    ]
    return int(np.argmin(away))


def settled_runs(
    stretch: Stretch, passages: Array, good: list[bool], phases: Array, doubt: float
) -> tuple[Laps, ...]:
    """Each run of good laps between `passages` (sections, k + 1), without those that settle."""
    found = []
    for first, last in runs_of(np.array(good, dtype=np.bool_)):
        begin = first + _unsettled(stretch, passages[0, first : last + 1])
        part = passages[:, begin : last + 1]
        found.append(Laps(stretch, part[0], part, phases, doubt))
    return tuple(laps for laps in found if laps.count)


def period_of_laps(laps: tuple[Laps, ...], confidence: float) -> Estimate | None:
    """The mean time of a lap; None for fewer than three laps.

    Times of successive laps are correlated in two ways: noise of a passage makes one longer and
    the next one shorter by as much, while a wandering pace keeps it. Both are in the first two
    autocovariances of the laps, taken within each stretch; with few laps the noise's help is not
    counted on. A mode that is sampled seldom tells the ends of a stretch no better than that.
    """
    each = [_durations(one) for one in laps]
    known = np.concatenate(each) if each else np.empty(0)
    known = known[np.isfinite(known)]
    count = len(known)
    if count < FEWEST:
        return None
    mean = float(np.mean(known))
    own = float(np.sum((known - mean) ** 2)) / (count - 1)
    pairs = [(one - mean)[1:] * (one - mean)[:-1] for one in each]
    shared = float(np.nansum(np.concatenate(pairs)))
    variance = own / count
    if count >= MANY or shared > 0.0:
        variance = max((own + 2.0 * shared / count) / count, len(laps) * own / count**2)
    rounding = sum(one.doubt**2 / 6.0 for one in laps) / count**2
    return student(mean, float(np.sqrt(variance + rounding)), count, confidence)


def on_cycle(cycle: Cycle, phases: Array) -> Array:
    """The points (..., m) of the spec's cycle at `phases`, in laps; angles go on turning."""
    part = np.mod(phases, 1.0) * cycle.period
    times = cycle.times - cycle.times[0]
    return np.stack([np.interp(part, times, column) for column in cycle.points.T], axis=-1)


def _embedded(scene: Scene, points: Array) -> Array:
    """Points (..., m) with each angle as a point of a circle of the same length."""
    columns = []
    for j, turn in enumerate(scene.turns):
        if turn > 0.0:
            angle = 2.0 * np.pi * points[..., j] / turn
            radius = turn / (2.0 * np.pi)
            columns += [radius * np.cos(angle), radius * np.sin(angle)]
        else:
            columns.append(points[..., j])
    return np.stack(columns, axis=-1)


def _embedded_widths(scene: Scene) -> Array:
    """Of each column that `_embedded` makes."""
    pairs = zip(scene.width, scene.turns, strict=True)
    return np.array([w for width, turn in pairs for w in [width] * (2 if turn > 0.0 else 1)])


def _sampled(cycle: Cycle) -> Array:
    return on_cycle(cycle, np.arange(PHASES) / PHASES)


def _tree(scene: Scene, cycle: Cycle) -> tuple[KDTree, Array]:
    """The cycle's points for looking up the nearest, each axis in the cycle's own size."""
    points = _embedded(scene, _sampled(cycle))
    size = np.ptp(points, axis=0)
    scale = np.where(size > 1e-6 * np.max(size), size, np.max(size))
    return KDTree(points / scale), scale


def _laps(
    scene: Scene, cycle: Cycle, stretch: Stretch, tree: KDTree, scale: Array
) -> tuple[Laps, ...]:
    _, index = tree.query(_embedded(scene, stretch.values) / scale)
    phase = np.unwrap(index / PHASES, period=1.0)
    whole = np.arange(np.ceil(phase[0]), np.floor(phase[-1]) + 1.0)
    wanted = whole + (np.arange(SECTIONS) / SECTIONS)[:, None]
    guesses = _guesses(stretch, phase, wanted.ravel())
    passages = np.array(
        [
            _passage(stretch, phase, at, guess, cycle.period)
            for at, guess in zip(wanted.ravel(), guesses, strict=True)
        ]
    ).reshape(wanted.shape)
    good = _is_lap(stretch, phase, passages[0], cycle.period)
    return settled_runs(stretch, passages, good, phases=np.empty(0), doubt=0.0)


def _guesses(stretch: Stretch, phase: Array, wanted: Array) -> Array:
    """Between when the phase is first at `wanted` (k,) and when it last is not."""
    first = np.searchsorted(np.maximum.accumulate(phase), wanted)
    last = np.searchsorted(np.minimum.accumulate(phase[::-1])[::-1], wanted)
    end = len(stretch.times) - 1
    return 0.5 * (stretch.times[np.minimum(first, end)] + stretch.times[np.minimum(last, end)])


def _passage(stretch: Stretch, phase: Array, at: float, guess: float, period: float) -> float:
    """When the unwound phase passes `at`; NaN where too few samples tell."""
    reach = max(REACH * period, FEWEST * stretch.step)
    for _ in range(2):
        low, high = np.searchsorted(stretch.times, [guess - reach, guess + reach])
        times = stretch.times[low:high] - guess
        if len(times) < FEWEST or times[0] > 0.0 or times[-1] < 0.0:
            return np.nan
        behind = at - phase[low:high]
        middle = float(np.mean(times))
        slope = -float(np.sum((times - middle) * behind) / np.sum((times - middle) ** 2))
        if slope <= 0.0:
            return np.nan
        later = middle + float(np.mean(behind)) / slope
        if abs(later) > reach:
            return np.nan
        guess += later
    return guess


def _is_lap(stretch: Stretch, phase: Array, starts: Array, period: float) -> list[bool]:
    """Of each pair of successive starts, whether it bounds a lap without breaks."""
    steps = np.append(0.0, np.abs(np.diff(phase)))
    good = []
    for first, last in pairwise(starts):
        low, high = np.searchsorted(stretch.times, [first, last])
        calm = high > low and float(np.max(steps[low:high])) < JUMP
        good.append(calm and 1.0 / SLOWEST < (last - first) / period < SLOWEST)
    return good


def _unsettled(stretch: Stretch, starts: Array) -> int:
    """How many of the first laps still differ in size from those of the second half."""
    count = len(starts) - 1
    if count < FEWEST + 1:
        return min(1, max(count - 1, 0))
    sizes = np.array(
        [
            np.std(stretch.values[slice(*np.searchsorted(stretch.times, ends))], axis=0)
            for ends in pairwise(starts)
        ]
    )
    late = sizes[count // 2 :]
    middle = np.median(late, axis=0)
    spread = np.maximum(np.std(late, axis=0, ddof=1), CALM * middle)
    far = np.any(np.abs(sizes - middle) > SETTLED * spread, axis=1)[: count // 2]
    return int(np.argmin(np.append(far, False)))


def _durations(laps: Laps) -> Array:
    """The time of each lap, the mean over the sections at which both its ends are known."""
    differences = np.diff(laps.passages, axis=1)
    known = np.isfinite(differences)
    total = np.sum(np.where(known, differences, 0.0), axis=0)
    return np.where(np.any(known, axis=0), total / np.maximum(known.sum(axis=0), 1), np.nan)

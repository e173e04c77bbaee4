"""Where the robot comes to rest.

It rests where it stays: the means of two successive spans, each as long as the field needs to
settle, differ by no more than noise and half the tolerance allow, and so do those of the three
thirds of the rest. What moves slowly, as at the turning point of a slow swing, drifts away from
one third to the next. A rest lasts until the stretch ends, or until the robot is pushed away; a
saddle that is only passed, or a place that is left as slowly as it was reached, is no rest.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from verifier.flags import runs_of
from verifier.report.features import Estimate
from verifier.robot_topology.intervals import student
from verifier.robot_topology.scene import Scene, Stretch, shortest
from verifier.topology.features import FixedPoint

LENGTHS: Final = 3.0
"""A rest lasts at least so many settling times, not counting the one in which it settles."""
SPAN: Final = 10
"""Samples in a span, at least."""
SURE: Final = 4.0
"""Deviations of the difference of two means that are put down to noise."""
SHARE: Final = 0.5
"""Of the tolerance, that the means may differ by."""
SMALL: Final = 0.005
"""Of the domain: stands for the tolerance where none is declared."""
ROOM: Final = 3.0
"""Of that: the means of spans in one rest lie so close together."""
FAST: Final = 4.0
"""Of that: so far away is the robot a span after it was pushed."""
MANY: Final = 3
"""Visits, whose own spread is told."""
FEWEST: Final = 6
"""Batches or visits, with fewer of which the error of their mean is hardly known."""
BATCHES: Final = 20


@final
@dataclass(frozen=True, eq=False, slots=True)
class Rest:
    """One rest: `values` (N, m) in the order of time, angles unwrapped."""

    values: Array

    @property
    def place(self) -> Array:
        """The mean, (m,)."""
        return np.asarray(np.mean(self.values, axis=0))


def settling_time(scene: Scene, points: tuple[FixedPoint, ...]) -> float:
    """Of the slowest attractor, s; the horizon where there is none."""
    every = scene.program.field.every
    times = []
    for point in points:
        values = np.array(point.eigenvalues)
        rates = -np.log(np.abs(values)) / every if every else -values.real
        slowest = float(np.min(rates, initial=np.inf))
        times.append(1.0 / slowest if slowest > 0.0 else np.inf)
    finite = [time for time in times if 0.0 < time < np.inf]
    return max(finite, default=scene.horizon)


def rests_of(scene: Scene, settling: float) -> tuple[Rest, ...]:
    """All rests, in order of time."""
    return tuple(rest for stretch in scene.stretches for rest in _rests(scene, stretch, settling))


def resting_place(
    scene: Scene, rests: tuple[Rest, ...], settling: float, step: float, confidence: float
) -> tuple[tuple[Estimate, ...], bool]:
    """The mean place of rests, an estimate an axis, angles near that of the first rest.

    And whether there is enough of it for the error to be known well.

    Its error is that between batches of one settling time or more, and with three visits or more
    that between visits, if it is larger.
    """
    first = rests[0].place
    moved = [rest.values + _to(first, rest.place, scene.turns) for rest in rests]
    together = np.concatenate(moved)
    size = max(1, int(np.ceil(LENGTHS * settling / step)), len(together) // BATCHES)
    batches = np.array([np.mean(p, axis=0) for each in moved for p in _cut(each, size)])
    count = len(batches)
    error = np.std(batches, axis=0, ddof=1) / np.sqrt(count)
    error = np.maximum(error, scene.noise / np.sqrt(len(together)))
    value = np.mean(together, axis=0)
    if len(moved) >= MANY:
        visits = np.array([np.mean(each, axis=0) for each in moved])
        between = np.std(visits, axis=0, ddof=1) / np.sqrt(len(visits))
        if np.any(between > error):
            error, count, value = np.maximum(error, between), len(visits), visits.mean(axis=0)
    at = tuple(
        student(float(v), float(e), count, confidence) for v, e in zip(value, error, strict=True)
    )
    return at, count >= FEWEST


def allowance(scene: Scene) -> Array:
    """The tolerance of each axis, or a small share of its domain, (m,)."""
    return np.where(np.isfinite(scene.tolerance), scene.tolerance, SMALL * scene.width)


def _to(target: Array, place: Array, turns: Array) -> Array:
    """By how many whole turns `place` is moved to be near `target`."""
    return np.asarray(target + shortest(place - target, turns) - place)


def _cut(values: Array, size: int) -> list[Array]:
    """Pieces of about `size`, at least two."""
    return np.array_split(values, max(2, len(values) // size))


def _rests(scene: Scene, stretch: Stretch, settling: float) -> list[Rest]:
    span = max(SPAN, int(np.ceil(settling / stretch.step)))
    count = len(stretch.times)
    if count < (1.0 + LENGTHS) * span:
        return []
    sums = np.concatenate([np.zeros((1, stretch.values.shape[1])), np.cumsum(stretch.values, 0)])
    means = (sums[span:] - sums[:-span]) / span
    moved = np.abs(means[span:] - means[:-span])
    allowed = np.maximum(SHARE * allowance(scene), SURE * scene.noise * np.sqrt(2.0 / span))
    calm = np.all(moved <= allowed, axis=-1)
    found = []
    for first, last in runs_of(calm):
        # Calm at i speaks of the samples i to i + 2 span; in the first span it may still settle.
        begin, end = first + span, min(last - 1 + 2 * span, count)
        begin = max(begin, _same_place(means[begin : end - span + 1], ROOM * allowed) + begin)
        to_the_end = end > count - span
        if not to_the_end or end < count:
            end -= span  # It may have been on the way out.
        if end - begin < LENGTHS * span * (1.0 if to_the_end else 2.0):
            continue
        values = stretch.values[begin:end]
        after = means[min(end + span, len(means) - 1)]
        pushed = np.any(np.abs(after - np.mean(values, axis=0)) > FAST * allowed)
        if (to_the_end or pushed) and _stays(scene, values):
            found.append(Rest(values))
    return found


def _same_place(means: Array, room: Array) -> int:
    """From which of the means (K, m) on all the later ones lie within `room` of one another."""
    back = means[::-1]
    reach = np.maximum.accumulate(back, axis=0) - np.minimum.accumulate(back, axis=0)
    return len(means) - int(np.sum(np.all(reach <= room, axis=-1)))


def _stays(scene: Scene, values: Array) -> bool:
    """Whether the thirds of `values` (N, m) have one mean, but for noise and half the tolerance."""
    thirds = np.array([np.mean(part, axis=0) for part in np.array_split(values, 3)])
    drift = SURE * scene.noise * np.sqrt(6.0 / len(values))
    allowed = np.maximum(SHARE * allowance(scene), drift)
    return bool(np.all(np.ptp(thirds, axis=0) <= allowed))

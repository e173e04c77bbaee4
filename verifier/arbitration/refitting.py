"""Thresholds at which the robot's decisions agree most, and the values that agree no worse."""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.machine import evaluate
from verifier.arbitration.choosing import RuleChooser
from verifier.arbitration.decisions import Decisions
from verifier.arbitration.shares import is_worse
from verifier.report.report import Interval

TRIED: Final = 48
"""Values between which a threshold is looked for more closely."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Scan:
    """A threshold moved by itself: the best value, and who agrees then.

    level: values between which as many agree. interval: values that are not shown to be worse.
    """

    entry: str
    value: float
    level: tuple[float, float]
    interval: Interval
    agrees: Booleans


@final
@dataclass(frozen=True, slots=True)
class Scales:
    """slowness: decisions nearer than this are one episode. confidence: of every comparison."""

    slowness: float
    confidence: float


def agreeing(chooser: RuleChooser, decisions: Decisions) -> Booleans:
    """Which judged decisions the robot takes as the chooser."""
    agrees: Booleans = (chooser(decisions) == decisions.chosen) & decisions.judged
    return agrees


def refitted(chooser: RuleChooser, decisions: Decisions, scales: Scales) -> RuleChooser:
    """The thresholds moved, one by one, as long as that explains decisions that differ."""
    for _ in range(2 * len(chooser.values)):
        now = agreeing(chooser, decisions)
        if bool(now[decisions.judged].all()):
            break
        scans = [scan(chooser, entry, decisions, scales) for entry in chooser.values]
        best = max(scans, key=lambda each: int(each.agrees.sum()), default=None)
        if best is None or not is_better(best.agrees, now, scales):
            break
        chooser = chooser.moved(best.entry, best.value)
    return chooser


def is_better(one: Booleans, other: Booleans, scales: Scales) -> bool:
    """Whether `one` has more episodes right than chance would give it."""
    gained, lost = np.flatnonzero(one & ~other), np.flatnonzero(other & ~one)
    return is_worse(gained, lost, scales.slowness, scales.confidence)


def scan(chooser: RuleChooser, entry: str, decisions: Decisions, scales: Scales) -> Scan:
    """One threshold moved over all that was read where it is compared."""
    readings = _readings(chooser, entry, decisions)
    line = _Line(chooser, entry, decisions, readings)
    best = line.best()
    agrees = line.agrees(best)
    first = line.last_no_worse(best, 0, agrees, scales)
    last = line.last_no_worse(best, readings.size, agrees, scales)
    level_first, level_last = line.level(best)
    low, high = line.gap(level_first)[0], line.gap(level_last)[1]
    own = chooser.values[entry]
    is_level = low < own < high
    value = own if is_level else line.middle(level_first, level_last)
    return Scan(entry, value, (low, high), Interval(line.gap(first)[0], line.gap(last)[1]), agrees)


def _readings(chooser: RuleChooser, entry: str, decisions: Decisions) -> Array:
    """The distinct values, ascending, that are compared with the threshold."""
    codes = [each.reading for each in chooser.opened.comparisons if each.entry == entry]
    values = evaluate(codes, chooser.register, decisions.register[decisions.judged])
    found: Array = np.unique(values[np.isfinite(values)])
    return found


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Line:
    """Gap j, from 0 to the number of readings, is below reading j and above reading j - 1."""

    chooser: RuleChooser
    entry: str
    decisions: Decisions
    readings: Array

    def gap(self, place: int) -> tuple[float, float]:
        """Its ends; infinite beyond all readings."""
        low = float(self.readings[place - 1]) if place > 0 else -np.inf
        high = float(self.readings[place]) if place < self.readings.size else np.inf
        return low, high

    def middle(self, first: int, last: int) -> float:
        """A value in the middle of some gaps; beyond all readings just outside."""
        low, high = self.gap(first)[0], self.gap(last)[1]
        if np.isinf(low) and np.isinf(high):
            return self.chooser.values[self.entry]
        if np.isinf(low):
            return high - 1e-6 * max(1.0, abs(high))
        if np.isinf(high):
            return low + 1e-6 * max(1.0, abs(low))
        return 0.5 * (low + high)

    def agrees(self, place: int) -> Booleans:
        """Who agrees with the threshold in that gap."""
        moved = self.chooser.moved(self.entry, self.middle(place, place))
        return agreeing(moved, self.decisions)

    def best(self) -> int:
        """The gap with which most agree; of several the nearest to the spec's value."""
        own = int(np.searchsorted(self.readings, self.chooser.values[self.entry]))
        first, last, best = 0, self.readings.size, own
        while True:
            places = np.unique(np.append(np.linspace(first, last, TRIED).astype(int), best))
            counts = np.array([int(self.agrees(int(place)).sum()) for place in places])
            most = places[counts == counts.max()]
            best = int(most[np.argmin(np.abs(most - own))])
            if last - first < TRIED:
                return best
            at = int(np.searchsorted(places, best))
            first = int(places[max(at - 1, 0)])
            last = int(places[min(at + 1, places.size - 1)])

    def level(self, best: int) -> tuple[int, int]:
        """The gaps around the best one with which as many agree."""
        most = int(self.agrees(best).sum())
        ends = []
        for step in (-1, 1):
            place = best
            for _ in range(TRIED):
                following = place + step
                if not 0 <= following <= self.readings.size:
                    break
                if int(self.agrees(following).sum()) < most:
                    break
                place = following
            ends.append(place)
        return ends[0], ends[1]

    def last_no_worse(self, best: int, end: int, agrees: Booleans, scales: Scales) -> int:
        """The gap farthest towards `end` that is not shown to be worse than the best."""

        def is_no_worse(place: int) -> bool:
            return not is_better(agrees, self.agrees(place), scales)

        sign = 1 if end > best else -1
        near, reach = best, 1
        while near != end:
            far = min(best + reach, end) if sign > 0 else max(best - reach, end)
            if not is_no_worse(far):
                break
            near, reach = far, 2 * reach
        else:
            return end
        while abs(far - near) > 1:
            middle = (near + far) // 2
            near, far = (middle, far) if is_no_worse(middle) else (near, middle)
        return near


def roundest(level: tuple[float, float], scale: float, value: float) -> float:
    """The shortest decimal number of units strictly between two values; `value` where one is not.

    >>> roundest((0.494, 0.495), 1.0, 0.4945), roundest((0.2, 0.9), 1.0, 0.55)
    (0.4945, 0.5)
    """
    low, high = level[0] / scale, level[1] / scale
    if not np.isfinite(high - low):
        return value
    for digits in range(7):
        near = round(0.5 * (low + high), digits)
        if low < near < high:
            return near * scale
    return value


def later(decisions: Decisions, samples: int) -> Decisions:
    """What was read beside what was chosen so many samples later; the ends are not judged."""
    chosen: Integers = np.roll(decisions.chosen, -samples)
    judged = decisions.judged & np.roll(decisions.judged, -samples)
    if samples > 0:
        judged[-samples:] = False
    elif samples < 0:
        judged[:-samples] = False
    return replace(decisions, chosen=chosen, judged=judged)

"""Inputs as functions of time, which can be late, lag, and be averaged over integration steps.

A course holds each value until the next one. The integrator takes its mean over each step, which
follows a delay smoothly where samples alone would jump from one to the next.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from scipy.signal import lfilter

from runtime.arrays import Array

FINE: Final = 0.5
"""A lag is worked out in steps of this share of the sample period."""
MOST_STEPS: Final = 200_000


@final
@dataclass(frozen=True, eq=False, slots=True)
class Course:
    """`values` (T,) from `times` (T,) on; then `shift` seconds later, through a lag of `lag` s."""

    times: Array
    values: Array
    shift: float = 0.0
    lag: float = 0.0


def means(course: Course, times: Array) -> Array:
    """The mean (..., S) of the course over each step of `times` (..., S + 1); a step may be 0 s."""
    knots, area = _area(course) if course.lag > 0.0 else _held_area(course)
    at = times - course.shift
    inside = np.interp(at, knots, area)
    first, last = _ends(course, knots, area)
    inside = inside + np.minimum(at - knots[0], 0.0) * first
    inside = inside + np.maximum(at - knots[-1], 0.0) * last
    steps = np.diff(times, axis=-1)
    still = steps <= 0.0
    return np.asarray(np.diff(inside, axis=-1) / np.where(still, 1.0, steps))


def _held_area(course: Course) -> tuple[Array, Array]:
    area = np.cumsum(course.values[:-1] * np.diff(course.times))
    return course.times, np.concatenate([[0.0], area])


def _area(course: Course) -> tuple[Array, Array]:
    """The integral of the lagged course, on even steps."""
    duration = float(course.times[-1] - course.times[0])
    step = max(FINE * float(np.median(np.diff(course.times))), duration / MOST_STEPS)
    knots = course.times[0] + step * np.arange(int(np.ceil(duration / step)) + 1)
    even = means(Course(course.times, course.values), knots)
    keep = float(np.exp(-step / course.lag))
    # Over a step with input u, y goes from y0 to u + (y0 - u) keep.
    ends, _ = lfilter([1.0 - keep], [1.0, -keep], even, zi=[keep * even[0]])
    begins = np.concatenate([even[:1], ends[:-1]])
    area = even * step + (begins - even) * course.lag * (1.0 - keep)
    return knots, np.concatenate([[0.0], np.cumsum(area)])


def _ends(course: Course, knots: Array, area: Array) -> tuple[float, float]:
    """What holds before the first and after the last knot."""
    if course.lag > 0.0:
        return float(course.values[0]), float((area[-1] - area[-2]) / (knots[-1] - knots[-2]))
    return float(course.values[0]), float(course.values[-1])

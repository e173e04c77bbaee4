"""Learning curves: what tests showed, against how many problems were tried before."""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from lcs.arrays import Array, Booleans, Integers
from lcs.course import Course
from lcs.problems.rewards import RIGHT, WRONG

REWARD_RANGE: Final = RIGHT - WRONG


@final
@dataclass(frozen=True, eq=False, slots=True)
class Curve:
    """What K tests showed, in their order, all (K,).

    tries: problems tried before each test. right: whether its action was the right one.
    error: |expected - given reward| as a share of the range of rewards.
    """

    tries: Integers
    right: Booleans
    error: Array

    def until(self, tries: float) -> int:
        """How many tests there were until so many problems had been tried."""
        return int(np.searchsorted(self.tries, tries, side="right"))


def curve_of(course: Course, right: Integers, reward_range: float = REWARD_RANGE) -> Curve:
    """The tests of a course of T cycles; right (T,): the right action of each."""
    tests = course.is_test
    return Curve(
        tries=tries_of(course)[tests],
        right=(course.action == right)[tests],
        error=course.error[tests] / reward_range,
    )


def tries_of(course: Course) -> Integers:
    """Problems tried so far, after each cycle (T,); those that had to be tried count, too."""
    counted: Integers = np.cumsum(~course.is_test)
    return counted


def over_last(values: Array | Booleans, window: int) -> Array:
    """The mean of each value (K,) and those before it, so many at most."""
    total = np.concatenate([[0.0], np.cumsum(values, dtype=np.float64)])
    ends = np.arange(1, len(values) + 1)
    begins = np.maximum(ends - window, 0)
    mean: Array = (total[ends] - total[begins]) / (ends - begins)
    return mean

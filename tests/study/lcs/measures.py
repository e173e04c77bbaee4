"""What section 4.4 says of a run, in numbers."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from lcs.curves import Curve, over_last, tries_of
from tests.study.lcs.runs import Run

PLACES: Final = (10_000, 15_000, 35_000, 50_000)
"""Explore problems after which the thesis, or its readings, state a performance."""

NEAR: Final = 1_250
"""The last 1,000 tests reach back 10,000 explore problems: too far where learning is quick."""

LAST: Final = 10_000
"""Tests at the end of a run."""


@final
@dataclass(frozen=True, slots=True)
class Measured:
    """A run in numbers.

    of_1000, of_50: the share of right tests, of so many, at each of `PLACES`; NaN where it never
    came so far. near: the tests within `NEAR` explore problems of each: right ones, and how many.
    last: right ones of the last `LAST` tests, of fewer where there were fewer.
    fresh: the share of fresh problems, with inputs that no rule covers as wrong.
    peak, peak_at: the most rules, and after how many explore problems. final: rules at the end.
    cycles: how many there were.
    """

    of_1000: tuple[float, ...]
    of_50: tuple[float, ...]
    near: tuple[tuple[int, int], ...]
    last: int
    fresh: float
    peak: int
    peak_at: int
    final: int
    births: int
    deaths: int
    cycles: int
    seconds: float


def measured(run: Run, fresh: int) -> Measured:
    """The numbers of a run that was asked so many fresh problems."""
    curve, course = run.curve, run.course
    tries = tries_of(course)
    top = int(np.argmax(course.rules))
    return Measured(
        of_1000=tuple(performance(curve, place, 1000) for place in PLACES),
        of_50=tuple(performance(curve, place, 50) for place in PLACES),
        near=tuple(counted_near(curve, place) for place in PLACES),
        last=int(np.sum(curve.right[-LAST:])),
        fresh=run.fresh / fresh,
        peak=int(course.rules[top]),
        peak_at=int(tries[top]),
        final=int(course.rules[-1]),
        births=int(course.births[-1]),
        deaths=int(course.deaths[-1]),
        cycles=len(course.kind),
        seconds=run.seconds,
    )


def performance(curve: Curve, tries: int, window: int) -> float:
    """The share of right tests among the last ones, after so many explore problems."""
    if not curve.tries.size or curve.tries[-1] < tries:
        return float("nan")
    return float(over_last(curve.right, window)[curve.until(tries) - 1])


def counted_near(curve: Curve, tries: int) -> tuple[int, int]:
    """The right tests within `NEAR` explore problems, and how many there were."""
    right = curve.right[curve.until(tries - NEAR) : curve.until(tries + NEAR)]
    return int(np.sum(right)), len(right)


def spread(values: Sequence[float]) -> tuple[float, float, float]:
    """The least, the median and the largest."""
    return float(np.min(values)), float(np.median(values)), float(np.max(values))

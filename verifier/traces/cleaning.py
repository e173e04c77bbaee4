"""Samples into order: sorted, without repetitions, on one run of the clock; all of it counted."""

from bisect import bisect_right
from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Booleans, Integers
from verifier.traces.trace import Loss

JUMP = 1_000_000_000
"""Nanoseconds. A step back by less is a late message, by more a clock that was set back."""

LEAST_GAP = 500_000_000
GAP_PERIODS = 5


@final
@dataclass(frozen=True, eq=False, slots=True)
class Ordering:
    """rows: which samples to take, in this order; their times increase strictly.

    None where these are all of them as they stand, as in most logs, of which some are long.
    """

    rows: Integers | None
    losses: tuple[Loss, ...]
    notes: tuple[str, ...]


def order(topic: str, times: Integers, usable: Booleans) -> Ordering:
    """The order of samples by their times (T,) in nanoseconds, of those that are `usable`."""
    if usable.all() and (times[1:] > times[:-1]).all():
        return Ordering(None, (), tuple(gap_notes(topic, times)))
    rows = np.flatnonzero(usable)
    losses, notes = [], []
    if unusable := times.size - rows.size:
        losses.append(Loss("samples without a stamp", unusable, topic))
    kept = _one_run(times[rows])
    if jumped := int((~kept).sum()):
        losses.append(Loss("clock set back", jumped, f"{topic}: samples off the longest run"))
    rows = rows[kept]
    if late := int((np.diff(times[rows]) < 0).sum()):
        notes.append(f"{topic}: {late} samples out of order, sorted")
    rows = rows[np.argsort(times[rows], kind="stable")]
    first = np.ones(rows.size, dtype=np.bool_)
    first[1:] = np.diff(times[rows]) > 0
    if repeated := int((~first).sum()):
        losses.append(Loss("repeated times", repeated, f"{topic}: the first of each is kept"))
    rows = rows[first]
    notes += gap_notes(topic, times[rows])
    return Ordering(rows, tuple(losses), tuple(notes))


def gap_notes(topic: str, times: Integers) -> list[str]:
    """A sentence about the gaps in the increasing `times` (T,), if there are any."""
    steps = np.diff(times)
    if steps.size < 2:
        return []
    widest = int(np.argmax(steps))
    largest, after = steps[widest] / 1e9, float(times[widest] - times[0]) / 1e9
    # From here on the steps stand in no order.
    period = float(np.median(steps, overwrite_input=True))
    count = np.count_nonzero(steps > max(GAP_PERIODS * period, LEAST_GAP))
    if not count:
        return []
    gaps = "1 gap" if count == 1 else f"{count} gaps"
    return [f"{topic}: {gaps}, the largest {largest:.3g} s after {after:.4g} s"]


def longest_run(times: Integers) -> Integers:
    """Rows of a longest non-decreasing subsequence (patience sorting, O(T log T))."""
    values = times.tolist()
    ends: list[int] = []
    rows: list[int] = []
    previous = [-1] * len(values)
    for row, value in enumerate(values):
        place = bisect_right(ends, value)
        previous[row] = rows[place - 1] if place else -1
        if place == len(ends):
            ends.append(value)
            rows.append(row)
        else:
            ends[place] = value
            rows[place] = row
    chain = []
    row = rows[-1] if rows else -1
    while row >= 0:
        chain.append(row)
        row = previous[row]
    return np.array(chain[::-1], dtype=np.int64)


def _one_run(times: Integers) -> Booleans:
    """Which samples belong to the longest run of the clock.

    That is a longest non-decreasing subsequence, and every sample that is merely late beside it.
    """
    kept = np.ones(times.size, dtype=np.bool_)
    if not (np.diff(times) < -JUMP).any():
        return kept
    run = longest_run(times)
    before = np.searchsorted(run, np.arange(times.size), side="right") - 1
    low = times[run[np.maximum(before, 0)]]
    high = times[run[np.minimum(before + 1, run.size - 1)]]
    return (times >= low - JUMP) & (times <= high + JUMP) | np.isin(np.arange(times.size), run)

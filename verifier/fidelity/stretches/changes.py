"""When the measured mode changed, and within which time the log tells so.

A mode that is logged with every sample shows a change at the first sample of the new mode: it
happened after the sample before, and is taken to have happened half way between. A mode that is
logged only when it changes has the stamp of the change itself.
"""

from dataclasses import dataclass, replace
from typing import final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from verifier.traces.trace import Series

EVENTS = 0.9
"""A series in which more than this share of the samples differ from the one before is a log of
changes."""

INSIDE = 1e-3
"""A change stays this share of its doubt away from the samples beside it."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Changes:
    """K changes of mode.

    times (K,): in the middle of the `doubt` (K,) seconds that the log leaves. left, entered (K,):
    indices of modes.
    """

    times: Array
    doubt: Array
    left: Integers
    entered: Integers

    def __len__(self) -> int:
        """How many there are."""
        return len(self.times)

    @property
    def since(self) -> Array:
        """When each was surely still to come."""
        return self.times - self.doubt / 2.0

    @property
    def until(self) -> Array:
        """When each had surely happened."""
        return self.times + self.doubt / 2.0


def no_changes() -> Changes:
    """None at all."""
    return Changes(np.zeros(0), np.zeros(0), np.zeros(0, np.int64), np.zeros(0, np.int64))


def merged(first: Changes, second: Changes) -> Changes:
    """All changes of both, in order of time."""
    times = np.concatenate([first.times, second.times])
    order = np.argsort(times, kind="stable")
    return Changes(
        times=times[order],
        doubt=np.concatenate([first.doubt, second.doubt])[order],
        left=np.concatenate([first.left, second.left])[order],
        entered=np.concatenate([first.entered, second.entered])[order],
    )


def changes_in(series: Series | None) -> Changes:
    """The changes of a mode, from a series whose changes stand in the middle of their doubt.

    None where the mode is not in the trace.
    """
    if series is None:
        return no_changes()
    found = _differing(series)
    doubt = np.zeros(len(series.times))
    stamped = _stamped(series)
    doubt[stamped] = 2.0 * (series.times[stamped] - series.times[stamped - 1])
    values = np.rint(series.values).astype(np.int64)
    return Changes(series.times[found], doubt[found], values[found - 1], values[found])


def halved(series: Series) -> Series:
    """The series of a mode with its changes moved to the middle of the doubt about them.

    `changes_in` reads the doubt off the series that it gives.
    """
    found = _stamped(series)
    times = np.array(series.times)
    times[found] -= (times[found] - times[found - 1]) / 2.0
    return replace(series, times=times)


def told(series: Series, times: Array, is_sure: Booleans) -> Series:
    """The series with its changes at `times` (K,), without any doubt where they are sure.

    Such a change has a sample of the old mode right before it.
    """
    found, changes = _differing(series), changes_in(series)
    margin = INSIDE * changes.doubt
    at = np.clip(times, changes.since + margin, changes.until - margin)
    moved = np.array(series.times)
    moved[found] = at
    doubted = is_sure & (changes.doubt > 0.0)
    extra, before = at[doubted] - margin[doubted] / 2.0, series.values[found - 1][doubted]
    order = np.argsort(np.concatenate([moved, extra]), kind="stable")
    values = np.concatenate([series.values, before])
    return replace(series, times=np.concatenate([moved, extra])[order], values=values[order])


def _differing(series: Series) -> Integers:
    """The samples that differ from the one before."""
    return np.flatnonzero(np.diff(series.values) != 0.0) + 1


def _stamped(series: Series) -> Integers:
    """The samples at which a change shows; none where only changes are logged."""
    found = _differing(series)
    is_event_log = len(found) > EVENTS * max(len(series.values) - 1, 1)
    return np.zeros(0, np.int64) if is_event_log else found

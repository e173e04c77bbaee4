"""Time in whole steps: what is a multiple of the step, and who is due at an instant."""

from collections.abc import Sequence
from heapq import heapify, heapreplace
from typing import Final, final

CLOSE: Final = 1e-6
"""By how much of a step a duration may miss a whole number of steps (decimal rounding)."""


def whole_steps(seconds: float, step: float) -> int:
    """How many steps `seconds` are.

    >>> whole_steps(0.05, 0.05 / 12)
    12

    Raises:
        ValueError: they are no whole number of steps, or negative.
    """
    count = round(seconds / step)
    if seconds < 0.0 or abs(seconds / step - count) > CLOSE:
        raise ValueError(f"{seconds!r} s is no multiple of the step, {step!r} s")
    return count


@final
class Clock:
    """Who is due when: things that happen at every multiple of their own period, from 0.

    A heap of (instant, who), so that an instant at which nobody is due costs one comparison.
    Those due at one instant come in the order in which they were given.
    """

    def __init__(self, periods: Sequence[int]) -> None:
        assert all(period > 0 for period in periods), "periods are at least one step"
        self._periods = tuple(periods)
        self._queue = [(0, who) for who in range(len(periods))]
        heapify(self._queue)

    @property
    def next_due(self) -> int | None:
        """The next instant at which somebody is due; None where there is nobody."""
        return self._queue[0][0] if self._queue else None

    def due(self, instant: int) -> list[int]:
        """Who is due at `instant`, which is not after `next_due`; they are due again later."""
        found = []
        while self._queue and self._queue[0][0] <= instant:
            when, who = self._queue[0]
            heapreplace(self._queue, (when + self._periods[who], who))
            found.append(who)
        return found

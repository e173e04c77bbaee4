"""A recording's decisions in stretches: one choice, one rule; how each began, how near it came."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array
from verifier.deciding.margins import Margins, margins_of
from verifier.deciding.moments import Moments, choices_if


@final
@dataclass(frozen=True, slots=True)
class Near:
    """A read, what it was (SI), by how much it would have to change, and what is chosen then.

    Of a discrete read `change` is the index of the value that it would have to have.
    """

    read: int
    value: float
    change: float
    share: float
    becomes: int


@final
@dataclass(frozen=True, slots=True)
class Change:
    """A read that by itself made the choice another one, from one decision to the next; SI."""

    read: int
    before: float
    after: float


@final
@dataclass(frozen=True, slots=True)
class Stretch:
    """Decisions that follow one another, all alike.

    first, last: of the decisions. start, end: seconds; it ends where the next one begins, the last
    one a usual period after its last decision. chosen,
    expected: by the robot and by the spec, -1 for nothing. place: of the rule that decides by the
    spec, -1 for none. agrees: whether they are one, or were not judged. began: what alone made
    the spec's choice so; empty at the beginning and where several had to change. nearest: the
    moment at which another choice was nearest, and by which read; -1 where nothing read alone
    changes it.
    """

    first: int
    last: int
    start: float
    end: float
    chosen: int
    expected: int
    place: int
    agrees: bool
    began: tuple[Change, ...]
    nearest_at: int
    nearest: Near | None

    @property
    def decisions(self) -> int:
        """How many."""
        return self.last - self.first + 1


def stretches_of(moments: Moments, margins: Margins | None) -> tuple[Stretch, ...]:
    """All stretches in order; margins: of every decision, None of an arbiter that has to run."""
    decisions = moments.decisions
    count = decisions.times.size
    kinds = np.stack([decisions.chosen, moments.expected, moments.places, moments.agrees], axis=1)
    begins = np.flatnonzero(np.any(kinds[1:] != kinds[:-1], axis=1)) + 1
    firsts = [0, *begins.tolist()] if count else []
    found = []
    for first, following in zip(firsts, [*firsts[1:], count], strict=True):
        is_last = following == count
        end = decisions.times[-1] + decisions.period if is_last else decisions.times[following]
        at, near = _nearest(moments, margins, first, following)
        found.append(
            Stretch(
                first=first,
                last=following - 1,
                start=float(decisions.times[first]),
                end=float(end),
                chosen=int(decisions.chosen[first]),
                expected=int(moments.expected[first]),
                place=int(moments.places[first]),
                agrees=bool(moments.agrees[first]),
                began=_began(moments, first) if margins is not None else (),
                nearest_at=at,
                nearest=near,
            )
        )
    return tuple(found)


def near_at(moments: Moments, margins: Margins, row: int, at: int) -> tuple[Near, ...]:
    """All that would change the decision `at`, which is `row` of the margins, the nearest first."""
    found = [
        Near(
            k,
            float(moments.decisions.register[at, k]),
            float(margins.change[row, k]),
            float(margins.share[row, k]),
            int(margins.becomes[row, k]),
        )
        for k in range(margins.change.shape[1])
        if not np.isnan(margins.change[row, k])
    ]
    return tuple(sorted(found, key=lambda near: near.share))


def _nearest(
    moments: Moments, margins: Margins | None, first: int, following: int
) -> tuple[int, Near | None]:
    """When in the stretch another choice was nearest, and by which read."""
    if margins is None:
        return -1, None
    least = margins.share[first:following].min(axis=1, initial=np.inf)
    at = first + int(least.argmin())
    near = near_at(moments, margins, at, at)
    return (at, near[0]) if near else (-1, None)


def _began(moments: Moments, first: int) -> tuple[Change, ...]:
    """The reads without whose last change the spec's choice would not be what it is."""
    expected = moments.expected
    if first == 0 or expected[first] == expected[first - 1]:
        return ()
    register = moments.decisions.register
    reads = len(moments.arbiter.reads)
    moved = np.repeat(register[first][None], reads, axis=0)
    places = np.arange(reads)
    moved[places, places] = register[first - 1, :reads]
    then = choices_if(moments, moved, np.full(reads, first))
    return tuple(
        Change(k, float(register[first - 1, k]), float(register[first, k]))
        for k in np.flatnonzero(then != expected[first]).tolist()
    )


def whole_margins(moments: Moments) -> Margins:
    """The margins of all decisions."""
    return margins_of(moments, np.arange(moments.decisions.times.size))


def decision_at(times: Array, seconds: float) -> int:
    """The last decision at or before an instant; the first where there is none."""
    return max(int(np.searchsorted(times, seconds + 1e-9, "right")) - 1, 0)


def within(stretches: Sequence[Stretch], start: float, end: float) -> tuple[Stretch, ...]:
    """Those that reach into a span of time."""
    return tuple(each for each in stretches if each.end >= start and each.start <= end)

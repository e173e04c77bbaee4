"""Courses: functions of time in straight pieces, with jumps, and what temporal logic does to them.

A course is continuous from the right, begins at `times[0]` and is constant after `times[-1]`.
All operations are exact but for rounding, and each works on whole arrays. That courses are closed
under them is Donze, Ferrere, Maler: Efficient Robust Monitoring for STL (2013), here with jumps:
the supremum over the closed window [t + a, t + b] is the maximum of the values at its two ends and
of both sides of each breakpoint inside, and is itself continuous from the right.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Integers
from verifier.requirements.sliding import clamped_backwards, range_maxima

BEYOND: Final = 1e300
"""Stands for infinity, so that differences stay numbers."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Course:
    """times (n,), strictly increasing; `before` and `after` (n,) are the limits from both sides.

    Between times[i] and times[i + 1] it is straight from after[i] to before[i + 1].
    """

    times: Array
    before: Array
    after: Array

    def values_at(self, times: Array) -> tuple[Array, Array]:
        """The limits from the left and from the right at `times`, none before the first."""
        if np.array_equal(times, self.times):
            return self.before, self.after
        piece = np.searchsorted(self.times, times, "right") - 1
        right = self.after[piece]
        is_here = self.times[piece] == times
        left = np.where(is_here, self.before[piece], right)
        inside = np.flatnonzero(~is_here & (piece < self.times.size - 1))
        left[inside] = right[inside] = self._in_pieces(piece[inside], times[inside])
        return left, right

    def _in_pieces(self, piece: Integers, times: Array) -> Array:
        """The values at `times` inside of pieces, of which none is the last."""
        begin = self.times[piece]
        share = (times - begin) / (self.times[piece + 1] - begin)
        start, end = self.after[piece], self.before[piece + 1]
        # Where both ends are one, rounding must not make them two.
        values: Array = np.where(start == end, start, start * (1.0 - share) + end * share)
        return values


def constant(value: float, start: float) -> Course:
    """The same for all time from `start`."""
    one = np.array([value])
    return Course(np.array([start]), one, one)


def steps(times: Array, values: Array) -> Course:
    """values[i] from times[i] on; times may repeat, then the last one counts."""
    return _tidied(times, np.concatenate([values[:1], values[:-1]]), values)


def negated(course: Course) -> Course:
    """Its negative."""
    return Course(course.times, -course.before, -course.after)


def greater(one: Course, other: Course) -> Course:
    """The greater of both at every instant."""
    times = np.union1d(one.times, other.times)
    (a_left, a_right), (b_left, b_right) = one.values_at(times), other.values_at(times)
    here, there = a_right[:-1] - b_right[:-1], a_left[1:] - b_left[1:]
    across = np.flatnonzero(np.sign(here) * np.sign(there) < 0.0)
    share = here[across] / (here[across] - there[across])
    crossings = times[across] + share * (times[across + 1] - times[across])
    height = a_right[across] * (1.0 - share) + a_left[across + 1] * share
    inside = (crossings > times[across]) & (crossings < times[across + 1])
    where, crossings, height = across[inside] + 1, crossings[inside], height[inside]
    return _tidied(
        np.insert(times, where, crossings),
        np.insert(np.maximum(a_left, b_left), where, height),
        np.insert(np.maximum(a_right, b_right), where, height),
    )


def less(one: Course, other: Course) -> Course:
    """The less of both at every instant."""
    return negated(greater(negated(one), negated(other)))


def advanced(course: Course, by: float) -> Course:
    """What the course will be `by` seconds later, from its own start on."""
    start = course.times[:1]
    moved = Course(course.times - by, course.before, course.after)
    later = moved.times > start[0]
    first = moved.values_at(start)[1]
    return _tidied(
        np.concatenate([start, moved.times[later]]),
        np.concatenate([first, moved.before[later]]),
        np.concatenate([first, moved.after[later]]),
    )


def highest_within(course: Course, first: float, last: float) -> Course:
    """Its supremum over the window [t + first, t + last] at every instant t."""
    if last <= first:
        return advanced(course, first)
    enters, leaves = course.times - last, course.times - first
    times = np.union1d(enters, leaves)
    times = np.concatenate([course.times[:1], times[times > course.times[0]]])
    left = np.searchsorted(leaves, times, "right")
    entered = np.searchsorted(enters, times, "right")
    tops = range_maxima(np.maximum(course.before, course.after), left, entered, -BEYOND)
    ends = greater(advanced(course, first), advanced(course, last))
    return greater(ends, steps(times, tops))


def highest_until(course: Course, first: float, end: float) -> Course:
    """Its supremum over [t + first, end] at every instant t; -BEYOND where there is no such."""
    cut = kept_until(course, end, -BEYOND)
    ahead = advanced(cut, first)
    tops = np.maximum.accumulate(np.maximum(cut.before, cut.after)[::-1])[::-1]
    leaves = cut.times - first
    start = cut.times[0]
    times = np.concatenate([[start], leaves[leaves > start]])
    after = np.searchsorted(leaves, times, "right")
    return greater(ahead, steps(times, np.append(tops, -BEYOND)[after]))


def holds_until(holds: Course, reached: Course) -> Course:
    """The supremum over t' >= t of the least of `reached` at t' and `holds` in [t, t').

    On a piece on which both are straight and do not cross it is max(reached, min(holds, c)) with a
    constant c: the least of `holds` at the piece's end and the greater there of `reached` and of
    what follows.
    """
    crossed = greater(holds, reached)  # its breakpoints include where they cross
    times = np.union1d(np.union1d(holds.times, reached.times), crossed.times)
    (h_left, h_right), (r_left, r_right) = holds.values_at(times), reached.values_at(times)
    least = np.minimum(h_right[:-1], h_left[1:])
    low = np.maximum(r_right[:-1], np.minimum(least, r_left[1:]))
    high = np.maximum(r_right[:-1], least)
    following = clamped_backwards(low, np.maximum(low, high), r_right[-1])
    levels = np.minimum(h_left[1:], np.maximum(r_left[1:], following[1:]))
    return greater(reached, less(holds, steps(times, np.append(levels, r_right[-1]))))


def kept_until(course: Course, end: float, then: float) -> Course:
    """The course up to `end`, that instant included, and `then` from there on."""
    if end < course.times[0]:
        return constant(then, float(course.times[0]))
    stop = end + 1e-13 * max(1.0, abs(end))
    inside = course.times <= end
    left, last = course.values_at(np.array([end]))
    return _tidied(
        np.concatenate([course.times[inside], [end, stop]]),
        np.concatenate([course.before[inside], left, last]),
        np.concatenate([course.after[inside], last, [then]]),
    )


def _tidied(times: Array, before: Array, after: Array) -> Course:
    """Without breakpoints that say nothing: instants that rounding made one, and level stretches.

    Of instants that are one, the left limit of the first and the right limit of the last count.
    """
    new = np.concatenate([[True], times[1:] > times[:-1]])
    firsts = np.flatnonzero(new)
    lasts = np.append(firsts[1:], times.size) - 1
    times, before, after = times[firsts], before[firsts], after[lasts]
    before[0] = after[0]
    level = np.zeros(times.size, dtype=np.bool_)
    level[1:-1] = (
        (after[:-2] == before[1:-1]) & (before[1:-1] == after[1:-1]) & (after[1:-1] == before[2:])
    )
    if times.size > 1:
        level[-1] = after[-2] == before[-1] == after[-1]
    return Course(times[~level], before[~level], after[~level])

"""The fewest of the candidates that hold what has to be held, with bounds of few digits."""

from typing import Final

import numpy as np

from lcs.arrays import Array, Booleans, Integers
from lcs.rules.candidates import Candidates, Examples, grown_box
from lcs.rules.cover import smallest_cover
from lcs.rules.deciding import boxes_hold
from lcs.rules.digits import snapped
from lcs.rules.kernels import growing

ROUNDS: Final = 5
"""Of growing chosen boxes again, at most."""

GIVE: Final = 0.01
"""By how much of the range a bound may give way to one of fewer digits, where others hold."""


def chosen(found: Candidates, seen: Examples, to_cover: Booleans) -> Integers:
    """Which candidates to take, so that all of `to_cover` (T,) are held.

    First the fewest that hold what was told, each by a box of its level; more are grown from them
    as long as that makes them fewer. Then, of the examples of which nothing was told, those that
    are in none of them need others, of any level.
    """
    told = to_cover & seen.is_told
    kept = _of_all_levels(found, seen, told)
    for _ in range(ROUNDS):
        _grow_again(found, kept, seen, told)
        fewer = _of_all_levels(found, seen, told)
        if len(fewer) >= len(kept):
            break
        kept = fewer
    left = np.flatnonzero(to_cover & ~seen.is_told)
    left = left[~_held(found, kept, seen, left).any(axis=0)]
    every = np.arange(len(found.level))
    held = _held(found, every, seen, left)
    more = smallest_cover(held, held.sum(axis=1)) if left.size else []
    return np.concatenate([kept, every[more]])


def _of_all_levels(found: Candidates, seen: Examples, told: Booleans) -> Integers:
    kept = [np.zeros(0, np.int64)]
    for level in sorted(set(found.level)):
        those = np.flatnonzero(np.array(found.level) == level)
        held = _held(found, those, seen, np.flatnonzero(told & (seen.level == level)))
        if held.any():
            kept.append(those[smallest_cover(held, held.sum(axis=1))])
    return np.concatenate(kept)


def _held(found: Candidates, those: Integers, seen: Examples, rows: Integers) -> Booleans:
    """Which of those candidates hold which examples, (C, K)."""
    lower, upper = found.boxes(those, seen.x.shape[1])
    return boxes_hold(lower, upper, seen.high, seen.x[rows])


def _grow_again(found: Candidates, kept: Integers, seen: Examples, told: Booleans) -> None:
    """Add the boxes that grow from what each of those kept alone holds.

    Espresso's reduce and expand.
    """
    levels = np.array(found.level, np.int64)[kept]
    for level in np.unique(levels).tolist():
        same = kept[levels == level]
        need = np.flatnonzero(told & (seen.level == level))
        held = _held(found, same, seen, need)
        is_alone = held.sum(axis=0) == 1
        for own in held:
            alone = need[own & is_alone]
            if alone.size:
                lower = seen.x[alone].min(axis=0)
                upper = np.minimum(np.nextafter(seen.x[alone].max(axis=0), np.inf), seen.high)
                found.add(*grown_box((lower, upper, level), alone, seen), level)


def settle(found: Candidates, kept: Integers, seen: Examples, *, few_digits: bool) -> None:
    """Move the bounds of the kept candidates, in place, to the middle between told examples.

    Or near to it, where numbers have few digits: a bound may give way a little over examples that
    other kept ones hold too. What was told another level is not taken in, and all examples that
    any of them held are still held.
    """
    everywhere = np.arange(len(seen.x))
    rows = everywhere[_held(found, kept, seen, everywhere).any(axis=0)]
    held = _held(found, kept, seen, rows)
    times = held.sum(axis=0)
    for k, c in enumerate(kept.tolist()):
        for i in range(seen.x.shape[1]):
            alone = seen.x[rows[held[k] & (times == 1)], i]
            box = found.lower[c], found.upper[c]
            _settle_interval(box, i, alone, seen, few_digits=few_digits)
            times -= held[k]
            held[k] = _held(found, kept[k : k + 1], seen, rows)[0]
            times += held[k]


def _settle_interval(
    box: tuple[Array, Array], i: int, alone: Array, seen: Examples, *, few_digits: bool
) -> None:
    """Both bounds of input i; alone (K,): the values of the examples that only this box holds."""
    around, (lower, upper) = np.zeros(4), box
    ends = lower, upper, seen.low, seen.high
    growing.gaps(seen.columns, seen.is_told, ends, i, around)
    below, first, last, above = around.tolist()
    low, high = float(seen.low[i]), float(seen.high[i])
    give = GIVE * (high - low)
    least, most = float(alone.min(initial=np.inf)), float(alone.max(initial=-np.inf))
    if min(first, least) > max(last, most):
        return  # nobody is in it that is not in others
    if lower[i] > low:
        below = max(below, low)
        near = below + (min(first, least) - below) / 2.0
        lower[i] = _placed(below, min(least, max(first, near + give)), near, few_digits=few_digits)
    if upper[i] < high:
        above = min(above, high)
        near = above - (above - max(last, most)) / 2.0
        upper[i] = _placed(max(most, min(last, near - give)), above, near, few_digits=few_digits)


def _placed(above: float, up_to: float, near: float, *, few_digits: bool) -> float:
    """A bound in (above, up_to], as near as may be."""
    if few_digits:
        return snapped(above, up_to, near)
    return near if above < near <= up_to else up_to

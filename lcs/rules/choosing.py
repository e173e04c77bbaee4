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


def chosen(found: Candidates, seen: Examples) -> Integers:
    """Which candidates to take; more are grown from them as long as that makes them fewer."""
    kept = _of_all_levels(found, seen)
    for _ in range(ROUNDS):
        for c in kept:
            _grow_again(found, int(c), kept, seen)
        fewer = _of_all_levels(found, seen)
        if len(fewer) >= len(kept):
            break
        kept = fewer
    return kept


def _of_all_levels(found: Candidates, seen: Examples) -> Integers:
    kept = []
    for level in sorted(set(found.level)):
        those = np.flatnonzero(np.array(found.level) == level)
        held = _held(found, those, seen.x[found.of == level], seen)
        kept.append(those[smallest_cover(held, held.sum(axis=1))])
    return np.concatenate(kept) if kept else np.zeros(0, np.int64)


def _held(found: Candidates, those: Integers, x: Array, seen: Examples) -> Booleans:
    lower, upper = found.boxes(those)
    return boxes_hold(lower, upper, seen.high, x)


def _grow_again(found: Candidates, c: int, kept: Integers, seen: Examples) -> None:
    """Add the box that grows from what candidate c alone holds (Espresso's reduce and expand)."""
    level = found.level[c]
    same = kept[np.array(found.level)[kept] == level]
    need = np.flatnonzero(found.of == level)
    held = _held(found, same, seen.x[need], seen)
    alone = need[held[same == c][0] & (held.sum(axis=0) == 1)]
    if not alone.size:
        return
    lower = seen.x[alone].min(axis=0)
    upper = np.minimum(np.nextafter(seen.x[alone].max(axis=0), np.inf), seen.high)
    found.add(*grown_box((lower, upper, level), alone, seen), level)


def snap(found: Candidates, kept: Integers, seen: Examples) -> None:
    """Give the kept candidates, in place, bounds of few digits; what was held is still held.

    A bound stays between the examples beside it, or gives way a little over those that other kept
    ones of its level hold too.
    """
    for level in set(found.level):
        same = [int(c) for c in kept if found.level[c] == level]
        x = seen.x[found.of == level]
        held = _held(found, np.array(same, np.int64), x, seen)
        for row, c in enumerate(same):
            for i in range(x.shape[1]):
                alone = x[held[row] & (held.sum(axis=0) == 1), i]
                _snap_interval(found.lower[c], found.upper[c], i, alone, seen)
                held[row] = _held(found, np.array([c]), x, seen)[0]


def _snap_interval(lower: Array, upper: Array, i: int, alone: Array, seen: Examples) -> None:
    """Both bounds of input i; alone (K,): the values of the examples that only this box holds."""
    around = np.zeros(4)
    growing.gaps(seen.columns, lower, upper, seen.low, seen.high, i, around)
    below, first, last, above = around.tolist()
    low, high = float(seen.low[i]), float(seen.high[i])
    give = GIVE * (high - low)
    least, most = float(alone.min(initial=np.inf)), float(alone.max(initial=-np.inf))
    if lower[i] > low:
        near = float(lower[i])
        lower[i] = snapped(max(below, low), max(first, min(least, near + give)), near)
    if upper[i] < high:
        near = float(upper[i])
        upper[i] = snapped(min(last, max(most, near - give)), min(above, high), near)

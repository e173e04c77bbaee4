"""Boxes of what an arbiter reads: as conditions say them, and whether others cover one.

Each read's domain is cut into *cells* wherever a condition may change: a value, what lies between
two, a value by name. A box is for each read the set of its cells, as the bits of a whole number.
"""

import math
from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass
from operator import and_
from typing import Final, TypeAlias, final

from runtime.program import Kind, State
from spec_schema.expressions.tree import COMPARISONS

Box: TypeAlias = tuple[int, ...]
MOST_PIECES: Final = 5_000
"""Into so many pieces a box is cut at most, to see whether others cover it."""
BEYOND: Final = 1
"""A cut at (value, BEYOND) leaves the value itself below it, one at (value, 0) above."""

_Cut: TypeAlias = tuple[float, int]
_CUT_AT: Final = {"lt": 0, "ge": 0, "le": BEYOND, "gt": BEYOND}


@final
@dataclass(frozen=True, slots=True)
class Limit:
    """A comparison of a read with a number (SI; of a discrete read, the index of its value).

    start, end: where it stands in its condition.
    """

    read: str
    op: str
    value: float
    start: int
    end: int

    def __str__(self) -> str:
        return f"{self.read} {COMPARISONS[self.op]} {self.value:g}"


def boxes_of(conditions: Sequence[Sequence[Limit]], reads: Sequence[State]) -> list[Box]:
    """For each condition (all of its limits hold) its box; one of them 0: it never holds."""
    columns = [_column(conditions, read) for read in reads]
    return [tuple(column[i] for column in columns) for i in range(len(conditions))]


def is_covered(box: Box, before: Sequence[Box]) -> bool:
    """Whether each point of a box lies in one of the others; False where that takes too long."""
    others = [one for one in before if _meet(box, one)]
    waiting, pieces = [(box, 0)], 0
    while waiting:
        piece, first = waiting.pop()
        found = next((i for i in range(first, len(others)) if _meet(piece, others[i])), None)
        pieces += 1
        if found is None or pieces > MOST_PIECES:
            return False
        waiting += [(part, found + 1) for part in _without(piece, others[found])]
    return True


def _meet(one: Box, other: Box) -> bool:
    return all(map(and_, one, other))


def _without(box: Box, other: Box) -> list[Box]:
    """What is left of a box, in boxes that have nothing in common."""
    left, within = [], list(box)
    for i, cells in enumerate(other):
        outside = within[i] & ~cells
        if outside:
            left.append((*within[:i], outside, *within[i + 1 :]))
        within[i] &= cells
    return left


def _column(conditions: Sequence[Sequence[Limit]], read: State) -> list[int]:
    """Of each condition the cells of one read."""
    own = [[limit for limit in each if limit.read == read.name] for each in conditions]
    if read.kind is Kind.DISCRETE:
        return [_values(limits, len(read.values)) for limits in own]
    least, most = (read.low, 0), (read.high, BEYOND)
    cuts = {_cut(limit) for limits in own for limit in limits}
    inner = sorted(cut for cut in cuts if least < cut < most)
    starts = [least, *inner]
    return [_cells(limits, starts, most) for limits in own]


def _cut(limit: Limit) -> _Cut:
    return limit.value, _CUT_AT[limit.op]


def _cells(limits: Sequence[Limit], starts: Sequence[_Cut], most: _Cut) -> int:
    """The cells that begin at `starts` and satisfy all limits."""
    first, last = 0, len(starts)
    for limit in limits:
        place = bisect_left(starts, _cut(limit)) if _cut(limit) < most else len(starts)
        if limit.op in {"gt", "ge"}:
            first = max(first, place)
        else:
            last = min(last, place)
    return sum(1 << cell for cell in range(first, last))


def _values(limits: Sequence[Limit], count: int) -> int:
    """The values of a discrete read that satisfy all limits."""
    found = (1 << count) - 1
    for limit in limits:
        one = 1 << int(limit.value) if _is_index(limit.value, count) else 0
        found &= one if limit.op == "eq" else ~one
    return found


def _is_index(value: float, count: int) -> bool:
    return math.isfinite(value) and value == int(value) and 0 <= value < count

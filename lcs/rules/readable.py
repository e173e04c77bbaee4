"""Rules with bounds that are short to read."""

import dataclasses
import math
from typing import Final

import numpy as np

from lcs.arrays import Array, Booleans
from lcs.rules.deciding import boxes_hold
from lcs.rules.digits import just_below, snapped
from lcs.rules.table import RuleTable

DIGITS: Final = 4
"""Of a bound, counted from the first of the input's range, where no examples say how many."""


def readable(table: RuleTable, inputs: Array | None = None) -> RuleTable:
    """The rules with bounds of few digits.

    inputs (T, n): no bound moves past the value of one of them, so that each rule holds on the
    same ones as before. Without them, bounds have as many decimals as four digits of the range.
    """
    lower, upper = table.lower.copy(), table.upper.copy()
    for i in range(lower.shape[1]):
        column = None if inputs is None else np.unique(inputs[:, i])
        low, high = float(table.low[i]), float(table.high[i])
        for bounds in (lower, upper):
            for r, bound in enumerate(bounds[:, i].tolist()):
                if low < bound < high:
                    bounds[r, i] = _short(bound, column, low, high)
    is_sliver = ~(lower < upper)
    lower[is_sliver], upper[is_sliver] = table.lower[is_sliver], table.upper[is_sliver]
    if inputs is not None:
        for i in range(lower.shape[1]):
            _read_alike(lower, upper, i, table.high, inputs)
    return dataclasses.replace(table, lower=lower, upper=upper)


def _read_alike(lower: Array, upper: Array, i: int, high: Array, inputs: Array) -> None:
    """Where one rule says `>= 0.9` and another `> 0.9` of an input, let them say the same.

    All `>= 0.9` if that can be, else `> 0.9` as far as can be: no example changes sides.
    """
    present = {*lower[:, i].tolist(), *upper[:, i].tolist()}
    for bound in sorted(present):
        above = math.nextafter(bound, math.inf)
        if above not in present or just_below(above) is None:
            continue
        moved, is_same = _moved(lower, upper, i, (above, bound), high, inputs)
        if not is_same.all():
            moved, is_same = _moved(lower, upper, i, (bound, above), high, inputs)
        lower[is_same], upper[is_same] = moved[0][is_same], moved[1][is_same]


def _moved(
    lower: Array, upper: Array, i: int, ends: tuple[float, float], high: Array, inputs: Array
) -> tuple[tuple[Array, Array], Booleans]:
    """Bounds of an input from one number to another, and which rules hold what they held (R,)."""
    old, new = ends
    moved_lower, moved_upper = lower.copy(), upper.copy()
    moved_lower[lower[:, i] == old, i] = new
    moved_upper[upper[:, i] == old, i] = new
    before = boxes_hold(lower, upper, high, inputs)
    after = boxes_hold(moved_lower, moved_upper, high, inputs)
    is_same = (before == after).all(axis=1) & (moved_lower < moved_upper).all(axis=1)
    return (moved_lower, moved_upper), np.asarray(is_same)


def _short(bound: float, column: Array | None, low: float, high: float) -> float:
    """The bound with few digits, strictly between the ends of the range."""
    if column is not None:
        at = int(np.searchsorted(column, bound))
        above = max(low, float(column[at - 1])) if at > 0 else low
        up_to = float(column[at]) if at < len(column) else math.nextafter(high, -math.inf)
        return snapped(above, min(up_to, math.nextafter(high, -math.inf)), bound)
    if just_below(bound) is not None or not math.isfinite(high - low):
        return bound
    step = math.floor(math.log10(high - low)) + 1 - DIGITS
    short = float(f"{round(bound / 10.0**step)}e{step}")
    return short if low < short < high else bound

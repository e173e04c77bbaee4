"""Rules with bounds that are short to read."""

import dataclasses
import math
from typing import Final

import numpy as np

from lcs.arrays import Array
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
    """Where one rule says `>= 0.9` and another `> 0.9` of an input, let both say the same.

    `>= 0.9` if that can be, else `> 0.9`; where an example would change sides, both stay.
    """
    present = {*lower[:, i].tolist(), *upper[:, i].tolist()}
    for bound in sorted(present):
        above = math.nextafter(bound, math.inf)
        if above not in present or just_below(above) is None:
            continue
        for old, new in ((above, bound), (bound, above)):
            moved_lower, moved_upper = lower.copy(), upper.copy()
            moved_lower[lower[:, i] == old, i] = new
            moved_upper[upper[:, i] == old, i] = new
            changed = (moved_lower != lower).any(axis=1) | (moved_upper != upper).any(axis=1)
            before = boxes_hold(lower[changed], upper[changed], high, inputs)
            after = boxes_hold(moved_lower[changed], moved_upper[changed], high, inputs)
            if np.array_equal(before, after) and (moved_lower < moved_upper)[changed].all():
                lower[:], upper[:] = moved_lower, moved_upper
                break


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

"""Lists whose bounds have few digits, and that decide as before wherever anything was lived."""

import dataclasses
import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from lcs.arrays import Array, Booleans
from lcs.policies.decision_list import DecisionList
from lcs.rules.digits import shortest_between

DIGITS: Final = 9
"""Of an input's range: places that differ beyond these are the same, by rounding."""
MARGIN: Final = 0.05
"""Of a gap between two lived places, on either side of a bound in it."""


def shortened(rules: DecisionList, x: Array) -> DecisionList:
    """The list with bounds of as few digits as leave each decision at places x (T, n) as it is.

    One bound after the other is moved within the gap between the places on its two sides that no
    earlier rule holds and that the rule's other bounds let in, to the number of fewest digits; of
    several to the one in the middle, so 0.5 where all places are 0 or 1. Without such a place
    beyond it, it is dropped.
    """
    decimals = [_decimals(column) for column in x.T]
    lower, upper, columns = (_rounded(each, decimals) for each in (rules.lower, rules.upper, x))
    made, left = dataclasses.replace(rules, lower=lower, upper=upper), columns.T.copy()
    for r in range(len(made)):
        is_bounded = np.isfinite(made.lower[r]) | np.isfinite(made.upper[r])
        bounded: list[int] = np.flatnonzero(is_bounded).tolist()
        inside = {i: _is_inside(made, r, i, left[i]) for i in bounded}
        outside = np.zeros(left.shape[1], np.int8)  # by how many bounds each is kept out
        for let_in in inside.values():
            outside += ~let_in
        for i in bounded:
            values, beside = left[i][outside == ~inside[i]], 10.0 ** -decimals[i]
            made.lower[r, i] = _lower(made.lower[r, i], values[values < made.upper[r, i]], beside)
            made.upper[r, i] = _upper(made.upper[r, i], values[values >= made.lower[r, i]], beside)
            outside += inside[i]
            inside[i] = _is_inside(made, r, i, left[i])
            outside -= inside[i]
        left = left[:, outside > 0]
    return made


def _is_inside(rules: DecisionList, rule: int, i: int, values: Array) -> Booleans:
    """Which values of an input (T,) the bounds of a rule let in."""
    inside: Booleans = (values >= rules.lower[rule, i]) & (values < rules.upper[rule, i])
    return inside


def _decimals(values: Array) -> int:
    """Decimals that tell `DIGITS` digits of the range of an input."""
    span = float(np.ptp(values)) if len(values) else 0.0
    return DIGITS - (math.ceil(math.log10(span)) if span > 0.0 else 0)


def _rounded(columns: Array, decimals: Sequence[int]) -> Array:
    """Columns (T, n), each rounded to its decimals."""
    pairs = zip(columns.T, decimals, strict=True)
    rounded: Array = np.column_stack([np.round(each, places) for each, places in pairs])
    return rounded


def _lower(bound: float, values: Array, beside: float) -> float:
    """A bound that lets in the same of the values, each x with bound <= x."""
    out, let_in = values[values < bound], values[values >= bound]
    return _between(out, let_in, bound, beside) if len(out) else -np.inf


def _upper(bound: float, values: Array, beside: float) -> float:
    """A bound that lets in the same of the values, each x with x < bound."""
    let_in, out = values[values < bound], values[values >= bound]
    return _between(let_in, out, bound, beside) if len(out) else np.inf


def _between(below: Array, above: Array, bound: float, beside: float) -> float:
    """A number of few digits that parts the values as the bound does, and is next to neither."""
    if not len(below) or not len(above):  # further from all, since one may have been rounded to it
        return bound + (beside if len(below) else -beside)
    low, high = float(below.max()), float(above.min())
    margin = MARGIN * (high - low)
    short = shortest_between(low + margin, high - margin, 0.5 * (low + high))
    return short if low < short <= high else high

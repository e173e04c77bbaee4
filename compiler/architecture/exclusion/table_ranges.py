"""What a column of a table can be where a behavior's ticks look it up, within its axes or beyond.

Ticks look a period ahead, so they may leave the table; it goes on there with the polynomials of the
cells at its edge, which grow with the cube of the way, and no multiple of its coefficients bounds
them. Sound for what is computed, not only for the real table:

* A value is the sum of coefficients c with weights w, products of one weight per axis. The weights
  of an axis sum to 1. In a cell none is negative, so the value lies between the least and the
  greatest of the coefficients that the box sees (`column_jets`, coarse).
* b cells beyond the edge the weights of an axis that are negative sum to -n(b): for a line the one
  weight -b; for a cubic B-spline (de Boor 1978) -b³/6 and, where it is negative, 2/3 - b² - b³/2.
  n rises with b, so its value at the far end of the box holds in all of it. The absolute weights of
  the axis sum to 1 + 2 n, those of all axes to the product of these: a value is off the middle of
  the coefficients by no more than their half width times that. Up to a cell beyond, `column_jets`
  bounds what the polynomials of the cells do, which is narrower where it sees few of them.
* Coordinates, weights and the sum are rounded. A product takes a few roundings per axis, the sum
  less than one per product, up to 4**5 of them; a coordinate is off by a few units in the last
  place, which an edge's weights follow with a slope of no more than their sum. All is less than
  2**-40 of the absolute weights' sum times the largest coefficient.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Final, TypeAlias

import numpy as np

from runtime.intervals import Interval
from runtime.jets import constant
from runtime.table import Axis, Method, Table
from runtime.table_bounds import column_jets, columns_of

Ends: TypeAlias = tuple[float, float]

ROUNDED: Final = 2.0**-40
"""More than roundings do to a value, in parts of the largest of what it is the sum of."""


def columns_over(table: Table, box: Mapping[str, Ends]) -> list[Ends]:
    """The least and the greatest value of each column where each axis lies in its ends.

    The narrower of two that hold: by the cells, and by the coefficients.
    """
    asked = [box[axis.name] for axis in table.axes]
    growth, within = 1.0, []
    for axis, (low, high) in zip(table.axes, asked, strict=True):
        out = 0.0 if axis.periodic else max(_beyond(axis, low), _beyond(axis, high))
        growth *= _growth(table.method, out)
        within.append((low, high) if axis.periodic else (_inside(axis, low), _inside(axis, high)))
    sizes = np.abs(table.coefficients).reshape(-1, table.coefficients.shape[-1]).max(axis=0)
    by_cells = _bounds(table, asked, coarse=False)
    by_coefficients = _bounds(table, within, coarse=True)
    found = []
    for fine, seen, size in zip(by_cells, by_coefficients, sizes.tolist(), strict=True):
        room = ROUNDED * growth * size
        middle, radius = 0.5 * (seen[0] + seen[1]), 0.5 * (seen[1] - seen[0])
        radius = radius * growth * (1.0 + ROUNDED) + room
        ends = max(fine[0] - room, middle - radius), min(fine[1] + room, middle + radius)
        found.append(ends if all(map(math.isfinite, ends)) else (-math.inf, math.inf))
    return found


def _bounds(table: Table, box: Sequence[Ends], *, coarse: bool) -> list[Ends]:
    """Of the real table; of what is far beyond its edges all numbers."""
    arguments = [constant(Interval(np.array([low]), np.array([high]))) for low, high in box]
    jets = column_jets(columns_of(table), arguments, 1, coarse=coarse)
    return [(float(jet.value.low[0]), float(jet.value.high[0])) for jet in jets]


def _inside(axis: Axis, value: float) -> float:
    return min(max(value, axis.low), axis.high)


def _beyond(axis: Axis, value: float) -> float:
    """How many cells a coordinate is beyond the nearest edge of a table, or a hair more."""
    out = max(axis.low - value, value - axis.high) / axis.step
    return out + ROUNDED * (abs(out) + axis.count) if out > 0.0 else 0.0


def _growth(method: Method, beyond: float) -> float:
    """The sum of the absolute weights of an axis, so many cells beyond its edge."""
    if method is Method.LINEAR:
        return 1.0 + 2.0 * beyond
    third = beyond * beyond * (1.0 + 0.5 * beyond) - 2.0 / 3.0
    return 1.0 + 2.0 * (beyond * beyond * beyond / 6.0 + max(0.0, third))

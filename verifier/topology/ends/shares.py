"""How well shares of a basin are known: of a cell on its border only the centre was followed.

m: number of axes. A cell on a border belongs to one side by its centre; what lies on the other side
of the border within it is at most half of it, as far as the border is resolved by the grid.
"""

import numpy as np

from runtime.arrays import Booleans, Integers


def share_within(inside: Booleans) -> float:
    """How far the share of the cells that are `inside` (n1, ..., nm) may be off: half its border.

    The border is counted on the side on which it has more cells.
    """
    ours = _at_border(inside)
    theirs = _at_border(~inside)
    return 0.5 * max(int(ours.sum()), int(theirs.sum())) / inside.size


def shares_within(labels: Integers, wanted: list[int]) -> list[float]:
    """The same for each of the `wanted` labels of the cells."""
    return [share_within(np.asarray(labels == label)) for label in wanted]


def _at_border(inside: Booleans) -> Booleans:
    """The cells inside that have a neighbour outside, along some axis."""
    border = np.zeros_like(inside)
    for axis in range(inside.ndim):
        rows = np.moveaxis(inside, axis, 0)
        found = np.moveaxis(border, axis, 0)
        found[:-1] |= rows[:-1] & ~rows[1:]
        found[1:] |= rows[1:] & ~rows[:-1]
    return border

"""Boxes in which nothing could be proved, as few as show where they are. m: axes; B: boxes."""

from typing import Final

import numpy as np

from runtime.arrays import Array, frozen
from verifier.topology.features import UndecidedBox
from verifier.topology.slices import Slice

COARSE: Final = 64
"""Boxes are gathered in so many parts of each axis."""

POINT: Final = 1.0 / 32.0
"""Neighbouring boxes that together are no longer than this share of the domain are one."""


def merged_boxes(view: Slice, low: Array, high: Array) -> tuple[UndecidedBox, ...]:
    """Boxes within the domain that cover the boxes low to high (B, m)."""
    if not len(low):
        return ()
    top = view.low + view.width
    low, high = np.clip(low, view.low, top), np.clip(high, view.low, top)
    cell = np.floor((0.5 * (low + high) - view.low) / view.width * COARSE)
    _, group = np.unique(cell, axis=0, return_inverse=True)
    groups = group.reshape(-1)
    hulls = [
        (low[groups == g].min(axis=0), high[groups == g].max(axis=0))
        for g in range(int(groups.max()) + 1)
    ]
    return tuple(UndecidedBox(frozen(a), frozen(b)) for a, b in _joined(hulls, view.width))


def _joined(boxes: list[tuple[Array, Array]], width: Array) -> list[tuple[Array, Array]]:
    """The boxes, those that touch and are small together made one."""
    done: list[tuple[Array, Array]] = []
    for low, high in boxes:
        a, b = low, high
        for other in list(done):
            first, last = np.minimum(a, other[0]), np.maximum(b, other[1])
            slack = 1e-9 * width
            touch = np.all((other[0] <= b + slack) & (other[1] >= a - slack))
            if touch and np.all(last - first <= POINT * width):
                done = [box for box in done if box is not other]
                a, b = first, last
        done.append((a, b))
    return done

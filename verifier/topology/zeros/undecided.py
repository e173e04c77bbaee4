"""Boxes in which nothing could be proved, as few as show where they are. m: axes; B: boxes."""

from typing import Final

import numpy as np

from runtime.arrays import Array, frozen
from verifier.topology.features import UndecidedBox
from verifier.topology.slices import Slice

COARSE: Final = {1: 64, 2: 64, 3: 16, 4: 8}
"""Boxes are gathered in so many parts of each axis, by the number of axes."""

POINT: Final = 1.0 / 32.0
"""Neighbouring boxes that together are no longer than this share of the domain are one."""

MANY: Final = 300
"""More parts than this are no single points, and stay as they are."""


def merged_boxes(view: Slice, low: Array, high: Array) -> tuple[UndecidedBox, ...]:
    """Boxes within the domain that cover the boxes low to high (B, m)."""
    if not len(low):
        return ()
    top = view.low + view.width
    low, high = np.clip(low, view.low, top), np.clip(high, view.low, top)
    parts = COARSE[len(view.axes)]
    cell = np.floor((0.5 * (low + high) - view.low) / view.width * parts)
    _, group = np.unique(cell, axis=0, return_inverse=True)
    groups = group.reshape(-1)
    shape = (int(groups.max()) + 1, low.shape[1])
    first, last = np.full(shape, np.inf), np.full(shape, -np.inf)
    np.minimum.at(first, groups, low)
    np.maximum.at(last, groups, high)
    hulls = list(zip(first, last, strict=True))
    joined = _joined(hulls, view.width) if len(hulls) <= MANY else hulls
    return tuple(UndecidedBox(frozen(a), frozen(b)) for a, b in joined)


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

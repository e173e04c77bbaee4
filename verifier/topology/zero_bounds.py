"""Where a zero that is proved for a box of controls can be for a smaller box of them.

The zero z(c) is the only one in a region for all controls c of the large box, so each contraction
by Krawczyk's operator over the smaller box holds it, too (Neumaier 1990, section 5.1). m: axes.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array
from runtime.enclosure import changes, enclosure_of, slopes
from verifier.topology.contraction import inverses_of, krawczyk, narrowed
from verifier.topology.slices import Slice

CONTRACTIONS: Final = 4
"""Each takes off what the smaller box of controls makes unnecessary; four leave rounding."""


def zero_within(view: Slice, controls: Array, low: Array, high: Array) -> tuple[Array, Array]:
    """Bounds (m,) of the zero in low to high (m,), for all controls in (2, p) low to high."""
    names = tuple(axis.name for axis in view.axes)
    field = enclosure_of(view.program, names, view.x, controls)
    low, high = low[None, :], high[None, :]
    for _ in range(CONTRACTIONS):
        centre = 0.5 * (low + high)
        radius = np.nextafter(np.maximum(high - centre, centre - low), np.inf)
        around = slopes(field, centre - radius, centre + radius)
        there = changes(field, centre, centre)
        found = krawczyk(centre, radius, there, around, inverses_of(around))
        smaller_low, smaller_high = narrowed(found, low, high)
        if not np.all(smaller_high - smaller_low < 0.9 * (high - low)):
            return smaller_low[0], smaller_high[0]
        low, high = smaller_low, smaller_high
    return low[0], high[0]

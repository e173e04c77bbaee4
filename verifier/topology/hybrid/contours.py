"""Level lines of sampled functions: the one place that knows contourpy."""

import contourpy
import numpy as np

from runtime.arrays import Array


def zero_lines(nodes: tuple[Array, ...], values: Array) -> tuple[Array, ...]:
    """Polylines (k, 2) along which `values` over two axes of nodes are zero, interpolated linearly.

    Cells with a value that is not finite are left out.
    """
    x, y = nodes
    masked = np.ma.masked_invalid(values.T)
    generator = contourpy.contour_generator(
        x, y, masked, name="serial", line_type=contourpy.LineType.Separate
    )
    return tuple(np.asarray(line, dtype=np.float64) for line in generator.lines(0.0))

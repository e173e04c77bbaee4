"""A lookup array that the user gives (the thesis's own form): nodes, values, and what is between.

Where the nodes are evenly spread over the domain the table is the field itself, with no error;
otherwise the array is interpolated between its own nodes and tabulated anew.
"""

import numpy as np
import scipy

from compiler.tabulate import Sampler
from runtime.arrays import Array
from runtime.program import Method


def is_even(nodes: Array, low: float, high: float, *, periodic: bool) -> bool:
    """Whether the nodes are exactly those that a table over [low, high] has."""
    count = len(nodes)
    step = (high - low) / (count if periodic else count - 1)
    return bool(np.allclose(nodes, low + step * np.arange(count), rtol=0.0, atol=1e-9 * step))


def between_nodes(nodes: tuple[Array, ...], values: Array, method: Method) -> Sampler:
    """The interpolant of `values` (n1, ..., nd, m) at uneven `nodes`, inside their box.

    cubic: a tensor-product spline with not-a-knot ends; linear: multilinear.
    """
    if method is Method.LINEAR:
        surface = scipy.interpolate.RegularGridInterpolator(nodes, values, method="linear")
        return lambda points: np.asarray(surface(points), dtype=np.float64)

    def sample(points: Array) -> Array:
        found = np.broadcast_to(values, (len(points), *values.shape))
        for at, place in zip(nodes, points.T, strict=True):
            weights = scipy.interpolate.make_interp_spline(at, np.eye(len(at)), k=3)(place)
            found = np.einsum("pn,pn...->p...", weights, found)
        return found

    return sample

"""A lookup array that the user gives (the thesis's own form): nodes, values, and what is between.

Where the nodes are evenly spread over the domain the table is the field itself, with no error;
otherwise the array is interpolated between its own nodes and tabulated anew.
"""

import numpy as np
import scipy

from compiler.tabulate import Sampler
from runtime.arrays import Array
from runtime.table import Method


def is_even(nodes: Array, low: float, high: float, *, periodic: bool) -> bool:
    """Whether the nodes are exactly those that a table over [low, high] has."""
    count = len(nodes)
    step = (high - low) / (count if periodic else count - 1)
    return bool(np.allclose(nodes, low + step * np.arange(count), rtol=0.0, atol=1e-9 * step))


def closed(
    nodes: tuple[Array, ...],
    values: Array,
    periodic: tuple[bool, ...],
    highs: tuple[float, ...],
) -> tuple[tuple[Array, ...], Array]:
    """Nodes and values with the upper end of every periodic axis, where its first value returns."""
    for i, turns in enumerate(periodic):
        if turns:
            first = np.take(values, [0], axis=i)
            values = np.concatenate([values, first], axis=i)
    ends = zip(nodes, periodic, highs, strict=True)
    return tuple(np.append(at, high) if turns else at for at, turns, high in ends), values


def between_nodes(
    nodes: tuple[Array, ...], values: Array, method: Method, periodic: tuple[bool, ...]
) -> Sampler:
    """The interpolant of `values` (n1, ..., nd, m) at uneven `nodes`, inside their box.

    cubic: a tensor-product spline with not-a-knot ends, or a periodic one; linear: multilinear.
    """
    if method is Method.LINEAR:
        surface = scipy.interpolate.RegularGridInterpolator(nodes, values, method="linear")
        return lambda points: np.asarray(surface(points), dtype=np.float64)

    def sample(points: Array) -> Array:
        found = np.broadcast_to(values, (len(points), *values.shape))
        for at, place, turns in zip(nodes, points.T, periodic, strict=True):
            weights = _weights(at, turns=turns)(place)
            found = np.einsum("pn,pn...->p...", weights, found)
        return found

    return sample


def _weights(at: Array, *, turns: bool) -> "scipy.interpolate.BSpline":
    """What each node's value counts for at a place along the axis."""
    unit = np.eye(len(at))
    if not turns:
        return scipy.interpolate.make_interp_spline(at, unit, k=3)
    unit[-1] = unit[0]  # the upper end is the lower one
    return scipy.interpolate.make_interp_spline(at, unit, k=3, bc_type="periodic")

"""Zeros that could not be proved: least places of the field, refined by Newton's method.

They show where in an undecided box the field vanishes as far as numbers can tell, and where the
tables come so near to zero that their error leaves it open. m: number of axes; g: the rates divided
by their largest size, so that |g| <= 1 in each component.
"""

from collections.abc import Sequence
from itertools import product
from typing import Final

import numpy as np

from runtime.arrays import Array, Booleans
from verifier.topology.features import Grid, UndecidedBox
from verifier.topology.slices import Slice, jacobians_at, rates_at, shortest, wrapped

ITERATIONS: Final = 60
"""Enough for double zeros, where Newton's method gains a factor of two a step."""

ZERO: Final = 1e-11
"""What |g| must fall below at a zero."""

LEAST_DAMPING: Final = 1e-15
"""Beside the size of the squared Jacobian: keeps singular systems solvable."""

ROUNDING: Final = 1e-15
"""Coordinates smaller than this share of the widths are zero."""

CANDIDATES: Final = 400
"""More starts than these come only from a continuum of zeros, which fewer show as well."""

APART: Final = 1e-6
"""Zeros closer than this share of the axes' widths are one."""

BLURRED: Final = 1e-3
"""Where the tables can't tell zero from a near miss, zeros this close are one."""


def zeros_in(view: Slice, boxes: Sequence[UndecidedBox], scale: Array) -> Array:
    """Zeros (k, m) in or beside the boxes, as far as numbers can tell."""
    if not boxes:
        return np.empty((0, len(view.axes)))
    low, high = np.stack([b.low for b in boxes]), np.stack([b.high for b in boxes])
    starts = 0.5 * (low + high)
    found = _refined(view, starts[:: 1 + len(starts) // CANDIDATES], scale)
    with np.errstate(invalid="ignore"):
        sharp = np.all(np.abs(rates_at(view, found)) <= ZERO * scale, axis=-1)
    slack = BLURRED * view.width
    beside = (found[:, None] >= low - slack) & (found[:, None] <= high + slack)
    sharp &= beside.all(axis=-1).any(axis=-1)
    return _ordered(_canonical(view, _merged(view, wrapped(view, found[sharp]), APART)))


def near_misses(view: Slice, grid: Grid, zeros: Array, scale: Array) -> Array:
    """Places (k, m) away from `zeros` where the tables are off by more than the rates are."""
    if not np.any(view.accuracy > 0.0):
        return np.empty((0, len(view.axes)))
    found = _refined(view, _least_nodes(grid, scale), scale)
    with np.errstate(invalid="ignore"):
        close = np.all(np.abs(rates_at(view, found)) <= view.accuracy, axis=-1)
    places = _canonical(view, _merged(view, wrapped(view, found[close]), BLURRED))
    near = [bool(np.any(_near(view, zeros, place, BLURRED))) for place in places]
    return _ordered(places[~np.array(near, dtype=np.bool_)])


def largest_rates(grid: Grid) -> Array:
    """The largest size of each rate on the grid, (m,)."""
    sizes = np.abs(grid.rates).reshape(-1, grid.rates.shape[-1])
    finite = np.where(np.isfinite(sizes), sizes, 0.0)
    return np.asarray(finite.max(axis=0))


def _canonical(view: Slice, points: Array) -> Array:
    """`points` with what only rounding keeps from zero or from the low end of a seam put there."""
    at_zero = np.where(np.abs(points) < ROUNDING * view.width, 0.0, points)
    at_seam = (view.low + view.width - at_zero < APART * view.width) & view.periodic
    return np.where(at_seam, view.low, at_zero)


def _least_nodes(grid: Grid, scale: Array) -> Array:
    """Nodes where |g| is small and least around; the smallest where there are many."""
    size = np.abs(grid.rates / scale).max(axis=-1)
    least = _is_least(size)
    corners = np.stack(np.meshgrid(*grid.nodes, indexing="ij"), axis=-1)
    order = np.argsort(size[least], kind="stable")[:CANDIDATES]
    return np.asarray(corners[least][order])


def _is_least(size: Array) -> Booleans:
    """Nodes (n1, ..., nm) where `size` is no larger than at any neighbour, and small."""
    m = size.ndim
    filled = np.where(np.isfinite(size), size, np.inf)
    padded = np.pad(filled, 1, constant_values=np.inf)
    least = filled < 0.2
    for offset in product((-1, 0, 1), repeat=m):
        window = tuple(slice(1 + o, padded.shape[i] - 1 + o) for i, o in enumerate(offset))
        least &= filled <= padded[window]
    return np.asarray(least)


def _refined(view: Slice, starts: Array, scale: Array) -> Array:
    """`starts` (k, m), moved to where |g| is least by Levenberg's damped Newton method."""
    points, width = starts.copy(), view.width
    if not len(starts):
        return points
    size, damping = _size(view, points, scale), np.full(len(points), 1e-6)
    reach = 0.05 * width
    for _ in range(ITERATIONS):
        step = np.clip(_newton_step(view, points, scale, damping), -reach, reach)
        trial = _inside(view, points + step)
        size_then = _size(view, trial, scale)
        better = size_then < size
        points[better], size[better] = trial[better], size_then[better]
        damping = np.where(better, np.maximum(0.1 * damping, LEAST_DAMPING), 10.0 * damping)
        if np.all(damping > 1.0):
            break
    return points


def _newton_step(view: Slice, points: Array, scale: Array, damping: Array) -> Array:
    """The step (k, m) that zeroes the linearised g, shortened where the Jacobian is singular."""
    m, width = len(view.axes), view.width
    g = np.nan_to_num(rates_at(view, points) / scale)
    J = jacobians_at(view, points) - (np.eye(m) if view.is_map else 0.0)
    J = np.nan_to_num(J * width / scale[:, None])
    normal = np.swapaxes(J, -1, -2) @ J
    strength = np.trace(normal, axis1=-2, axis2=-1)[:, None, None]
    regular = normal + (damping[:, None, None] * strength + 1e-200) * np.eye(m)
    downhill = np.swapaxes(J, -1, -2) @ g[..., None]
    step: Array = -np.linalg.solve(regular, downhill)[..., 0] * width
    return step


def _size(view: Slice, points: Array, scale: Array) -> Array:
    g = rates_at(view, points) / scale
    size = np.sqrt(np.sum(g * g, axis=-1))
    return np.where(np.isfinite(size), size, np.inf)


def _inside(view: Slice, points: Array) -> Array:
    low, high = view.low, view.low + view.width
    return np.where(view.periodic, points, np.clip(points, low, high))


def _merged(view: Slice, points: Array, distance: float) -> Array:
    """One of each group of `points` (k, m) that lie within `distance` of one another."""
    kept = np.empty((0, len(view.axes)))
    for point in points:
        if not np.any(_near(view, kept, point, distance)):
            kept = np.concatenate([kept, point[None]])
    return kept


def _near(view: Slice, points: Array, point: Array, distance: float) -> Booleans:
    apart = np.abs(shortest(view, points - point)) / view.width
    return np.asarray(apart.max(axis=-1) < distance if len(points) else np.zeros(0, dtype=np.bool_))


def _ordered(points: Array) -> Array:
    order = np.lexsort(points.T[::-1])
    return np.asarray(points[order])

"""Smooth corrections of a field on the region that a trace visited.

A correction of one rate is a Gaussian process with a Matérn kernel of smoothness 3/2 (a smoother
one is too sure of itself between samples), seen through a few inducing places in the visited region
(subset of regressors: Quinonero-Candela and Rasmussen 2005). With L L^T = k(Z, Z) for the places Z
it is g(x) = phi(x) . c, where phi(x) = k(x, Z) L^-T, so that c has the prior
N(0, s^2 I) and g about the variance s^2 wherever the trace went. An angle enters by its place on
the circle.

Letters: m axes, K places.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from scipy.linalg import solve_triangular

from runtime.arrays import Array

SPACING: Final = 0.33
"""Distance of neighbouring places, in lengths."""
MOST: Final = 100
"""Places at most."""
NEAR: Final = 0.4
"""A place is kept where a sample is within so many lengths."""
JITTER: Final = 1e-6


@final
@dataclass(frozen=True, eq=False, slots=True)
class Basis:
    """places (K, m); lengths, turns (m,): of the kernel and of the angles; root: L^-T (K, K).

    extent (m,): how much of each axis was visited.
    """

    places: Array
    extent: Array
    lengths: Array
    turns: Array
    root: Array

    @property
    def count(self) -> int:
        """K, the number of basis functions."""
        return len(self.places)


def basis_on(points: Array, turns: Array, length: float, least: Array) -> Basis | None:
    """The basis on the region that `points` (N, m) visit; None where it would be too large.

    length: of the kernel on each axis, as a share of what was visited of it, which counts as
    `least` (m,) where it was less.
    """
    low, high = np.quantile(points, 0.005, axis=0), np.quantile(points, 0.995, axis=0)
    size = np.maximum(high - low, least)
    size = np.where(turns > 0.0, np.minimum(size, turns), size)
    count = 1 + int(np.ceil(1.0 / (SPACING * length)))
    axes = [
        a + w * np.arange(count) / (count if 0.99 * turn <= w and turn > 0.0 else count - 1)
        for a, w, turn in zip(low, size, turns, strict=True)
    ]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, points.shape[1])
    near = np.min(_distance(grid, points, length * size, turns), axis=1) <= NEAR**2
    places = grid[near]
    if not 0 < len(places) <= MOST:
        return None
    kernel = _kernel(_distance(places, places, length * size, turns))
    lower = np.linalg.cholesky(kernel + JITTER * np.eye(len(places)))
    root = solve_triangular(lower, np.eye(len(places)), lower=True).T
    return Basis(places, size, length * size, turns, root)


def functions(basis: Basis, points: Array) -> Array:
    """The functions phi (..., K) at points (..., m)."""
    squares = _distance(points, basis.places, basis.lengths, basis.turns)
    return np.asarray(_kernel(squares) @ basis.root)


def slopes(basis: Basis, points: Array, weights: Array) -> Array:
    """Derivatives (..., D, m) of the sums weights (..., D, K) . phi at points (..., m)."""
    squares = _distance(points, basis.places, basis.lengths, basis.turns)
    steepness = -3.0 * np.exp(-np.sqrt(3.0 * squares))
    off = points[..., None, :] - basis.places
    turned = basis.turns > 0.0
    safe = np.where(turned, basis.turns, 1.0)
    along = np.where(turned, safe / (2.0 * np.pi) * np.sin(2.0 * np.pi * off / safe), off)
    by_place = steepness[..., None] * along / basis.lengths**2
    return np.asarray((weights @ basis.root.T) @ by_place)


def _kernel(squares: Array) -> Array:
    """Of squared distances in lengths: (1 + sqrt(3) r) exp(-sqrt(3) r)."""
    far = np.sqrt(3.0 * squares)
    return np.asarray((1.0 + far) * np.exp(-far))


def _distance(points: Array, places: Array, lengths: Array, turns: Array) -> Array:
    """Squared distances (..., K) in lengths."""
    total = np.zeros((*points.shape[:-1], len(places)))
    for j, turn in enumerate(turns):
        off = points[..., None, j] - places[:, j]
        if turn > 0.0:
            off = turn / np.pi * np.sin(np.pi * off / turn)
        total += (off / lengths[j]) ** 2
    return total

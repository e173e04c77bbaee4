"""Smooth corrections of a field on the region that a trace visited.

A correction of one rate is a Gaussian process with a squared exponential kernel, seen through a
few inducing places in the visited region (subset of regressors: Quinonero-Candela and Rasmussen,
2005): g(x) = phi(x) . c with phi(x) = k(x, Z) L^-T, L L^T = k(Z, Z), so that c has the prior
N(0, s^2 I) and g about the variance s^2 wherever the trace went. An angle enters by its place on
the circle.

Letters: m axes, K places.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from scipy.linalg import solve_triangular

from runtime.arrays import Array

LENGTH: Final = 0.25
"""The kernel's length on an axis, as a share of what was visited of it."""
ACROSS: Final = {1: 9, 2: 7, 3: 5}
"""Places on an axis, by the number of axes."""
MOST: Final = 48
"""Places at most: those with most samples near."""
NEAR: Final = 0.75
"""A place is kept where a sample is within so many lengths."""
JITTER: Final = 1e-6


@final
@dataclass(frozen=True, eq=False, slots=True)
class Basis:
    """places (K, m); lengths, turns (m,): of the kernel and of the angles; root: L^-T (K, K)."""

    places: Array
    lengths: Array
    turns: Array
    root: Array

    @property
    def count(self) -> int:
        """K, the number of basis functions."""
        return len(self.places)


def basis_on(points: Array, turns: Array) -> Basis:
    """The basis on the region that `points` (N, m) visit."""
    low, high = np.quantile(points, 0.005, axis=0), np.quantile(points, 0.995, axis=0)
    size = np.maximum(high - low, 1e-9 * (np.abs(low) + np.abs(high) + 1.0))
    size = np.where(turns > 0.0, np.minimum(size, turns), size)
    lengths = LENGTH * size
    count = ACROSS.get(points.shape[1], 4)
    grid = np.stack(
        np.meshgrid(
            *[
                a + w * (np.arange(count) / (count if t > 0.0 and w >= 0.99 * t else count - 1))
                for a, w, t in zip(low, size, turns, strict=True)
            ],
            indexing="ij",
        ),
        axis=-1,
    ).reshape(-1, points.shape[1])
    near = np.sum(_distance(grid, points, lengths, turns) <= NEAR**2, axis=1)
    order = np.argsort(-near, kind="stable")[:MOST]
    places = grid[np.sort(order[near[order] > 0])]
    kernel = np.exp(-0.5 * _distance(places, places, lengths, turns))
    lower = np.linalg.cholesky(kernel + JITTER * np.eye(len(places)))
    root = solve_triangular(lower, np.eye(len(places)), lower=True).T
    return Basis(places, lengths, turns, root)


def functions(basis: Basis, points: Array) -> Array:
    """Phi (..., K) at points (..., m)."""
    kernel = np.exp(-0.5 * _distance(points, basis.places, basis.lengths, basis.turns))
    return np.asarray(kernel @ basis.root)


def slopes(basis: Basis, points: Array, weights: Array) -> Array:
    """Derivatives (..., D, m) of the sums weights (..., D, K) . phi at points (..., m)."""
    kernel = np.exp(-0.5 * _distance(points, basis.places, basis.lengths, basis.turns))
    off = points[..., None, :] - basis.places
    turned = basis.turns > 0.0
    safe = np.where(turned, basis.turns, 1.0)
    along = np.where(turned, safe / (2.0 * np.pi) * np.sin(2.0 * np.pi * off / safe), off)
    by_place = -kernel[..., None] * along / basis.lengths**2
    return np.asarray((weights @ basis.root.T) @ by_place)


def _distance(points: Array, places: Array, lengths: Array, turns: Array) -> Array:
    """Squared distances (..., K) in lengths."""
    total = np.zeros((*points.shape[:-1], len(places)))
    for j, turn in enumerate(turns):
        off = points[..., None, j] - places[:, j]
        if turn > 0.0:
            off = turn / np.pi * np.sin(np.pi * off / turn)
        total += (off / lengths[j]) ** 2
    return total

"""The mean error under given conditions: regression with errors that depend within clusters.

Letters: W windows, q columns of the design, k conditions, G clusters.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from scipy import special

from runtime.arrays import Array, Integers

SINGULAR: Final = 1e-9
"""A design whose determinant falls below this share, when a cluster is left out, rests on it."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Means:
    """The mean error under each of k conditions, its standard error, and the errors' residuals.

    value, error: (k,); error is infinite where the data does not tell. residual: (W,).
    clusters: G; G - 1 are the degrees of freedom.
    """

    value: Array
    error: Array
    residual: Array
    clusters: int

    def bounds(self, level: float) -> tuple[Array, Array]:
        """Lower and upper ends (k,), each of them missing the truth with the chance `level`."""
        half = special.stdtrit(max(self.clusters - 1, 1), 1.0 - level) * self.error
        return self.value - half, self.value + half


def conditional_means(errors: Array, design: Array, clusters: Integers, at: Array) -> Means:
    """Least squares of errors (W,) on `design` (W, q), told at the conditions `at` (k, q).

    The standard errors are those of the jackknife that leaves out whole clusters (CR3; Bell and
    McCaffrey 2002, MacKinnon, Nielsen and Webb 2023): with few clusters of unequal sizes they
    cover what they claim, where the usual sandwich is too narrow.
    """
    _, place = np.unique(clusters, return_inverse=True)
    count = int(place.max()) + 1
    squares = _sums(design[:, :, None] * design[:, None, :], place, count)
    products = _sums(design * errors[:, None], place, count)
    whole, right = squares.sum(axis=0), products.sum(axis=0)
    found = np.linalg.lstsq(whole, right, rcond=None)[0]
    without = whole - squares
    size = np.linalg.det(whole)
    if count < 2 or size <= 0.0 or np.min(np.linalg.det(without)) <= SINGULAR * size:
        error = np.full(len(at), np.inf)
    else:
        others = np.linalg.solve(without, (right - products)[..., None])[..., 0]
        moves = (others - found) @ at.T
        error = np.sqrt((count - 1.0) / count * np.sum(moves**2, axis=0))
    return Means(at @ found, error, errors - design @ found, count)


def _sums(values: Array, place: Integers, count: int) -> Array:
    """The sum over each cluster of values (W, ...): (G, ...)."""
    sums = np.zeros((count, *values.shape[1:]))
    np.add.at(sums, place, values)
    return sums

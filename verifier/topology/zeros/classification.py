"""From the Jacobian at a fixed point to its type (Strogatz 2015, sections 2.4, 5.2 and 10.1).

J: Jacobian (m, m); λ: its eigenvalues. A direction contracts where Re(λ) < 0, for a map where
|λ| < 1; `growth` is Re(λ) or log|λ|, so that its sign decides in both cases.
"""

from typing import assert_never

import numpy as np
import numpy.typing as npt

from runtime.arrays import Array
from verifier.topology.features import PointKind

NEUTRAL = 1e-6
"""A pair turns without growing if |growth| is below this share of its angular rate."""

SINGULAR = 1e-8
"""A direction neither grows nor shrinks if |growth| is below this share of the field's rate."""

ROUNDING = 1e-7
"""A pair of eigenvalues is real if its imaginary part is below this share of its size."""


def spectrum(J: Array) -> tuple[tuple[complex, ...], tuple[tuple[complex, ...], ...]]:
    """Eigenvalues (largest real part first) and the rows of the matrix of eigenvectors.

    None of either where J is not finite.
    """
    if not np.all(np.isfinite(J)):
        return (), ()
    values, vectors = np.linalg.eig(J)
    order = np.lexsort((-values.imag, -values.real))
    return (
        tuple(complex(value) for value in values[order]),
        tuple(tuple(complex(entry) for entry in row) for row in vectors[:, order]),
    )


def classified(
    eigenvalues: tuple[complex, ...], *, is_map: bool, rate: float, doubt: float
) -> PointKind:
    """The type of a fixed point.

    rate: a typical rate of the field, 1/s (1 for a map), beside which nothing smaller than
    `SINGULAR` counts. doubt: how far the eigenvalues may be off; what lies within it of a
    borderline is on it.
    """
    values = np.array(eigenvalues)
    growth = _growth(values, is_map=is_map)
    turning = _turning(values, is_map=is_map, doubt=doubt)
    turns = bool(turning.any())
    least = np.where(turning == 0.0, SINGULAR * rate, NEUTRAL * np.abs(turning))
    neutral = np.abs(growth) <= np.maximum(least, doubt)
    if neutral.any():
        return PointKind.CENTER if turns and neutral.all() else PointKind.DEGENERATE
    if growth.min() < 0 < growth.max():
        return PointKind.SADDLE
    if growth.max() < 0:
        return PointKind.STABLE_FOCUS if turns else PointKind.STABLE_NODE
    return PointKind.UNSTABLE_FOCUS if turns else PointKind.UNSTABLE_NODE


def grows(kind: PointKind, m: int) -> range | None:
    """How many of m directions grow at a point of this type; None where some do neither."""
    match kind:
        case PointKind.STABLE_NODE | PointKind.STABLE_FOCUS:
            return range(1)
        case PointKind.UNSTABLE_NODE | PointKind.UNSTABLE_FOCUS:
            return range(m, m + 1)
        case PointKind.SADDLE:
            return range(1, m)
        case PointKind.CENTER | PointKind.DEGENERATE:
            return None
    assert_never(kind)


def eigenvalue_doubt(J: Array, resolution: Array) -> float:
    """How far eigenvalues of J (m, m) may move when its entries are off by `resolution` (m, m).

    First order (Bauer and Fike 1960), after the scaling of the axes that balances J.
    """
    m = J.shape[0]
    if m == 1 or not resolution.any():
        return float(resolution.max())
    if m > 2:
        return _doubt_of_many(J, resolution)
    # λ solves λ² - tr λ + det = 0, so dλ = (λ dtr - ddet) / (2λ - tr).
    trace, determinant = float(np.trace(J)), float(np.linalg.det(J))
    d_trace = float(np.trace(resolution))
    d_determinant = float(np.sum(np.abs(J[::-1, ::-1]) * resolution))
    size = max(abs(value) for value in np.linalg.eigvals(J))
    gap = abs(trace * trace - 4.0 * determinant) ** 0.5
    moved = size * d_trace + d_determinant
    return float(min(moved / gap if gap > 0 else np.inf, (moved + d_trace**2) ** 0.5))


def _doubt_of_many(J: Array, resolution: Array) -> float:
    """The condition of the eigenvectors times the size of the error (Bauer and Fike 1960)."""
    _, vectors = np.linalg.eig(J)
    return float(np.linalg.cond(vectors) * np.linalg.norm(resolution))


def _growth(values: npt.NDArray[np.complex128], *, is_map: bool) -> Array:
    if not is_map:
        return np.asarray(values.real, dtype=np.float64)
    with np.errstate(divide="ignore"):
        return np.asarray(np.log(np.abs(values)), dtype=np.float64)


def _turning(values: npt.NDArray[np.complex128], *, is_map: bool, doubt: float) -> Array:
    """Angular rates: zero for real eigenvalues, and for pairs that can't be told from real ones.

    Rounding splits a double eigenvalue by the square root of the machine's precision.
    """
    turning = np.angle(values) if is_map else values.imag
    told = np.abs(values.imag) > np.maximum(ROUNDING * np.abs(values), doubt)
    return np.where(told, turning, 0.0)

"""How many directions grow at a zero, for certain: from bounds of the Jacobian to a number.

J: bounds (k, m, m); λ: any eigenvalue of any matrix within them. A direction grows where
Re(λ) > 0, for a map where |λ| > 1. One axis: the sign; two: trace and determinant, for maps Jury's
conditions; more: Gershgorin's discs after an approximate diagonalisation (Rump 2010, section 13).
"""

from typing import Final

import numpy as np
import numpy.typing as npt
import scipy.linalg

from runtime.arrays import Array
from runtime.intervals import Interval, add, exactly, multiply, subtract

SLACK: Final = 2.0**-46
"""More than a product of three matrices of up to four rows rounds off, relative to the sizes."""

SHRINKS: Final = (1.0, 0.1, 1e-2, 1e-4)
"""Scales of the successive vectors of a Schur basis: small ones make the upper triangle small."""

Complex = npt.NDArray[np.complex128]


def unstable_directions(J: Interval, *, is_map: bool) -> tuple[int | None, ...]:
    """For each zero how many directions grow; None where the bounds leave it open."""
    with np.errstate(all="ignore"):
        return tuple(
            _unstable(Interval(low, high), is_map=is_map)
            for low, high in zip(J.low, J.high, strict=True)
        )


def _unstable(J: Interval, *, is_map: bool) -> int | None:
    if not np.all(np.isfinite(J.low) & np.isfinite(J.high)):
        return None
    if len(J.low) == 1:
        low, high = float(J.low[0, 0]), float(J.high[0, 0])
        return _of_one(low, high) if not is_map else _of_one_step(low, high)
    if len(J.low) == 2:
        return _of_two_steps(J) if is_map else _of_two(J)
    return _of_many(J, is_map=is_map)


def _of_one(low: float, high: float) -> int | None:
    if high < 0.0:
        return 0
    return 1 if low > 0.0 else None


def _of_one_step(low: float, high: float) -> int | None:
    if -1.0 < low <= high < 1.0:
        return 0
    return 1 if low > 1.0 or high < -1.0 else None


def _invariants(J: Interval) -> tuple[Interval, Interval]:
    """Trace and determinant of matrices of two rows."""
    a, b, c, d = (Interval(J.low[i, j], J.high[i, j]) for i in range(2) for j in range(2))
    return add(a, d), subtract(multiply(a, d), multiply(b, c))


def _of_two(J: Interval) -> int | None:
    trace, determinant = _invariants(J)
    if determinant.high < 0.0:
        return 1
    if determinant.low > 0.0 and trace.high < 0.0:
        return 0
    return 2 if determinant.low > 0.0 and trace.low > 0.0 else None


def _of_two_steps(J: Interval) -> int | None:
    """Of p(λ) = λ² - trace λ + determinant: where it is negative at 1 or -1, one root lies beyond.

    Positive at both, it has both roots inside the unit circle or both outside.
    """
    trace, determinant = _invariants(J)
    sum_ = add(exactly(1.0), determinant)
    signs = [_sign(subtract(sum_, trace)), _sign(add(sum_, trace))]
    if 0 in signs:
        return None
    if signs != [1, 1]:
        return signs.count(-1)
    if determinant.low > -1.0 and determinant.high < 1.0:
        return 0
    return 2 if determinant.low > 1.0 else None


def _sign(a: Interval) -> int:
    return 1 if a.low > 0.0 else -1 if a.high < 0.0 else 0


def _of_many(J: Interval, *, is_map: bool) -> int | None:
    middle = 0.5 * J.low + 0.5 * J.high
    off = np.nextafter(np.maximum(J.high - middle, middle - J.low), np.inf)
    for basis in _bases(middle):
        discs = _discs(middle, off, basis)
        if discs is not None:
            count = _count(*discs, is_map=is_map)
            if count is not None:
                return count
    return None


def _bases(middle: Array) -> list[Complex]:
    """Bases in which the matrix is nearly diagonal: eigenvectors, or scaled Schur vectors."""
    _, vectors = np.linalg.eig(middle)
    _, schur = scipy.linalg.schur(middle.astype(np.complex128), output="complex")
    powers = np.arange(len(middle))
    return [np.asarray(vectors, dtype=np.complex128), *(schur * s**powers for s in SHRINKS)]


def _discs(middle: Array, off: Array, X: Complex) -> tuple[Complex, Array] | None:
    """Centres and radii of Gershgorin's discs of X⁻¹ J X, for all J within middle +- off.

    With Y near X⁻¹ and e = |I - Y X| < 1 (by rows): X⁻¹ J X = (Y X)⁻¹ C, C = Y J X, and
    (Y X)⁻¹ = I + E with |E| <= e / (1 - e).
    """
    try:
        Y = np.linalg.inv(X)
    except np.linalg.LinAlgError:
        return None
    size_X, size_Y = np.abs(X), np.abs(Y)
    C = Y @ middle @ X
    C_off = size_Y @ (off + SLACK * np.abs(middle)) @ size_X * (1.0 + SLACK)
    wrong = np.abs(np.eye(len(X)) - Y @ X) + SLACK * (size_Y @ size_X)
    e = float(wrong.sum(axis=1).max()) * (1.0 + SLACK)
    if not e < 0.5:
        return None
    size = np.abs(C) + C_off
    spill = e / (1.0 - e) * (1.0 + SLACK) * size.max(axis=0).sum()
    others = size.sum(axis=1) - np.diag(size)
    radius = (others + np.diag(C_off) + spill) * (1.0 + SLACK)
    return np.diag(C), radius


def _count(centres: Complex, radii: Array, *, is_map: bool) -> int | None:
    """How many discs lie where directions grow; None where one lies across the boundary."""
    at = np.abs(centres) - 1.0 if is_map else centres.real
    slack = SLACK * (1.0 + np.abs(centres))
    if np.any(np.abs(at) <= radii + slack):
        return None
    return int(np.sum(at > 0.0))

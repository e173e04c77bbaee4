"""Krawczyk's operator over many boxes at once (Krawczyk 1969; Neumaier 1990, chapter 5).

For a box with the centre c and the radius r, bounds J of the derivatives over it, and any matrix Y,
    K = c - Y f(c) + (I - Y J) (box - c)
holds every zero of f in the box; if K lies in the box's interior, there is exactly one. Matrices
are worked out as middle and radius; what rounding may add, `SLACK` of the sizes, is in the radius.
B: boxes; m: axes.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.intervals import Interval

SLACK: Final = 2.0**-48
"""More than any sum of up to four products of sums rounds off, relative to the sizes summed."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Contraction:
    """K of each box as centre and radius (B, m); the radius is not finite where K is unbounded.

    newton: (B, m) the step that Newton's method would take from the box's centre.
    """

    centre: Array
    radius: Array
    newton: Array


def krawczyk(
    centre: Array, radius: Array, values: Interval, slopes: Interval, inverses: Array
) -> Contraction:
    """K of the boxes centre +- radius (B, m).

    values: (B, m) bounds of f at the centres. slopes: (B, m, m) over the boxes. inverses: Y.
    """
    with np.errstate(all="ignore"):
        f, f_off = _middle(values)
        J, J_off = _middle(slopes)
        size = np.abs(inverses)
        step = _times(inverses, f)
        step_off = _times(size, f_off) + SLACK * _times(size, np.abs(f))
        rest = np.eye(centre.shape[-1]) - inverses @ J
        rest_off = size @ J_off + SLACK * (1.0 + size @ np.abs(J))
        reach = step_off + _times(np.abs(rest) + rest_off, radius)
        middle = centre - step
        reach = reach * (1.0 + SLACK) + SLACK * 2.0**-3 * (np.abs(centre) + np.abs(step))
        return Contraction(middle, np.where(np.isnan(reach), np.inf, reach), -step)


def inverses_of(slopes: Interval) -> Array:
    """Approximate inverses (B, m, m) of the middles; NaN where there is none."""
    with np.errstate(all="ignore"):
        J, _ = _middle(slopes)
        finite = np.all(np.isfinite(J), axis=(-2, -1))
        J = np.where(finite[:, None, None], J, 0.0)
        # A tiny shift of the axes' scales makes an exactly singular matrix NaN, not an exception.
        size = np.abs(J).max(axis=-1, keepdims=True)
        scaled = J / np.where(size > 0.0, size, 1.0)
        regular = finite & (np.abs(np.linalg.det(scaled)) > 1e-13)
        safe = np.where(regular[:, None, None], J, np.eye(J.shape[-1]))
        return np.where(regular[:, None, None], np.linalg.inv(safe), np.nan)


def is_inside(found: Contraction, centre: Array, radius: Array) -> Booleans:
    """Whether K lies in the interior of the box, so that exactly one zero lies in it."""
    with np.errstate(invalid="ignore"):
        gap = np.abs(found.centre - centre) * (1.0 + SLACK) + found.radius * (1.0 + SLACK)
        return np.asarray(np.all(gap < radius, axis=-1))


def narrowed(found: Contraction, low: Array, high: Array) -> tuple[Array, Array]:
    """The part of the boxes low to high (B, m) that lies in K; low > high where there is none."""
    with np.errstate(invalid="ignore"):
        known = np.isfinite(found.radius) & np.isfinite(found.centre)
        first = np.nextafter(found.centre - found.radius, -np.inf)
        last = np.nextafter(found.centre + found.radius, np.inf)
        return (
            np.where(known, np.maximum(low, first), low),
            np.where(known, np.minimum(high, last), high),
        )


def mean_value(values: Interval, slopes: Interval, radius: Array) -> Interval:
    """Bounds (B, m) of f over boxes of this radius from bounds at the centres and of slopes."""
    with np.errstate(all="ignore"):
        steepest = np.maximum(np.abs(slopes.low), np.abs(slopes.high))
        reach = _times(steepest, radius) * (1.0 + SLACK)
        low, high = values.low - reach, values.high + reach
        low = np.where(np.isnan(low), -np.inf, low - SLACK * np.abs(low))
        high = np.where(np.isnan(high), np.inf, high + SLACK * np.abs(high))
        return Interval(low, high)


def _times(matrix: Array, vector: Array) -> Array:
    product: Array = np.einsum("...ij,...j->...i", matrix, vector)
    return product


def _middle(bounds: Interval) -> tuple[Array, Array]:
    """The middle, and how far the ends are from it, rounded up."""
    middle = 0.5 * bounds.low + 0.5 * bounds.high
    off = np.maximum(bounds.high - middle, middle - bounds.low)
    return middle, np.nextafter(off, np.inf)

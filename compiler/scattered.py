"""Arrows sketched at scattered points become a field everywhere: the compiler fills the blanks.

thin plate: the radial basis r² log r with a linear polynomial, which bends least among all
interpolants (Duchon 1977); the coordinates are scaled by the domain so that units don't matter.
linear: piecewise linear on the Delaunay triangulation; beyond the hull of the sketch the value on
the hull, on the line to its centre, holds.
"""

import numpy as np
import scipy  # its parts are loaded when they are first used; most specs need none

from compiler.tabulate import Sampler
from runtime.arrays import Array


class SketchError(Exception):
    """The arrows can't be filled in: a sentence says why, `remedy` what to do."""

    def __init__(self, message: str, remedy: str) -> None:
        self.message, self.remedy = message, remedy
        super().__init__(message)


def thin_plate(
    at: Array, go: Array, low: Array, high: Array, periodic: tuple[bool, ...]
) -> Sampler:
    """The least-bending field through the arrows `go` (k, m) at `at` (k, d) on a box (d,).

    A periodic axis is bent to a circle, so that the field meets itself where the axis ends.
    """
    _require_spread(at)

    def placed(points: Array) -> Array:
        share = (points - low) / (high - low)
        columns: list[Array] = []
        for i, turns in enumerate(periodic):
            angle = 2.0 * np.pi * share[:, i]
            columns += [np.cos(angle), np.sin(angle)] if turns else [share[:, i]]
        return np.stack(columns, axis=-1)

    try:
        surface = scipy.interpolate.RBFInterpolator(
            placed(at), go, kernel="thin_plate_spline", degree=1
        )
    except (np.linalg.LinAlgError, ValueError) as error:
        raise SketchError(
            "the arrows stand on one line or plane, so they don't say what happens beside it",
            "add arrows that don't all lie on one line",
        ) from error

    def sample(points: Array) -> Array:
        return np.asarray(surface(placed(points)), dtype=np.float64)

    return sample


def piecewise_linear(at: Array, go: Array) -> Sampler:
    """The piecewise linear field through the arrows `go` (k, m) at `at` (k, d)."""
    _require_spread(at)
    if at.shape[1] == 1:
        order = at[:, 0].argsort()
        line = scipy.interpolate.interp1d(
            at[order, 0],
            go[order],
            axis=0,
            bounds_error=False,
            fill_value=(go[order[0]], go[order[-1]]),
        )
        return lambda points: np.asarray(line(points[:, 0]), dtype=np.float64)
    hull = _hull(at)
    surface = scipy.interpolate.LinearNDInterpolator(at, go)

    def sample(points: Array) -> Array:
        return np.asarray(surface(_drawn_in(points, at.mean(axis=0), hull)), dtype=np.float64)

    return sample


def reaches_beyond(at: Array, low: Array, high: Array) -> int | None:
    """The first axis along which the box leaves the hull of the sketch; None where it doesn't."""
    for i in range(at.shape[1]):
        if at[:, i].min() > low[i] or at[:, i].max() < high[i]:
            return i
    if at.shape[1] == 1:
        return None
    corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(at.shape[1], -1).T
    equations = _hull(at)
    outside = corners @ equations[:, :-1].T + equations[:, -1] > 1e-9 * (high - low).max()
    return 0 if outside.any() else None


def _require_spread(at: Array) -> None:
    if len(np.unique(at, axis=0)) < len(at):
        raise SketchError("two arrows stand at the same point", "keep one of them")
    if len(at) < at.shape[1] + 1:
        raise SketchError(
            f"{len(at)} arrows can't fill {at.shape[1]} dimensions",
            f"sketch at least {at.shape[1] + 1} arrows, not all on one line",
        )


def _hull(at: Array) -> Array:
    """The facets (k, d + 1) of the convex hull: normal and offset, negative inside."""
    try:
        hull = scipy.spatial.ConvexHull(at)
    except scipy.spatial.QhullError as error:
        raise SketchError(
            "the arrows stand on one line or plane, so they don't say what happens beside it",
            "add arrows that don't all lie on one line",
        ) from error
    facets: Array = hull.equations
    return facets


def _drawn_in(points: Array, centre: Array, hull: Array) -> Array:
    """Points beyond the hull moved towards its centre, just onto it."""
    normals, offsets = hull[:, :-1], hull[:, -1]
    reach = -(normals @ centre + offsets)
    along = (points - centre) @ normals.T
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = np.where(along > 0.0, reach / along, np.inf).min(axis=1)
    shrink = np.minimum(1.0, scale * (1.0 - 1e-12))
    drawn: Array = centre + (points - centre) * shrink[:, None]
    return drawn

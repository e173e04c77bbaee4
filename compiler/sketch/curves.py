"""Closed curves around a centre, as a radius over the angle, and the pace along them.

t: the angle from the first vertex, growing in the direction in which the curve is passed, so that
vertex e is at t = starts[e] and edge e leads to starts[e + 1]. Angles are radians, lengths those of
the frame. K: edges.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np
import scipy  # its parts are loaded when they are first used; most specs need none

from compiler.sketch.pacing import TURN, even_paces, timed_paces
from compiler.sketch.polygons import area
from runtime.arrays import Array

GRID: Final = 4_096
"""Angles at which a curve is known; a cubic spline joins them."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Curve:
    """radius: spline of r over t; paces: spline (K,) of the angular speed for 1/s on each edge.

    direction: 1 from the first axis to the second, -1 the other way; start: the angle of the first
    vertex. mean: (K,) of the paces. inner, outer: least and largest radius.
    """

    radius: "scipy.interpolate.CubicSpline"
    paces: "scipy.interpolate.CubicSpline"
    direction: float
    start: float
    mean: Array
    inner: float
    outer: float

    def angle(self, theta: Array) -> Array:
        """The angle t (N,) of polar angles about the centre."""
        found: Array = np.mod(self.direction * (theta - self.start), TURN)
        return found

    def radii(self, theta: Array) -> tuple[Array, Array]:
        """The radius (N,) at polar angles, and its derivative by them."""
        t = self.angle(theta)
        return self.radius(t), self.direction * self.radius(t, 1)

    def pace(self, theta: Array) -> Array:
        """The angular speeds (N, K) of the edges, signed, each for one edge a second."""
        found: Array = self.direction * self.paces(self.angle(theta))
        return found


def curve_through(
    vertices: Array, centre: Array, rounding: float | None, seconds: Array | None
) -> Curve:
    """The curve through vertices (V, 2) that the centre sees: a polygon if it has a rounding.

    seconds: (S, V) examples of the times from each vertex to the next, the controls' defaults
    first; None where one period is all there is.
    """
    rays = vertices - centre
    direction = float(np.sign(area(vertices)))
    angles = np.arctan2(rays[:, 1], rays[:, 0])
    starts = np.mod(direction * (angles - angles[0]), TURN)
    t = np.linspace(0.0, TURN, GRID, endpoint=False)
    if rounding is None:
        radius = _periodic(starts, np.linalg.norm(rays, axis=-1))
    else:
        radius = _spline(_polygon(rays, starts, t, rounding, direction))
    length = np.hypot(radius(t), radius(t, 1))
    paces = (
        even_paces(length, starts, t)
        if seconds is None
        else timed_paces(length, starts, t, seconds)
    )
    return Curve(
        radius,
        _spline(paces),
        direction,
        float(angles[0]),
        paces.mean(axis=0),
        float(radius(t).min()),
        float(radius(t).max()),
    )


def _spline(values: Array) -> "scipy.interpolate.CubicSpline":
    t = np.linspace(0.0, TURN, len(values) + 1)
    closed = np.concatenate([values, values[:1]])
    return scipy.interpolate.CubicSpline(t, closed, bc_type="periodic")


def _periodic(starts: Array, values: Array) -> "scipy.interpolate.CubicSpline":
    t = np.append(starts, TURN)
    return scipy.interpolate.CubicSpline(t, np.append(values, values[0]), bc_type="periodic")


def _spans(starts: Array) -> Array:
    """How far (V,) it is from each vertex to the next."""
    return np.diff(np.append(starts, TURN))


def _about(t: Array, start: float) -> Array:
    """The angle from `start` the short way round."""
    found: Array = np.mod(t - start + np.pi, TURN) - np.pi
    return found


def _polygon(rays: Array, starts: Array, t: Array, rounding: float, direction: float) -> Array:
    """The radius (T,) of a polygon with rounded corners."""
    count, spans = len(rays), _spans(starts)
    edge = np.searchsorted(starts, t, side="right") - 1
    ends = np.roll(rays, -1, axis=0)
    phase = np.arctan2(rays[:, 1], rays[:, 0])[0]
    lines = [_Edge.through(a, b, phase, direction) for a, b in zip(rays, ends, strict=True)]
    found = np.empty_like(t)
    for i in range(count):
        found[edge == i] = lines[i].at(t[edge == i])[0]
    for i, start in enumerate(starts):
        half = 0.5 * rounding * min(spans[i - 1], spans[i])
        near = np.abs(_about(t, start)) < half
        s = _about(t[near], start) / half
        left = [float(d[0]) for d in lines[i - 1].at(np.array([start - half]))]
        right = [float(d[0]) for d in lines[i].at(np.array([start + half]))]
        found[near] = _hermite(s, left, right, half)
    return found


@final
@dataclass(frozen=True, slots=True)
class _Edge:
    """A straight line as r = near / cos(t - foot)."""

    near: float
    foot: float

    @staticmethod
    def through(a: Array, b: Array, phase: float, direction: float) -> "_Edge":
        edge: Array = b - a
        foot = a - edge * (np.dot(a, edge) / np.dot(edge, edge))
        angle = np.arctan2(foot[1], foot[0])
        return _Edge(float(np.hypot(foot[0], foot[1])), float(direction * (angle - phase)))

    def at(self, t: Array) -> tuple[Array, Array, Array, Array]:
        """The radius and its first three derivatives by t."""
        secant, tangent = 1.0 / np.cos(t - self.foot), np.tan(t - self.foot)
        r = self.near * secant
        third = r * tangent * (5.0 * secant**2 + tangent**2)
        return r, r * tangent, r * (secant**2 + tangent**2), third


def _hermite(s: Array, left: list[float], right: list[float], half: float) -> Array:
    """The polynomial of degree 7 on [-1, 1] with value and three derivatives at both ends."""
    system = [_monomials(end, order) for end in (-1.0, 1.0) for order in range(4)]
    wanted = [side[order] * half**order for side in (left, right) for order in range(4)]
    coefficients = np.linalg.solve(np.array(system), np.array(wanted))
    return np.asarray(np.polynomial.polynomial.polyval(s, coefficients), dtype=np.float64)


def _monomials(x: float, order: int) -> Array:
    """The derivatives of 1, x, ..., x^7."""
    basis = np.eye(8)
    return np.array(
        [
            np.polynomial.polynomial.polyval(x, np.polynomial.polynomial.polyder(row, order))
            for row in basis
        ]
    )

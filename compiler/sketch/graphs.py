"""Curves as graphs over their chord: a natural cubic spline through points of the plane.

V: points of the curve; N: places; s: how far along the chord.
"""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class Graph:
    """A curve from `start` along the unit vector `chord` (2,), straight beyond its ends.

    knots, heights, bends: (V,) s of the points, how far they are beside the chord, and the second
    derivatives there.
    """

    start: Array
    chord: Array
    knots: Array
    heights: Array
    bends: Array

    def beside(self, q: Array) -> tuple[Array, Array, Array]:
        """How far places q (N, 2) are along the chord and beside the curve, and its slope there."""
        y = q - self.start
        s = y @ self.chord
        inside = np.clip(s, self.knots[0], self.knots[-1])
        height, slope = self._height(inside)
        on_curve = height + (s - inside) * slope
        return s, y @ quarter_turn(self.chord) - on_curve, slope

    def nearest(self, q: Array) -> Array:
        """The place (2,) of the curve right beside q (2,)."""
        _, beside, _ = self.beside(q[np.newaxis])
        found: Array = q - beside[0] * quarter_turn(self.chord)
        return found

    def _height(self, s: Array) -> tuple[Array, Array]:
        """Height and slope of the spline at s (N,) within its ends."""
        i = np.clip(np.searchsorted(self.knots, s, side="right") - 1, 0, len(self.knots) - 2)
        h = self.knots[i + 1] - self.knots[i]
        a, b = (self.knots[i + 1] - s) / h, (s - self.knots[i]) / h
        low, high = self.heights[i], self.heights[i + 1]
        m0, m1 = self.bends[i], self.bends[i + 1]
        height = a * low + b * high + ((a**3 - a) * m0 + (b**3 - b) * m1) * h * h / 6.0
        slope = (high - low) / h + ((3.0 * b * b - 1.0) * m1 - (3.0 * a * a - 1.0) * m0) * h / 6.0
        return height, slope


def graph_through(points: Array) -> Graph:
    """The natural cubic spline through points (V, 2), over the chord from the first to the last."""
    span = points[-1] - points[0]
    chord = span / np.linalg.norm(span)
    y = points - points[0]
    knots, heights = y @ chord, y @ quarter_turn(chord)
    return Graph(points[0], chord, knots, heights, _bends(knots, heights))


def quarter_turn(v: Array) -> Array:
    """Vectors (..., 2) turned from the first axis to the second."""
    return np.stack([-v[..., 1], v[..., 0]], axis=-1)


def _bends(knots: Array, heights: Array) -> Array:
    """Second derivatives (V,) at the knots, zero at both ends (de Boor 1978, chapter 4)."""
    h, steepness = np.diff(knots), np.diff(heights) / np.diff(knots)
    system, right = np.eye(len(knots)), np.zeros(len(knots))
    for i in range(1, len(knots) - 1):
        system[i, i - 1 : i + 2] = h[i - 1], 2.0 * (h[i - 1] + h[i]), h[i]
        right[i] = 6.0 * (steepness[i] - steepness[i - 1])
    return np.asarray(np.linalg.solve(system, right), dtype=np.float64)

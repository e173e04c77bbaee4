"""The field of a separatrix: a saddle whose way in is a curve.

The curve is a graph over its chord: a place is (s, d), how far it is along the chord, and how far
beside the curve. There s comes to the saddle and d grows, so the curve is never crossed.
N: places; V: points of the curve.
"""

from dataclasses import dataclass
from typing import final

import numpy as np
import scipy  # its parts are loaded when they are first used; most specs need none

from compiler.sketch.models import Settings, quarter_turn, saturated
from runtime.arrays import Array
from spec_schema.expressions.tree import Expr


@final
@dataclass(frozen=True, eq=False, slots=True)
class RidgeModel:
    """graph: spline of the height over the chord, from `start` along the unit vector `chord`.

    ends: (2,) the first and the last s of the spline, which goes on straight beyond them; saddle:
    its s. rates: in along the curve, and away from it.
    """

    graph: "scipy.interpolate.CubicSpline"
    start: Array
    chord: Array
    ends: Array
    saddle: float
    rates: tuple[Expr, Expr]

    @property
    def coefficients(self) -> tuple[Expr, ...]:
        """The two rates."""
        return self.rates

    def distance(self, q: Array, settings: Settings) -> Array:
        """How far beside the curve."""
        del settings
        _, beside, _ = self._along(q)
        return np.abs(beside)

    def parts(self, q: Array, settings: Settings) -> Array:
        """Along the curve to the saddle, and away from the curve."""
        del settings
        s, beside, slope = self._along(q)
        across = quarter_turn(self.chord)
        tangent = self.chord + slope[:, np.newaxis] * across
        inward = -saturated(s - self.saddle)[:, np.newaxis] * tangent
        away = saturated(beside)[:, np.newaxis] * across
        return np.stack([inward, away], axis=1)

    def _along(self, q: Array) -> tuple[Array, Array, Array]:
        """How far (N,) along the chord and beside the curve, and the curve's slope there."""
        y = q - self.start
        s = y @ self.chord
        inside = np.clip(s, self.ends[0], self.ends[1])
        slope = self.graph(inside, 1)
        height = self.graph(inside) + (s - inside) * slope
        return s, y @ quarter_turn(self.chord) - height, slope


def ridge_through(points: Array, saddle: Array, rates: tuple[Expr, Expr]) -> RidgeModel:
    """The separatrix through points (V, 2), with its saddle beside the given place (2,)."""
    chord, s, height = _over_chord(points)
    graph = scipy.interpolate.CubicSpline(s, height, bc_type="natural")
    place = float((saddle - points[0]) @ chord)
    return RidgeModel(graph, points[0], chord, s[[0, -1]], place, rates)


def on_ridge(points: Array, near: Array) -> Array:
    """The place (2,) of the curve through points (V, 2) that is right beside `near` (2,)."""
    chord, s, height = _over_chord(points)
    graph = scipy.interpolate.CubicSpline(s, height, bc_type="natural")
    place = (near - points[0]) @ chord
    inside = np.clip(place, s[0], s[-1])
    beside = graph(inside) + (place - inside) * graph(inside, 1)
    found: Array = points[0] + place * chord + beside * quarter_turn(chord)
    return found


def _over_chord(points: Array) -> tuple[Array, Array, Array]:
    """The unit vector from the first point to the last; along it and beside it, all points."""
    span = points[-1] - points[0]
    chord = span / np.linalg.norm(span)
    y = points - points[0]
    return chord, y @ chord, y @ quarter_turn(chord)

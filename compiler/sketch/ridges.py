"""The field of a separatrix: a saddle whose way in is a curve.

N: places; V: points of the curve. The curve goes on straight beyond its ends.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np
import scipy  # its parts are loaded when they are first used; most specs need none

from compiler.sketch.models import Settings, quarter_turn, saturated
from runtime.arrays import Array
from spec_schema.expressions.tree import Expr

BEYOND: Final = 8.0
"""Half widths of the frame that the line goes on straight beyond its ends."""
PIECES: Final = 400
STEPS: Final = 6
"""Newton steps to the nearest place on the line."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class RidgeModel:
    """curve: spline of the place over the length s; saddle: its s. rates: in along it, and away."""

    curve: "scipy.interpolate.CubicSpline"
    saddle: float
    rates: tuple[Expr, Expr]

    @property
    def coefficients(self) -> tuple[Expr, ...]:
        """The two rates."""
        return self.rates

    def distance(self, q: Array, settings: Settings) -> Array:
        """How far from the line."""
        del settings
        _, _, aside = self._beside(q)
        return np.abs(aside)

    def parts(self, q: Array, settings: Settings) -> Array:
        """Along the line to the saddle, and away from the line."""
        del settings
        s, along, aside = self._beside(q)
        inward = -saturated(s - self.saddle)[:, np.newaxis] * along
        away = saturated(aside)[:, np.newaxis] * quarter_turn(along)
        return np.stack([inward, away], axis=1)

    def _beside(self, q: Array) -> tuple[Array, Array, Array]:
        """The nearest place on the line: its s (N,), direction (N, 2), signed distance (N,)."""
        first, last = float(self.curve.x[0]), float(self.curve.x[-1])
        grid = np.linspace(first, last, PIECES)
        apart = np.linalg.norm(q[:, np.newaxis] - self.curve(grid), axis=-1)
        s = grid[apart.argmin(axis=1)]
        for _ in range(STEPS):
            gap, slope = q - self.curve(s), self.curve(s, 1)
            bend = self.curve(s, 2)
            change = np.sum(slope * slope, axis=-1) - np.sum(gap * bend, axis=-1)
            move = np.sum(gap * slope, axis=-1) / np.where(change > 0.1, change, 1.0)
            s = np.clip(s + np.clip(move, -0.1, 0.1), first, last)
        along = self.curve(s, 1)
        along = along / np.linalg.norm(along, axis=-1, keepdims=True)
        return s, along, np.sum((q - self.curve(s)) * quarter_turn(along), axis=-1)


def ridge_through(points: Array, saddle: Array, rates: tuple[Expr, Expr]) -> RidgeModel:
    """The separatrix through points (V, 2) with its saddle at the nearest place of the line."""
    first, last = points[0] - points[1], points[-1] - points[-2]
    steps = np.array([[BEYOND / 2], [BEYOND]])
    before = points[0] + steps[::-1] * first / np.linalg.norm(first)
    after = points[-1] + steps * last / np.linalg.norm(last)
    all_points = np.concatenate([before, points, after])
    lengths = np.concatenate(
        [[0.0], np.cumsum(np.linalg.norm(np.diff(all_points, axis=0), axis=1))]
    )
    curve = scipy.interpolate.CubicSpline(lengths, all_points)
    grid = np.linspace(lengths[0], lengths[-1], 50 * PIECES)
    nearest = grid[int(np.linalg.norm(curve(grid) - saddle, axis=-1).argmin())]
    return RidgeModel(curve, float(nearest), rates)

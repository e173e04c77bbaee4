"""The field of a separatrix: a saddle whose way in is a curve.

The curve is a graph over its chord: a place is (s, d), how far it is along the chord, and how far
beside the curve. There s comes to the saddle and d grows, so the curve is never crossed.
N: places; V: points of the curve.
"""

from dataclasses import dataclass
from typing import final

import numpy as np

from compiler.sketch.graphs import Graph, graph_through, quarter_turn
from compiler.sketch.models import Settings, saturated
from runtime.arrays import Array
from spec_schema.expressions.tree import Expr


@final
@dataclass(frozen=True, eq=False, slots=True)
class RidgeModel:
    """A saddle and the curve that leads into it.

    saddle: how far along the curve's chord it is. rates: in along the curve, and away from it.
    """

    graph: Graph
    saddle: float
    rates: tuple[Expr, Expr]

    @property
    def coefficients(self) -> tuple[Expr, ...]:
        """The two rates."""
        return self.rates

    def distance(self, q: Array, settings: Settings) -> Array:
        """How far beside the curve."""
        del settings
        _, beside, _ = self.graph.beside(q)
        return np.abs(beside)

    def parts(self, q: Array, settings: Settings) -> Array:
        """Along the curve to the saddle, and away from the curve."""
        del settings
        s, beside, slope = self.graph.beside(q)
        across = quarter_turn(self.graph.chord)
        tangent = self.graph.chord + slope[:, np.newaxis] * across
        inward = -saturated(s - self.saddle)[:, np.newaxis] * tangent
        away = saturated(beside)[:, np.newaxis] * across
        return np.stack([inward, away], axis=1)


def ridge_through(points: Array, saddle: Array, rates: tuple[Expr, Expr]) -> RidgeModel:
    """The separatrix through points (V, 2), with its saddle beside the given place (2,)."""
    graph = graph_through(points)
    return RidgeModel(graph, float((saddle - points[0]) @ graph.chord), rates)

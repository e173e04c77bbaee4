"""Natural splines over a chord, beside scipy's."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline

from compiler.sketch.graphs import graph_through

HEIGHTS = st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=9)


@given(HEIGHTS)
def test_a_graph_is_the_natural_spline(heights: list[float]) -> None:
    knots = np.cumsum(1.0 + 0.3 * np.sin(np.arange(len(heights))))
    values = np.array([0.0, *heights[1:-1], 0.0])  # so that the chord is the axis itself
    graph = graph_through(np.stack([knots, values], axis=-1))
    peer = CubicSpline(knots, values, bc_type="natural")
    s = np.linspace(knots[0], knots[-1], 57)
    _, beside, slope = graph.beside(np.stack([s, np.zeros_like(s)], axis=-1))
    assert np.allclose(-beside, peer(s), atol=1e-12)
    assert np.allclose(slope, peer(s, 1), atol=1e-12)

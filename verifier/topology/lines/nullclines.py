"""Nullclines: where one variable's rate is zero, with every branch.

Crossing zero, touching it (0 = x²), crossing one another, and the borders of areas where the rate
is zero throughout. f: one rate, divided by its typical size.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array, frozen
from verifier.topology.features import Grid, Nullcline
from verifier.topology.lines.edge_zeros import TOUCH, zeros_on_edges
from verifier.topology.lines.linking import polylines
from verifier.topology.slices import Slice, jacobians_at, rates_at

SHIFTS: Final = (0.3819660112501051, 0.2451223337533073)
"""Shares of a step by which inner nodes are moved: off the round places and diagonals that zeros
love. Nodes that are zero all the same lie in an area of zeros."""

MOST_BLUR: Final = 1e-5
"""A table's error beyond this is no reason to see a line where none is."""

HUGE: Final = 1e50
"""More of f is as good as infinite."""

PROBE: Final = 0.05
"""The step, in cells, of the differences that a saddle of f is found with."""

ITERATIONS: Final = 8


def find_nullclines(view: Slice, grid: Grid) -> tuple[Nullcline, ...]:
    """The nullclines of both axes of a planar slice; none for a variable that never moves."""
    x, y = (_shifted(axis, shift) for axis, shift in zip(grid.nodes, SHIFTS, strict=True))
    rates = rates_at(view, np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1))
    rates = np.where(np.isfinite(rates), rates, np.nan)
    return tuple(
        Nullcline(axis.name, _lines(view, (x, y), rates[..., j], j))
        for j, axis in enumerate(view.axes)
        if np.nanmax(np.abs(rates[..., j])) > 0.0
    )


def _shifted(nodes: Array, shift: float) -> Array:
    step = nodes[1] - nodes[0]
    return np.concatenate([nodes[:1], nodes[:-1] + shift * step, nodes[-1:]])


def _lines(view: Slice, nodes: tuple[Array, Array], rates: Array, j: int) -> tuple[Array, ...]:
    sizes = np.abs(rates)
    scale = float(np.median(sizes[sizes > 0.0]))
    f = np.clip(rates / scale, -HUGE, HUGE)
    blur = min(float(view.accuracy[j]) / scale, MOST_BLUR)

    def f_at(points: Array) -> Array:
        return np.clip(rates_at(view, points)[..., j] / scale, -HUGE, HUGE)

    def crossings(starts: Array) -> Array:
        return _saddles(view, starts, nodes, j, scale * max(TOUCH, blur))

    across, upward = (zeros_on_edges(f_at, nodes, f, along, blur) for along in (0, 1))
    return polylines(f_at, nodes, (across, upward), crossings)


def _saddles(
    view: Slice, starts: Array, nodes: tuple[Array, Array], j: int, nearly: float
) -> Array:
    """Where the gradient of the rate j is zero within a cell of `starts` (k, 2), and the rate, too.

    NaN where the rate is not zero there: its branches pass one another.
    """
    cell = np.array([axis[2] - axis[1] for axis in nodes])
    points = starts.copy()
    for _ in range(ITERATIONS):
        slope = _gradient(view, points, j) * cell
        bend = np.stack(
            [
                (_gradient(view, points + step, j) - _gradient(view, points - step, j))
                * cell
                / (2.0 * PROBE)
                for step in np.diag(PROBE * cell)
            ],
            axis=-1,
        )
        steps = -np.linalg.pinv(np.nan_to_num(bend)) @ np.nan_to_num(slope)[..., None]
        points = points + np.clip(steps[..., 0], -1.0, 1.0) * cell
    good = np.all(np.abs(points - starts) <= 1.5 * cell, axis=-1)
    good &= np.abs(rates_at(view, points)[..., j]) <= nearly
    return frozen(np.where(good[:, None], points, np.nan))


def _gradient(view: Slice, points: Array, j: int) -> Array:
    inside = np.clip(points, view.low, view.low + view.width)
    gradient = jacobians_at(view, inside)[..., j, :]
    return gradient - np.eye(2)[j] if view.is_map else gradient

"""Nullclines: where one variable's rate is zero, crossing zero or only touching it.

f: one rate on a fine grid, divided by its largest size.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array, Booleans, frozen
from verifier.topology.contours import zero_lines
from verifier.topology.features import Grid, Nullcline
from verifier.topology.slices import Slice, jacobians_at, rates_at

ON_LINE: Final = 1e-4
"""What |f| must fall below on a nullcline, after one Newton step; at a jump of f it does not."""

TOUCH: Final = 1e-8
"""What |f| must fall below on a line where f touches zero without crossing it."""

FLAT: Final = 1e-3
"""What the change of f over one hundredth of the domain must fall below on such a line."""

NEAR: Final = 0.1
"""Such lines are looked for where |f| is below this."""

ROUNDING: Final = 1e-11
"""A smaller change of f from node to node is none."""

SHORTEST: Final = 5
"""Fewer points than these make no line where f touches zero."""


def find_nullclines(view: Slice, grid: Grid) -> tuple[Nullcline, ...]:
    """The nullclines of both axes of a planar slice; none for a variable that never moves."""
    return tuple(
        Nullcline(axis.name, (*_crossing(view, grid, j), *_touching(view, grid, j)))
        for j, axis in enumerate(view.axes)
        if np.nanmax(np.abs(grid.rates[..., j])) > 0.0
    )


def _crossing(view: Slice, grid: Grid, j: int) -> tuple[Array, ...]:
    """Lines across which the rate j changes its sign continuously."""
    scale = float(np.nanmax(np.abs(grid.rates[..., j])))
    lines = zero_lines(grid.nodes, _nudged(grid.rates[..., j], scale))
    polished: list[Array] = []
    for line in lines:
        better = _polished(view, grid, line, j)
        on_it = np.abs(rates_at(view, better)[..., j]) <= ON_LINE * scale
        polished.extend(_runs(better, np.asarray(on_it), 2))
    return tuple(polished)


def _nudged(f: Array, scale: float) -> Array:
    """Exact zeros on nodes made positive, so that a line through nodes is one line."""
    return np.where(f == 0.0, 1e-14 * scale, f)


def _polished(view: Slice, grid: Grid, line: Array, j: int) -> Array:
    """`line` (k, 2) after one Newton step along the gradient of the rate j, at most one cell."""
    cell = np.array([axis[1] - axis[0] for axis in grid.nodes])
    gradient = jacobians_at(view, line)[..., j, :]
    if view.is_map:
        gradient = gradient - np.eye(2)[j]
    slope = np.nan_to_num(gradient * cell)
    size = np.sum(slope * slope, axis=-1)
    f = rates_at(view, line)[..., j]
    step = -np.nan_to_num(f / np.where(size > 0.0, size, np.inf))[..., None] * slope
    moved = line + np.clip(step, -1.0, 1.0) * cell
    return np.asarray(np.clip(moved, view.low, view.low + view.width))


def _touching(view: Slice, grid: Grid, j: int) -> tuple[Array, ...]:
    """Lines along which the rate j is zero with its gradient: 0 = x² has no change of sign."""
    scale = float(np.nanmax(np.abs(grid.rates[..., j])))
    f = grid.rates[..., j] / scale
    lines = [
        line
        for slope in map(np.asarray, np.gradient(f))
        for line in zero_lines(grid.nodes, _slope_near_zero(f, slope))
        if len(line) >= SHORTEST
    ]
    if not lines:
        return ()
    points = np.concatenate(lines)
    size = np.abs(rates_at(view, points)[..., j]) / scale
    steep = np.abs(jacobians_at(view, points)[..., j, :] * view.width / scale).max(axis=-1)
    flat = np.asarray((size <= TOUCH) & (0.01 * steep <= FLAT))
    ends = np.cumsum([len(line) for line in lines])[:-1]
    pairs = zip(lines, np.split(flat, ends), strict=True)
    found = [run for line, keep in pairs for run in _runs(line, keep, SHORTEST)]
    return tuple(_new_ones(found, view.width))


def _slope_near_zero(f: Array, slope: Array) -> Array:
    """The slope where f is small; what is only rounding made positive, so that it has no zeros."""
    near = np.where(np.abs(f) <= NEAR, slope, np.nan)
    return np.where(np.abs(slope) < ROUNDING, ROUNDING, near)


def _runs(line: Array, keep: Booleans, shortest: int) -> list[Array]:
    """The stretches of `line` (k, 2) that are to be kept, if they are long enough."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], keep, [False]]).astype(np.int8)))
    pairs = zip(edges[::2], edges[1::2], strict=True)
    return [frozen(line[a:b]) for a, b in pairs if b - a >= shortest]


def _new_ones(lines: list[Array], width: Array) -> list[Array]:
    """`lines` without those whose middle lies on an earlier one."""
    kept: list[Array] = []
    for line in sorted(lines, key=len, reverse=True):
        middle = line[len(line) // 2]
        gaps = [np.abs((other - middle) / width).max(axis=-1).min() for other in kept]
        if min(gaps, default=1.0) > 5e-3:
            kept.append(line)
    return kept

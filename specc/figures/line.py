"""The portrait of one variable: the rate against the state, or a map's cobweb."""

from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from runtime.arrays import Array
from runtime.program import Unit
from specc.figures.axes_of_states import name_x, name_y
from specc.figures.markers import Entry, mark
from specc.figures.quantities import axis_label, rate_of
from specc.figures.style import BLUE, FAINT, INK, VERMILION, bare
from verifier.topology.features import Portrait


def draw_line(figure: Figure, portrait: Portrait) -> tuple[Axes, list[Entry]]:
    """Draws into `figure`; gives its axes and what the legend shows."""
    axes = figure.add_axes((0.1, 0.1, 0.62, 0.78))
    return axes, (_cobweb if portrait.every > 0.0 else _phase_line)(axes, portrait)


def _phase_line(axes: Axes, portrait: Portrait) -> list[Entry]:
    """The rate over the state; arrows on the line of rest say which way it goes."""
    (state,) = portrait.axes
    scale = state.unit.scale
    nodes, rates = portrait.field.nodes[0] / scale, portrait.field.rates[:, 0] / scale
    name_x(axes, state)
    bare(axes)
    axes.set_ylabel(axis_label(rate_of(state.name), _per_second(state.unit)))
    axes.axhline(0.0, color=INK, linewidth=0.8, zorder=2)
    axes.plot(nodes, rates, color=BLUE, linewidth=1.8, zorder=3)
    axes.fill_between(nodes, 0.0, rates, color=BLUE, alpha=0.08, linewidth=0.0, zorder=1)
    _directions(axes, nodes, rates)
    at = np.array([[float(p.at[0]) / scale, 0.0] for p in portrait.fixed_points]).reshape(-1, 2)
    points = mark(axes, at, [p.kind for p in portrait.fixed_points])
    rate = Line2D([], [], color=BLUE, linewidth=1.8, label=rate_of(state.name))
    arrow = Line2D([], [], color=INK, marker=">", markersize=5.0, linewidth=0.8)
    arrow.set_label("where it goes")
    return [*points, (rate,), (arrow,)]


def _directions(axes: Axes, nodes: Array, rates: Array) -> None:
    """An arrowhead in the middle of each stretch in which the rate keeps its sign."""
    sign = np.sign(np.nan_to_num(rates))
    edges = np.flatnonzero(np.diff(np.concatenate([[0.0], sign, [0.0]])))
    for a, b in pairwise(edges):
        if sign[a] and b - a > 0.02 * len(nodes):
            middle = 0.5 * (nodes[a] + nodes[b - 1])
            axes.plot(middle, 0.0, ">" if sign[a] > 0 else "<", color=INK, markersize=6.0, zorder=4)


def _cobweb(axes: Axes, portrait: Portrait) -> list[Entry]:
    """The next value over the value; orbits bounce between the curve and the diagonal."""
    (state,) = portrait.axes
    scale = state.unit.scale
    nodes = portrait.field.nodes[0] / scale
    following = nodes + portrait.field.rates[:, 0] / scale
    name_x(axes, state)
    name_y(axes, state)
    axes.set_ylabel(axis_label(f"next {state.name}", state.unit))
    axes.set_aspect("equal", adjustable="box", anchor="NW")
    ends = (state.low / scale, state.high / scale)
    axes.plot(ends, ends, color=FAINT, linewidth=0.9, linestyle=(0, (4, 2)), zorder=2)
    axes.plot(nodes, following, color=BLUE, linewidth=1.8, zorder=3)
    for path in portrait.trajectories[:2]:
        axes.plot(*_web(path.points[:, 0] / scale), color=VERMILION, linewidth=0.7, zorder=4)
    at = np.array([[float(p.at[0]) / scale] * 2 for p in portrait.fixed_points]).reshape(-1, 2)
    return [
        *mark(axes, at, [p.kind for p in portrait.fixed_points]),
        (Line2D([], [], color=BLUE, linewidth=1.8, label=f"next {state.name}"),),
        (Line2D([], [], color=FAINT, linestyle=(0, (4, 2)), label="stays where it is"),),
        (Line2D([], [], color=VERMILION, linewidth=0.7, label="orbit"),),
    ]


def _web(values: Array) -> tuple[Array, Array]:
    """The corners of the cobweb of successive `values` (T,)."""
    x = np.repeat(values, 2)
    return x[:-1], x[1:]


def _per_second(unit: Unit) -> Unit:
    text = "1/s" if unit.text in {"", "1"} else f"{unit.text}/s"
    return Unit(text, unit.scale)

"""Measured against predicted: a few windows of a trace, each with its tolerance at the end."""

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from specc.figures.quantities import axis_label, seconds
from specc.figures.style import BLUE, FAINT, INK, bare, framed, look
from verifier.report.report import VariableResult, WindowView

MOST: Final = 6
"""How many windows are drawn."""

COLUMNS: Final = 3


def draw_windows(variable: VariableResult) -> Figure:
    """Small panels, one a window: what was measured, and where the spec says it would go."""
    views = _chosen(variable.views)
    columns = min(COLUMNS, max(1, len(views)))
    rows = -(-len(views) // columns) or 1
    with look():
        figure = Figure(figsize=(7.2, 0.85 + 1.8 * rows))
        grid = framed(figure, rows, columns, (0.85, 0.1, 0.55, 0.6))
        grid.update(wspace=0.34, hspace=0.6)
        for k, view in enumerate(views):
            _panel(figure.add_subplot(grid[divmod(k, columns)]), variable, view)
        figure.supxlabel("time since the window's start [s]", fontsize=9.0, y=0.02)
        label = axis_label(variable.name, variable.unit)
        figure.supylabel(label, fontsize=9.0, x=0.01)
        figure.legend(handles=_legend(), loc="upper left", ncols=3, borderaxespad=0.2)
    return figure


def _chosen(views: tuple[WindowView, ...]) -> list[WindowView]:
    """At most `MOST` views, evenly over the trace."""
    if len(views) <= MOST:
        return list(views)
    return [views[i] for i in np.linspace(0, len(views) - 1, MOST).round().astype(int)]


def _panel(axes: Axes, variable: VariableResult, view: WindowView) -> None:
    scale = variable.unit.scale
    times = view.times - view.times[0]
    axes.plot(times, view.measured / scale, color=INK, linewidth=1.3)
    axes.plot(times, view.predicted / scale, color=BLUE, linewidth=1.6, linestyle=(0, (4, 1.5)))
    axes.errorbar(
        times[-1],
        view.predicted[-1] / scale,
        yerr=variable.tolerance / scale,
        color=BLUE,
        capsize=3.5,
        linewidth=1.0,
    )
    axes.set_title(f"at {seconds(float(view.times[0]))}", loc="left", fontsize=8.5, color=FAINT)
    bare(axes)


def _legend() -> list[Line2D]:
    return [
        Line2D([], [], color=INK, linewidth=1.3, label="measured"),
        Line2D([], [], color=BLUE, linewidth=1.6, linestyle=(0, (4, 1.5)), label="predicted"),
        Line2D([], [], color=BLUE, linestyle="none", marker="|", markersize=9, label="tolerance"),
    ]

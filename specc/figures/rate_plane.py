"""How fast a state is moved, over two quantities that are sensed, and where a mode is left."""

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from runtime.arrays import Array
from specc.figures.axes_of_states import name_x, name_y, same_scale
from specc.figures.legend import Entry, draw_legend, line_entry
from specc.figures.palettes import PALETTES, Palette
from specc.figures.paper import (
    BELOW,
    LEFT,
    LEGEND,
    axes_at,
    heading,
    new_figure,
    panel_size,
    write_heading,
)
from specc.figures.style import look
from specc.figures.style_names import Style
from verifier.topology.features import AxisRange

MOST: Final = (4.7, 3.6)
LEVELS: Final = 9
LEAVES: Final = "//"


@final
@dataclass(frozen=True, eq=False, slots=True)
class Exit:
    """A way out of the mode: `open` (X, Y) is zero or more where it is taken."""

    target: str
    open: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class RatePlane:
    """Rates (X, Y) of one state, in `unit`, at nodes (SI) along two axes.

    held: at which values of all else, as a sentence; empty where nothing else matters.
    """

    name: str
    title: str
    held: str
    state: str
    unit: str
    axes: tuple[AxisRange, AxisRange]
    nodes: tuple[Array, Array]
    rates: Array
    exits: tuple[Exit, ...]


def draw_rate_plane(plane: RatePlane, style: Style = Style.SCREEN) -> Figure:
    """The plane as a figure."""
    palette = PALETTES[style]
    size = panel_size(plane.axes, MOST, same_scale=same_scale(plane.axes))
    above = [plane.title, *([plane.held] if plane.held else [])]
    text = heading(plane.name, above, [], size[0] + LEGEND)
    with look(palette):
        height = BELOW + size[1] + text.height + 0.1
        figure = new_figure(LEFT + size[0] + LEGEND, height, palette)
        axes = axes_at(figure, (LEFT, BELOW), size)
        axes.set_facecolor(palette.paper)
        name_x(axes, plane.axes[0])
        name_y(axes, plane.axes[1])
        entries = _draw(axes, plane, palette)
        draw_legend(axes, entries, (1.0 + 0.18 / size[0], 1.0))
        write_heading(figure, text, palette, LEFT, BELOW + size[1] + text.height, BELOW)
    return figure


def _draw(axes: Axes, plane: RatePlane, palette: Palette) -> list[Entry]:
    scales = [axis.unit.scale for axis in plane.axes]
    x, y = (nodes / scale for nodes, scale in zip(plane.nodes, scales, strict=True))
    entries = []
    if np.ptp(plane.rates) > 0.0:
        ground = LinearSegmentedColormap.from_list("rate", [palette.paper, palette.tints[0]])
        axes.contourf(x, y, plane.rates.T, LEVELS, cmap=ground)
        lines = axes.contour(
            x, y, plane.rates.T, LEVELS, colors=[palette.nullcline], linewidths=0.9,
            linestyles="solid",
        )  # fmt: skip
        axes.clabel(lines, fontsize=8.0, fmt="%.3g")
        label = f"d {plane.state}/dt, in {plane.unit}" if plane.unit else f"d {plane.state}/dt"
        entries.append(line_entry(label, color=palette.nullcline, linewidth=0.9))
    for way in plane.exits:
        left = axes.contourf(x, y, way.open.T, [0.0, np.inf], colors="none", hatches=[LEAVES])
        left.set_edgecolor(palette.slow)
        left.set_linewidth(0.0)
        axes.contour(x, y, way.open.T, [0.0], colors=[palette.switch], linewidths=1.8)
        label = f"from here on to {way.target}"
        entries.append(line_entry(label, color=palette.switch, linewidth=1.8))
    return entries

"""Small multiples: the same portrait at several values of one control, or slices of one state."""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from specc.figures.areas import draw_shares
from specc.figures.axes_of_states import same_scale
from specc.figures.legend import Entry, draw_legend
from specc.figures.line import draw_line
from specc.figures.palettes import PALETTES
from specc.figures.panel import Panel
from specc.figures.paper import (
    BELOW,
    LEFT,
    LEGEND,
    LINE,
    axes_at,
    heading,
    held_text,
    names_in,
    new_figure,
    panel_size,
    write_heading,
)
from specc.figures.plane import draw_plane
from specc.figures.quantities import quantity
from specc.figures.style import look
from specc.figures.style_names import Style
from verifier.topology.features import Portrait

WEIGHT: Final = 0.72
"""Of the lines in small panels."""

WIDEST: Final = 7.4
"""Of all panels together, in inches."""

GAP: Final = 0.32
"""Between panels, in inches."""

ABOVE: Final = 0.25
"""For what a panel says above it, in inches."""


def draw_multiples(
    portraits: Sequence[Portrait], swept: str, style: Style = Style.SCREEN
) -> Figure:
    """One panel a portrait, all over the same axes, named by the value of `swept`."""
    palette = PALETTES[style]
    first = portraits[0]
    columns, size = _arrangement(first, len(portraits))
    rows = math.ceil(len(portraits) / columns)
    width = columns * size[0] + (columns - 1) * GAP
    height = rows * (size[1] + ABOVE) + (rows - 1) * GAP
    fixed = tuple(h for h in first.held if h.name != swept)
    above = [line for line in (first.about, held_text(fixed)) if line]
    notes = list(dict.fromkeys(note for p in portraits for note in p.notes))
    text = heading(first.name, above, notes, width + LEGEND, names_in(first))
    below = BELOW + LINE * len(text.below)
    with look(palette):
        figure = new_figure(LEFT + width + LEGEND, below + height + text.height + 0.1, palette)
        entries: list[Entry] = []
        for k, portrait in enumerate(portraits):
            row, column = divmod(k, columns)
            left = LEFT + column * (size[0] + GAP)
            up = below + (rows - 1 - row) * (size[1] + ABOVE + GAP)
            axes = axes_at(figure, (left, up), size)
            axes.set_facecolor(palette.paper)
            panel = Panel(axes, first.axes, palette, np.array(size), WEIGHT)
            entries += _draw(panel, portrait)
            draw_shares(panel, portrait)
            _name(axes, portrait, swept)
            _share_labels(axes, first_column=column == 0, last_row=k + columns >= len(portraits))
        if len(first.axes) == 1 and first.every == 0.0:
            _share_rates(figure.axes)
        corner = np.array([LEFT + width + GAP, below + height - ABOVE]) / figure.get_size_inches()
        draw_legend(figure, entries, (float(corner[0]), float(corner[1])))
        top = below + height + text.height - 0.12
        write_heading(figure, text, palette, LEFT, top, below - BELOW + 0.05)
    return figure


def _arrangement(portrait: Portrait, count: int) -> tuple[int, tuple[float, float]]:
    """How many columns, and the size of a panel."""
    columns = min(count, 4 if count > 6 or count == 4 else 3)
    if count == 4:
        columns = 2
    widest = min(3.2, (WIDEST - (columns - 1) * GAP) / columns)
    most = (widest, 0.92 * widest)
    keep = same_scale(portrait.axes) if len(portrait.axes) == 2 else portrait.every > 0.0
    return columns, panel_size((*portrait.axes, *portrait.axes)[:2], most, same_scale=keep)


def _draw(panel: Panel, portrait: Portrait) -> list[Entry]:
    if len(portrait.axes) == 1:
        return draw_line(panel.axes, portrait, panel.palette, is_small=True)
    return draw_plane(panel, portrait)


def _name(axes: Axes, portrait: Portrait, swept: str) -> None:
    """The value that the panel stands for, above it."""
    (held,) = (h for h in portrait.held if h.name == swept)
    value = held.label or quantity(held.value, held.unit)
    axes.set_title(f"{swept} = {value}", loc="left", fontsize=9.0, pad=4)


def _share_rates(panels: Sequence[Axes]) -> None:
    """One vertical scale for the rates of all panels, as only the left ones are labelled."""
    ends = [axes.get_ylim() for axes in panels]
    for axes in panels:
        axes.set_ylim(min(low for low, _ in ends), max(high for _, high in ends))


def _share_labels(axes: Axes, *, first_column: bool, last_row: bool) -> None:
    """Ticks are labelled at the outer edge only."""
    axes.tick_params(labelsize=7.5)
    axes.xaxis.label.set_fontsize(9.0)
    axes.yaxis.label.set_fontsize(9.0)
    axes.tick_params(labelleft=first_column, labelbottom=last_row)
    if not first_column:
        axes.set_ylabel("")
    if not last_row:
        axes.set_xlabel("")

"""Phase portraits: a plane for two axes, a phase line or a cobweb for one, a box for three."""

from typing import Final

import numpy as np
from matplotlib.figure import Figure

from specc.figures.axes_of_states import same_scale
from specc.figures.legend import draw_legend
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
    new_figure,
    panel_size,
    write_heading,
)
from specc.figures.plane import draw_plane
from specc.figures.style import look
from specc.figures.style_names import Style
from specc.portrait_text import proof_sentences
from verifier.topology.features import Portrait

MOST: Final = (4.7, 4.3)
"""The size of the one panel of a portrait, in inches, at most."""


def draw_portrait(portrait: Portrait, style: Style = Style.SCREEN) -> Figure:
    """The portrait as a figure: SVG, PNG and PDF come of it by `style.rendered`."""
    palette = PALETTES[style]
    planar = len(portrait.axes) == 2
    keep = same_scale(portrait.axes) if planar else portrait.every > 0.0
    size = panel_size((*portrait.axes, *portrait.axes)[:2], MOST, same_scale=keep)
    about = [portrait.about] if portrait.about else []
    held = [held_text(portrait.held)] if portrait.held else []
    small = [*proof_sentences(portrait), *portrait.notes]
    text = heading(portrait.name, [*about, *held], small, size[0] + LEGEND)
    below = BELOW + LINE * len(text.below)
    with look(palette):
        figure = new_figure(LEFT + size[0] + LEGEND, below + size[1] + text.height + 0.1, palette)
        axes = axes_at(figure, (LEFT, below), size)
        axes.set_facecolor(palette.paper)
        if planar:
            legend = draw_plane(Panel(axes, portrait.axes, palette, np.array(size)), portrait)
        else:
            legend = draw_line(axes, portrait, palette)
        draw_legend(axes, legend, (1.0 + 0.18 / size[0], 1.0))
        top = below + size[1] + text.height
        write_heading(figure, text, palette, LEFT, top, below - BELOW + 0.05)
    return figure

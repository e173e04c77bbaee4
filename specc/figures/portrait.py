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
    names_in,
    new_figure,
    panel_size,
    write_heading,
)
from specc.figures.plane import draw_plane
from specc.figures.space import draw_space, size_of_space
from specc.figures.style import look
from specc.figures.style_names import Style
from specc.texts.portrait import proof_sentences
from verifier.topology.features import Portrait

MOST: Final = (4.7, 4.3)
"""The size of the one panel of a portrait, in inches, at most."""

FLAT: Final = (4.7, 2.9)
"""The same of a phase line."""


def draw_portrait(portrait: Portrait, style: Style = Style.SCREEN) -> Figure:
    """The portrait as a figure: SVG, PNG and PDF come of it by `style.rendered`."""
    palette = PALETTES[style]
    size = _size(portrait)
    about = [portrait.about] if portrait.about else []
    held = [held_text(portrait.held)] if portrait.held else []
    small = [*proof_sentences(portrait), *portrait.notes]
    text = heading(portrait.name, [*about, *held], small, size[0] + LEGEND, names_in(portrait))
    frame = 0.1 if len(portrait.axes) == 3 else BELOW
    below = frame + LINE * len(text.below)
    with look(palette):
        figure = new_figure(LEFT + size[0] + LEGEND, below + size[1] + text.height + 0.1, palette)
        axes = axes_at(figure, (LEFT, below), size)
        axes.set_facecolor(palette.paper)
        match len(portrait.axes):
            case 1:
                legend = draw_line(axes, portrait, palette)
            case 2:
                legend = draw_plane(Panel(axes, portrait.axes, palette, np.array(size)), portrait)
            case _:
                legend = draw_space(axes, portrait, palette)
        draw_legend(axes, legend, (1.0 + 0.18 / size[0], 1.0))
        top = below + size[1] + text.height
        write_heading(figure, text, palette, LEFT, top, below - frame + 0.05)
    return figure


def _size(portrait: Portrait) -> tuple[float, float]:
    """The size of the panel: two lengths to one scale, a cobweb square, a box as it is seen."""
    match len(portrait.axes):
        case 1:
            state = portrait.axes[0]
            is_map = portrait.every > 0.0
            return panel_size((state, state), MOST if is_map else FLAT, same_scale=is_map)
        case 2:
            return panel_size(portrait.axes, MOST, same_scale=same_scale(portrait.axes))
        case _:
            return size_of_space()

"""Phase portraits: a plane for two axes, a phase line or a cobweb for one."""

import textwrap
from typing import Final

from matplotlib.figure import Figure

from specc.figures.line import draw_line
from specc.figures.plane import draw_plane
from specc.figures.quantities import quantity
from specc.figures.style import FAINT, look
from verifier.topology.features import Held, Portrait

WIDTH: Final = 7.4
HEIGHT: Final = 5.4


def draw_portrait(portrait: Portrait) -> Figure:
    """The portrait as a figure: SVG, PNG and PDF come of it by `style.rendered`."""
    with look():
        figure = Figure(figsize=(WIDTH, HEIGHT))
        if len(portrait.axes) == 2:
            axes, legend = draw_plane(figure, portrait)
        else:
            axes, legend = draw_line(figure, portrait)
        axes.legend(
            handles=legend,
            labels=[str(entry[0].get_label()) for entry in legend],
            loc="upper left",
            bbox_to_anchor=(1.03, 1.0),
            borderaxespad=0.0,
        )
        _title(figure, portrait)
        _notes(figure, portrait)
    return figure


def _title(figure: Figure, portrait: Portrait) -> None:
    """The name, and below it what is held at which values."""
    figure.text(0.1, 0.955, portrait.name, fontsize=12.5, fontweight="bold", va="center")
    lines = textwrap.wrap(", ".join(map(_held, portrait.held)), 92)
    shown = lines if len(lines) < 3 else [lines[0], lines[1] + " …"]
    figure.text(0.1, 0.928, "\n".join(shown), fontsize=8.5, color=FAINT, va="top")


def _notes(figure: Figure, portrait: Portrait) -> None:
    """What a reader must know beside the picture, below it."""
    lines = [line for note in portrait.notes for line in textwrap.wrap(note, 92)]
    if lines:
        figure.text(0.1, 0.012, "\n".join(lines), fontsize=8.5, color=FAINT, va="top")


def _held(held: Held) -> str:
    return f"{held.name} = {held.label or quantity(held.value, held.unit)}"

"""Panels over the problems that a learner tried: curves of several runs, and what others state."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from runtime.arrays import Array, Integers
from specc.figures.legend import Entry, Look, draw_legend, line_entry
from specc.figures.palettes import Palette
from specc.figures.paper import BELOW, LEFT, Heading, axes_at, heading, new_figure, write_heading
from specc.figures.quantities import number
from specc.figures.style import bare

WIDTH: Final = 5.4
GAP: Final = 0.24
BESIDE: Final = 2.1
"""For the legend."""

POINTS: Final = 400
"""Of a curve: more are only bytes."""

DASHES: Final = (0.0, (4.0, 1.6))


@final
@dataclass(frozen=True, slots=True)
class Stated:
    """What somebody else says of a curve: tries and values, each from and to.

    A ring marks it where both are one number, else a line or a frame.
    """

    text: str
    tries: tuple[float, float]
    values: tuple[float, float]


def panels(
    title: str,
    about: Sequence[str],
    heights: Sequence[float],
    end: float,
    palette: Palette,
    over: str = "explore problems",
) -> tuple[Figure, list[Axes]]:
    """A figure with panels one above the other, of heights in inches, up to `end` problems.

    over: what they are called where they are other things than problems.
    """
    text: Heading = heading(title, list(about), [], WIDTH + BESIDE)
    tall = sum(heights) + GAP * (len(heights) - 1)
    figure = new_figure(LEFT + WIDTH + BESIDE, BELOW + tall + text.height + 0.1, palette)
    above, made = BELOW + tall, list[Axes]()
    for height in heights:
        axes = axes_at(figure, (LEFT, above - height), (WIDTH, height))
        axes.set_facecolor(palette.paper)
        bare(axes)
        axes.set_xlim(0.0, max(end, 1.0))
        axes.xaxis.set_major_formatter(FuncFormatter(_thousands))
        axes.tick_params(labelbottom=False)
        above -= height + GAP
        made.append(axes)
    made[-1].tick_params(labelbottom=True)
    made[-1].set_xlabel(over)
    write_heading(figure, text, palette, LEFT, BELOW + tall + text.height, BELOW)
    return figure, made


def draw_runs(axes: Axes, runs: Sequence[tuple[Integers, Array | Integers]], style: Look) -> None:
    """The mean of several runs (places, values), in the band from the lowest to the highest."""
    begin = max(float(places[0]) for places, _ in runs)
    grid = np.linspace(begin, max(float(places[-1]) for places, _ in runs), POINTS)
    values = np.stack([_latest(grid, places, value) for places, value in runs])
    if len(runs) > 1:
        low, high = values.min(axis=0), values.max(axis=0)
        axes.fill_between(grid, low, high, color=style["color"], alpha=0.2, linewidth=0.0)
    axes.plot(grid, values.mean(axis=0), zorder=3, **style)


def _latest(grid: Array, places: Integers, values: Array | Integers) -> Array:
    """The value that stood at each place of the grid."""
    at = np.searchsorted(places, grid, side="right") - 1
    return np.asarray(values[np.maximum(at, 0)], np.float64)


def mark(
    axes: Axes, stated: Sequence[Stated], palette: Palette, heights: Sequence[float] = ()
) -> None:
    """What others state of the problems shown; with its text at heights (shares of the panel)."""
    shown = [each for each in stated if each.tries[0] <= axes.get_xlim()[1]]
    for k, each in enumerate(shown):
        (left, right), (low, high) = each.tries, each.values
        if left == right and low == high:
            look: Look = {"markerfacecolor": "none", "markeredgecolor": palette.ink}
            axes.plot(left, low, "o", markersize=6.5, zorder=6, clip_on=False, **look)
        else:
            frame = [left, right, right, left, left], [low, low, high, high, low]
            axes.plot(*frame, color=palette.ink, linewidth=1.6, zorder=6, clip_on=False)
        if k < len(heights):
            _say(axes, each, heights[k], palette)


def _say(axes: Axes, stated: Stated, height: float, palette: Palette) -> None:
    """The text at a height beside its mark, and a thin line between them."""
    middle = 0.5 * (stated.tries[0] + stated.tries[1])
    end = axes.get_xlim()[1]
    is_right = middle > 0.6 * end
    axes.annotate(
        stated.text,
        xy=(middle, 0.5 * (stated.values[0] + stated.values[1])),
        xytext=((middle + (-0.03 if is_right else 0.03) * end) / end, height),
        textcoords="axes fraction",
        ha="right" if is_right else "left",
        va="center",
        fontsize=8.5,
        arrowprops={
            "arrowstyle": "-",
            "color": palette.faint,
            "linewidth": 0.7,
            "shrinkB": 4.0,
            "relpos": (1.0 if is_right else 0.0, 0.5),
        },
        bbox={"boxstyle": "square,pad=0.15", "facecolor": palette.paper, "edgecolor": "none"},
        zorder=5,
    )


def explain(figure: Figure, axes: Axes, entries: Sequence[Entry]) -> None:
    """The legend, beside a panel."""
    place = axes.get_position()
    width = figure.get_size_inches()[0]
    draw_legend(figure, entries, ((LEFT + WIDTH + 0.18) / width, place.y1))


def stated_entry(palette: Palette) -> Entry:
    """What the legend says of the marks."""
    ring: Look = {"linestyle": "none", "marker": "o", "markersize": 6.5}
    return line_entry("stated by others", markerfacecolor="none", color=palette.ink, **ring)


def percent_tick(value: float, _: int) -> str:
    """A share as a tick's label."""
    return f"{number(100.0 * value)} %"


def _thousands(value: float, _: int) -> str:
    return f"{value:,.0f}"

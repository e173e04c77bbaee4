"""Learning curves in a world: steps to the goal, return and boxes over the episodes."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from lcs.arrays import Array, Integers
from lcs.curves import over_last
from specc.figures.learning_panels import DASHES, draw_runs, explain, panels
from specc.figures.legend import Look, line_entry
from specc.figures.palettes import PALETTES, Palette
from specc.figures.quantities import number
from specc.figures.style import look
from specc.figures.style_names import Style

HEIGHTS: Final = (2.2, 2.2, 1.3)
"""Of the panels, in inches."""

WINDOW: Final = 50
"""Episodes with tries that are averaged: single ones differ by where they begin."""

MARKS: Final = (1, 2, 5)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Walk:
    """A run over E episodes, all (E,): what the best actions lead to after it, on average.

    tried_steps, tried_returns: of the episode itself, in which actions were tried.
    optimal_steps, optimal_returns: of the best that can be done from the same starts.
    """

    steps: Array
    returns: Array
    tried_steps: Integers
    tried_returns: Array
    boxes: Integers
    optimal_steps: float
    optimal_returns: float


def draw_episodes(
    runs: Sequence[Walk], title: str, *, about: Sequence[str] = (), style: Style = Style.SCREEN
) -> Figure:
    """Steps to the goal and return, beside the optimum; below, how many boxes there were.

    Args:
        runs: of one experiment; several are drawn as their mean, in a band from lowest to highest.
        title: of the picture.
        about: sentences under the title.
        style: its colours and type.
    """
    palette = PALETTES[style]
    with look(palette):
        end = float(max(len(run.steps) for run in runs))
        figure, (steps, returns, boxes) = panels(title, about, HEIGHTS, end, palette, "episodes")
        best = np.mean([run.optimal_steps for run in runs])
        curves = [(run.steps, run.tried_steps) for run in runs]
        _draw_beside(figure, steps, curves, float(best), palette)
        steps.set_ylabel("steps to the goal")
        best = np.mean([run.optimal_returns for run in runs])
        curves_of_returns = [(run.returns, run.tried_returns) for run in runs]
        _draw_beside(figure, returns, curves_of_returns, float(best), palette)
        returns.set_ylabel("return, not discounted")
        living: Look = {"color": palette.ink, "linewidth": 1.4}
        draw_runs(boxes, [(_episodes(run.boxes), run.boxes) for run in runs], living)
        boxes.set_ylabel("boxes")
        boxes.set_ylim(bottom=0.0)
        boxes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))
        explain(figure, boxes, [line_entry("boxes with what each\naction is worth", **living)])
    return figure


def _draw_beside(
    figure: Figure,
    axes: Axes,
    curves: Sequence[tuple[Array, Array | Integers]],
    optimal: float,
    palette: Palette,
) -> None:
    """The best actions, the episodes with tries, and the optimum, on a scale of powers of ten."""
    tries: Look = {"color": palette.fast, "linewidth": 0.9}
    best: Look = {"color": palette.nullcline, "linewidth": 1.8}
    optimum: Look = {"color": palette.cycle, "linewidth": 1.4, "linestyle": DASHES}
    tried = [over_last(np.asarray(each, np.float64), WINDOW) for _, each in curves]
    draw_runs(axes, [(_episodes(each), each) for each in tried], tries)
    draw_runs(axes, [(_episodes(each), each) for each, _ in curves], best)
    axes.axhline(optimal, zorder=4, **optimum)
    shown = np.concatenate([each for each, _ in curves] + tried)
    _scale(axes, min(float(shown.min()), optimal), max(float(shown.max()), optimal))
    entries = [
        line_entry("the best actions,\nfollowed from all starts", **best),
        line_entry(f"optimum: {number(optimal, 4)}", **optimum),
        line_entry(f"while learning, with tries\n(mean of {WINDOW} episodes)", **tries),
    ]
    explain(figure, axes, entries)


def _scale(axes: Axes, low: float, high: float) -> None:
    """Powers of ten on both sides of 0, between which it is linear from -1 to 1."""
    axes.set_yscale("symlog", linthresh=1.0)
    begin, end = sorted((low * (0.8 if low > 0.0 else 1.25), high * (1.25 if high > 0.0 else 0.8)))
    axes.set_ylim(begin, end)
    marks = [m * 10.0**k for k in range(9) for m in MARKS]
    ticks = [each for each in (*(-mark for mark in marks), 0.0, *marks) if begin <= each <= end]
    axes.yaxis.set_major_locator(FixedLocator(ticks[:: 1 + len(ticks) // 8]))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: number(value)))


def _episodes(values: Array | Integers) -> Integers:
    """1, 2, ...: a value stands after its episode."""
    return np.arange(1, len(values) + 1)

"""Learning curves as the thesis draws them (figures 4.1 and 4.3), and how many tests went wrong."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from lcs.curves import Curve, over_last
from runtime.arrays import Array, Integers
from specc.figures.learning_panels import (
    DASHES,
    Stated,
    draw_runs,
    explain,
    mark,
    panels,
    percent_tick,
    stated_entry,
)
from specc.figures.legend import Look, line_entry
from specc.figures.palettes import PALETTES, Palette
from specc.figures.style import look
from specc.figures.style_names import Style

HEIGHTS: Final = (2.6, 1.9)
"""Of the panels, in inches."""

MANY: Final = 1000
"""Tests over which the lower panel counts: enough to see a few wrong ones."""

LEAST: Final = 0.5 / MANY
"""Where no test was wrong, on a scale that has no zero."""

FIRST: Final = 20
"""Tests before a curve begins: the mean of fewer says nothing."""

SAID: Final = (0.56, 0.68, 0.8, 0.44, 0.32)
"""Heights of the texts of marks: between the two curves there is room."""


def draw_learning(
    runs: Sequence[Curve],
    title: str,
    *,
    stated: Sequence[Stated] = (),
    window: int = 50,
    about: Sequence[str] = (),
    style: Style = Style.SCREEN,
) -> Figure:
    """Performance and system error over the last tests; below, how many of more tests were wrong.

    Args:
        runs: of one experiment; several are drawn as their mean, in a band from lowest to highest.
        title: of the picture.
        stated: performance that others report, as shares of one; marked in both panels.
        window: tests that performance and error are the mean of.
        about: sentences under the title.
        style: its colours and type.
    """
    palette = PALETTES[style]
    with look(palette):
        end = max(float(run.tries[-1]) for run in runs)
        figure, (shares, wrong) = panels(title, about, HEIGHTS, end, palette)
        _draw_shares(figure, shares, runs, window, palette, is_marked=bool(stated))
        _draw_wrong(figure, wrong, runs, palette)
        mark(shares, stated, palette, SAID)
        mark(wrong, [_as_wrong(each) for each in stated], palette)
    return figure


def _draw_shares(
    figure: Figure,
    axes: Axes,
    runs: Sequence[Curve],
    window: int,
    palette: Palette,
    *,
    is_marked: bool,
) -> None:
    axes.set_ylim(0.0, 1.02)
    axes.set_ylabel(f"over the last {window} tests")
    axes.yaxis.set_major_formatter(FuncFormatter(percent_tick))
    right: Look = {"color": palette.nullcline, "linewidth": 1.2}
    error: Look = {"color": palette.cycle, "linewidth": 1.2, "linestyle": DASHES}
    draw_runs(axes, [_begun(run, over_last(run.right, window)) for run in runs], right)
    draw_runs(axes, [_begun(run, over_last(run.error, window)) for run in runs], error)
    entries = [
        line_entry("performance:\ntests that were right", **right),
        line_entry("system error, of the\nrange of rewards", **error),
    ]
    explain(figure, axes, [*entries, *([stated_entry(palette)] if is_marked else [])])


def _draw_wrong(figure: Figure, axes: Axes, runs: Sequence[Curve], palette: Palette) -> None:
    axes.set_yscale("log")
    axes.set_ylim(LEAST, 0.6)
    axes.set_ylabel(f"over the last {MANY:,}")
    axes.yaxis.set_major_formatter(FuncFormatter(percent_tick))
    wrong: Look = {"color": palette.unstable, "linewidth": 1.2}
    drawn = [np.maximum(over_last(~run.right, MANY), LEAST) for run in runs]
    draw_runs(axes, list(map(_begun, runs, drawn)), wrong)
    explain(figure, axes, [line_entry("tests that were wrong", **wrong)])


def _begun(run: Curve, values: Array) -> tuple[Integers, Array]:
    """A curve (places, values) from where there were enough tests."""
    first = min(FIRST, len(values) - 1)
    return run.tries[first:], values[first:]


def _as_wrong(stated: Stated) -> Stated:
    low, high = stated.values
    return replace(stated, values=(max(1.0 - high, LEAST), max(1.0 - low, LEAST)))

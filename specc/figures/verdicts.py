"""The whole judgement at a glance: how far each variable departs, in tolerances."""

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from specc.figures.style import BLUE, FAINT, GREEN, INK, VERMILION, bare, framed, look
from verifier.report.report import HorizonFigure, Report, Standing

COLORS: Final = {
    Standing.WITHIN: GREEN,
    Standing.EXCEEDED: VERMILION,
    Standing.UNDECIDED: BLUE,
}
MARKERS: Final = {Standing.WITHIN: "o", Standing.EXCEEDED: "X", Standing.UNDECIDED: "D"}
WIDEST: Final = 3.0
"""Departures beyond so many tolerances are drawn at the edge, as arrows."""


def draw_verdicts(report: Report) -> Figure:
    """A row per variable: the departure at the horizon with its interval, beside the tolerance."""
    with look():
        figure = Figure(figsize=(7.2, 0.7 + 0.42 * len(report.variables)))
        longest = max(len(variable.name) for variable in report.variables)
        left = 0.25 + min(2.0, 0.085 * longest)
        axes = figure.add_subplot(framed(figure, 1, 1, (left, 0.2, 0.5, 0.1))[0])
        bare(axes)
        axes.spines["left"].set_visible(False)
        axes.tick_params(axis="y", length=0)
        axes.axvspan(0.0, 1.0, color=GREEN, alpha=0.12, linewidth=0.0)
        axes.axvline(1.0, color=GREEN, linewidth=1.2, linestyle=(0, (4, 2)))
        for row, variable in enumerate(report.variables):
            _row(axes, row, variable.declared, variable.standing)
        axes.set_yticks(range(len(report.variables)), [v.name for v in report.variables])
        axes.set_ylim(len(report.variables) - 0.5, -0.5)
        axes.set_xlim(0.0, _reach(report))
        axes.set_xlabel("departure at the horizon / tolerance")
    return figure


def _row(axes: Axes, row: int, figure: HorizonFigure, standing: Standing) -> None:
    low, value, high = (
        size / figure.tolerance
        for size in (figure.interval.low, figure.departure, figure.interval.high)
    )
    color = COLORS[standing]
    axes.plot([0.0, 10.0 * WIDEST], [row, row], color=FAINT, linewidth=0.4, zorder=1)
    axes.plot([max(low, 0.0), min(high, WIDEST)], [row, row], color=color, linewidth=2.4, zorder=3)
    for end in (low, high):
        if np.isfinite(end):
            axes.plot(end, row, "|", color=color, markersize=9.0, markeredgewidth=1.6, zorder=3)
    beyond = not value <= WIDEST
    axes.plot(
        min(value, WIDEST) if np.isfinite(value) else WIDEST,
        row,
        ">" if beyond else MARKERS[standing],
        color=color,
        markeredgecolor=INK,
        markeredgewidth=0.6,
        markersize=8.0,
        zorder=4,
        clip_on=False,
    )


def _reach(report: Report) -> float:
    ends = [v.declared.interval.high / v.declared.tolerance for v in report.variables]
    known = [end for end in ends if np.isfinite(end)]
    return float(min(WIDEST, 1.1 * max([1.3, *known])))

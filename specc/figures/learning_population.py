"""How many rules there were, were born and died, as in figures 4.2 and 4.4 of the thesis."""

from collections.abc import Sequence
from typing import Final

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from lcs.course import Course
from lcs.curves import tries_of
from runtime.arrays import Integers
from specc.figures.learning_panels import (
    DASHES,
    Stated,
    draw_runs,
    explain,
    mark,
    panels,
    stated_entry,
)
from specc.figures.legend import Look, line_entry
from specc.figures.palettes import PALETTES, Palette
from specc.figures.style import look
from specc.figures.style_names import Style

HEIGHTS: Final = (2.6, 1.9)
"""Of the panels, in inches."""

SAID: Final = (0.27, 0.16, 0.05)
"""Heights of the texts of marks: below a curve that rises and falls there is room."""


def draw_population(
    runs: Sequence[Course],
    title: str,
    *,
    stated: Sequence[Stated] = (),
    about: Sequence[str] = (),
    style: Style = Style.SCREEN,
) -> Figure:
    """Rules of all actions over the problems tried; below, births and deaths so far.

    Args:
        runs: of one experiment; several are drawn as their mean, in a band from lowest to highest.
        title: of the picture.
        stated: numbers of rules that others report.
        about: sentences under the title.
        style: its colours and type.
    """
    palette = PALETTES[style]
    with look(palette):
        end = max(float(tries_of(run)[-1]) for run in runs)
        figure, (rules, turnover) = panels(title, about, HEIGHTS, end, palette)
        living: Look = {"color": palette.ink, "linewidth": 1.4}
        _draw(rules, [(run, run.rules) for run in runs], living)
        rules.set_ylabel("rules")
        mark(rules, stated, palette, SAID)
        rules.set_ylim(bottom=0.0)
        marked = [stated_entry(palette)] if stated else []
        explain(figure, rules, [line_entry("rules", **living), *marked])
        _draw_turnover(figure, turnover, runs, palette)
    return figure


def _draw_turnover(figure: Figure, axes: Axes, runs: Sequence[Course], palette: Palette) -> None:
    births: Look = {"color": palette.stable, "linewidth": 1.4}
    deaths: Look = {"color": palette.alarm, "linewidth": 1.4, "linestyle": DASHES}
    _draw(axes, [(run, run.births) for run in runs], births)
    _draw(axes, [(run, run.deaths) for run in runs], deaths)
    axes.set_ylabel("so far")
    axes.set_ylim(bottom=0.0)
    explain(figure, axes, [line_entry("births", **births), line_entry("deaths", **deaths)])


def _draw(axes: Axes, runs: Sequence[tuple[Course, Integers]], style: Look) -> None:
    draw_runs(axes, [(tries_of(run), values) for run, values in runs], style)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))

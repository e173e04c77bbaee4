"""Curves of a training: reward and success over episodes, exploring and tried apart."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from lcs.arrays import Array, Integers
from specc.figures.learning_panels import DASHES, explain, panels, percent_tick
from specc.figures.legend import Look, line_entry
from specc.figures.palettes import PALETTES, Palette
from specc.figures.quantities import number
from specc.figures.style import look
from specc.figures.style_names import Style
from verifier.report.wording import percent

HEIGHTS: Final = (2.2, 1.9)
"""Of the panels, in inches."""
LEARNT_FROM: Final = "episodes learnt from, those of races included"


@final
@dataclass(frozen=True, eq=False, slots=True)
class Improving:
    """A training of G generations, all (G,).

    episodes: after how many. explored, tried: rewards of an episode, on average.
    explored_success, tried_success: shares; low, high: the interval of the latter. best: which
    generation was kept. final: its reward and success where it was made plain. worlds: how many
    each policy was tried in.
    """

    episodes: Integers
    explored: Array
    tried: Array
    explored_success: Array
    tried_success: Array
    low: Array
    high: Array
    best: int
    final: tuple[float, float]
    worlds: int


def draw_training(
    one: Improving, title: str, *, about: Sequence[str] = (), style: Style = Style.SCREEN
) -> Figure:
    """Reward, and below it success, over the episodes learnt from; the best is marked."""
    palette = PALETTES[style]
    with look(palette):
        end = float(one.episodes[-1]) * 1.02
        figure, (rewards, successes) = panels(title, about, HEIGHTS, end, palette, LEARNT_FROM)
        rewards.set_ylabel("reward of an episode")
        rewards.yaxis.set_major_formatter(FuncFormatter(lambda value, _: number(value)))
        successes.set_ylabel("success")
        successes.set_ylim(-0.03, 1.03)
        successes.yaxis.set_major_formatter(FuncFormatter(percent_tick))
        _draw(rewards, one, (one.explored, one.tried), one.final[0], palette)
        successes.vlines(
            one.episodes, one.low, one.high, color=_tried(palette)["color"], alpha=0.35, lw=2.5
        )
        shares = one.explored_success, one.tried_success
        _draw(successes, one, shares, one.final[1], palette)
        entries = [
            line_entry(
                f"the best so far, in {one.worlds}\nother worlds each time", **_tried(palette)
            ),
            line_entry("while exploring, with\ntries, in other worlds", **_explored(palette)),
            line_entry(_kept(one), **_best(palette)),
        ]
        explain(figure, rewards, entries)
        bar: Look = {"color": _tried(palette)["color"], "alpha": 0.35, "linewidth": 2.5}
        explain(figure, successes, [line_entry("95 % interval", **bar)])
        figure.align_ylabels([rewards, successes])
    return figure


def _kept(one: Improving) -> str:
    reward, success = one.final
    did = f"reward {number(reward)}, success {percent(success)}"
    return f"what is kept, in the worlds\nwhere it was made plain:\n{did}"


def _draw(
    axes: Axes, one: Improving, curves: tuple[Array, Array], final: float, palette: Palette
) -> None:
    """What exploring got, and the best lists; a ring for the one that is kept."""
    explored, tried = curves
    axes.plot(one.episodes, explored, zorder=3, **_explored(palette))
    axes.plot(one.episodes, tried, zorder=4, **_tried(palette))
    axes.plot(one.episodes[one.best], final, zorder=5, clip_on=False, **_best(palette))


def _tried(palette: Palette) -> Look:
    return {"color": palette.nullcline, "linewidth": 1.6, "marker": "o", "markersize": 3.5}


def _explored(palette: Palette) -> Look:
    plain: Look = {"marker": "s", "markersize": 2.5, "linestyle": DASHES}
    return {"color": palette.fast, "linewidth": 1.0, **plain}


def _best(palette: Palette) -> Look:
    ring: Look = {"linestyle": "none", "marker": "o", "markersize": 9.0, "markeredgewidth": 1.4}
    return {"markerfacecolor": "none", "color": palette.ink, **ring}

"""Bifurcation diagrams: fixed points and cycles against one control.

Stable branches are solid, unstable ones dashed, saddles dotted; a cycle is the band between its
lowest and its highest value. One panel for each variable of the slice.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import Final, TypeVar

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from specc.figures.curves import CYCLE_DASHES, Dashes
from specc.figures.legend import Entry, Look, draw_legend, line_entry
from specc.figures.palettes import PALETTES, Palette
from specc.figures.paper import (
    BELOW,
    LEFT,
    LEGEND,
    LINE,
    axes_at,
    heading,
    held_text,
    new_figure,
    write_heading,
)
from specc.figures.quantities import axis_label
from specc.figures.style import bare, look
from specc.figures.style_names import Style
from specc.texts.branches import bifurcation_sentence
from verifier.topology.branches.continuation import Branches, Change
from verifier.topology.features import AxisRange, PointKind, Stability

T = TypeVar("T", PointKind, Stability)

WIDTH: Final = 4.9
HEIGHT: Final = {1: 3.4, 2: 2.5, 3: 1.9}
"""Of a panel, in inches, by the number of panels."""

GAP: Final = 0.22

DOTS: Final = (0.0, (1.1, 1.4))
DASHES: Final = (0.0, (4.0, 2.0))

POINT_DASHES: Final[dict[PointKind, Dashes]] = {
    PointKind.STABLE_NODE: "-",
    PointKind.STABLE_FOCUS: "-",
    PointKind.UNSTABLE_NODE: DASHES,
    PointKind.UNSTABLE_FOCUS: DASHES,
    PointKind.SADDLE: DOTS,
    PointKind.CENTER: "-",
    PointKind.DEGENERATE: DOTS,
}

GROUPS: Final[dict[PointKind, str]] = {
    PointKind.STABLE_NODE: "stable fixed point",
    PointKind.STABLE_FOCUS: "stable fixed point",
    PointKind.UNSTABLE_NODE: "unstable fixed point",
    PointKind.UNSTABLE_FOCUS: "unstable fixed point",
    PointKind.SADDLE: "saddle",
    PointKind.CENTER: "center",
    PointKind.DEGENERATE: "degenerate fixed point",
}

MARKS: Final[dict[Change, str]] = {
    Change.SADDLE_NODE: "o",
    Change.PITCHFORK: "P",
    Change.TRANSCRITICAL: "X",
    Change.HOPF: "*",
    Change.PERIOD_DOUBLING: "D",
    Change.CYCLES_MEET: "s",
    Change.CYCLE_ENDS: "v",
    Change.LEAVES: "|",
    Change.OTHER: "d",
    Change.TYPE: ".",
}


def draw_bifurcations(branches: Branches, style: Style = Style.SCREEN) -> Figure:
    """One panel a variable, all over the control; the sentences of the bifurcations below."""
    palette = PALETTES[style]
    count = len(branches.axes)
    tall = HEIGHT[min(count, 3)]
    height = count * tall + (count - 1) * GAP
    above = [line for line in (branches.about, held_text(branches.held)) if line]
    seen = (*branches.bifurcations, *branches.retypings)
    changes = [bifurcation_sentence(b, branches.unit) for b in seen]
    names = [*(axis.name for axis in branches.axes), *(held.name for held in branches.held)]
    text = heading(branches.name, above, [*changes, *branches.notes], WIDTH + LEGEND, names)
    below = BELOW + LINE * len(text.below)
    with look(palette):
        figure = new_figure(LEFT + WIDTH + LEGEND, below + height + text.height + 0.1, palette)
        entries: list[Entry] = []
        for j, axis in enumerate(branches.axes):
            up = below + (count - 1 - j) * (tall + GAP)
            axes = axes_at(figure, (LEFT, up), (WIDTH, tall))
            axes.set_facecolor(palette.paper)
            _frame(axes, branches, axis, is_last=j == count - 1)
            entries += _cycles(axes, branches, j, palette)
            entries += _points(axes, branches, j, palette)
            entries += _changes(axes, branches, j, palette)
        corner = (LEFT + WIDTH + 0.18) / figure.get_size_inches()[0]
        draw_legend(figure, entries, (corner, (below + height) / figure.get_size_inches()[1]))
        top = below + height + text.height
        write_heading(figure, text, palette, LEFT, top, below - BELOW + 0.05)
    return figure


def _frame(axes: Axes, branches: Branches, axis: AxisRange, *, is_last: bool) -> None:
    unit = branches.unit
    bare(axes)
    axes.set_xlim(branches.low / unit.scale, branches.high / unit.scale)
    axes.set_ylabel(axis_label(axis.name, axis.unit))
    axes.tick_params(labelbottom=is_last)
    if is_last:
        axes.set_xlabel(axis_label(branches.control, unit))


def _points(axes: Axes, branches: Branches, j: int, palette: Palette) -> list[Entry]:
    scale = branches.axes[j].unit.scale
    entries = []
    for branch in branches.points:
        x, y = branch.values / branches.unit.scale, branch.points[:, j] / scale
        for begin, end, kind in _runs(branch.kinds):
            style: Look = {"color": palette.ink, "linestyle": POINT_DASHES[kind], "linewidth": 1.6}
            axes.plot(x[begin:end], y[begin:end], zorder=4, **style)
            entries.append(line_entry(GROUPS[kind], **style))
    return entries


def _cycles(axes: Axes, branches: Branches, j: int, palette: Palette) -> list[Entry]:
    scale = branches.axes[j].unit.scale
    entries = []
    for branch in branches.cycles:
        x = branch.values / branches.unit.scale
        low, high = branch.lows[:, j] / scale, branch.highs[:, j] / scale
        for begin, end, stability in _runs(branch.stabilities):
            style: Look = {
                "color": palette.cycle,
                "linestyle": CYCLE_DASHES[stability],
                "linewidth": 1.8,
            }
            part = slice(begin, end)
            if stability is Stability.STABLE:
                axes.fill_between(
                    x[part], low[part], high[part], color=palette.cycle, alpha=0.1, linewidth=0.0
                )
            for edge in (low, high):
                axes.plot(x[part], edge[part], zorder=3, **style)
            entries.append(line_entry(f"{stability} cycle, lowest and highest", **style))
    return entries


def _changes(axes: Axes, branches: Branches, j: int, palette: Palette) -> list[Entry]:
    """A mark where something changes, on a thin line through the panel."""
    scale = branches.axes[j].unit.scale
    entries = []
    for found in (*branches.bifurcations, *branches.retypings):
        x = found.value / branches.unit.scale
        axes.axvline(x, color=palette.faint, linewidth=0.6, linestyle=DOTS, zorder=1)
        style: Look = {
            "linestyle": "none",
            "marker": MARKS[found.change],
            "markersize": 8.0,
            "markerfacecolor": palette.paper,
            "markeredgecolor": palette.alarm,
            "markeredgewidth": 1.4,
        }
        if found.at.size:
            axes.plot(x, float(found.at[j]) / scale, zorder=6, clip_on=False, **style)
        entries.append(line_entry(str(found.change), **style))
    return entries


def _runs(types: Sequence[T]) -> list[tuple[int, int, T]]:
    """Stretches (begin, end, type); each ends on the first sample of the next one."""
    edges = [0, *(k for k in range(1, len(types)) if types[k] != types[k - 1]), len(types)]
    return [(a, min(b + 1, len(types)), types[a]) for a, b in pairwise(edges)]

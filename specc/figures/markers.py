"""Fixed points as textbooks mark them: filled is stable, open is unstable, half a saddle.

Circles are nodes, squares are foci, a dot within a circle is a center, a half-filled diamond a
saddle, a half-filled circle a degenerate point.
"""

from collections.abc import Sequence
from typing import Final, Literal, TypeAlias, TypedDict

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from runtime.arrays import Array
from specc.figures.legend import Entry, Look, line_entry
from specc.figures.palettes import Palette
from verifier.topology.features import PointKind

Fill: TypeAlias = Literal["full", "left", "none"]

SHAPES: Final[dict[PointKind, tuple[str, Fill, float]]] = {
    PointKind.STABLE_NODE: ("o", "full", 8.0),
    PointKind.UNSTABLE_NODE: ("o", "none", 8.0),
    PointKind.STABLE_FOCUS: ("s", "full", 7.2),
    PointKind.UNSTABLE_FOCUS: ("s", "none", 7.2),
    PointKind.SADDLE: ("D", "left", 7.4),
    PointKind.CENTER: ("o", "none", 8.5),
    PointKind.DEGENERATE: ("o", "left", 8.5),
}

DOT: Final = 2.6
"""The size of the dot in a center."""


class Marker(TypedDict):
    """What matplotlib is told of one."""

    marker: str
    fillstyle: Fill
    markersize: float
    markerfacecolor: str
    markerfacecoloralt: str
    markeredgecolor: str
    markeredgewidth: float


def marker(kind: PointKind, palette: Palette, weight: float = 1.0) -> Marker:
    """The mark of a kind of fixed point."""
    shape, fill, size = SHAPES[kind]
    return Marker(
        marker=shape,
        fillstyle="left" if fill == "left" else "full",
        markersize=weight * size,
        markerfacecolor=palette.paper if fill == "none" else palette.ink,
        markerfacecoloralt=palette.paper,
        markeredgecolor=palette.ink,
        markeredgewidth=1.3 * weight,
    )


def mark(
    axes: Axes, at: Array, kinds: Sequence[PointKind], palette: Palette, weight: float = 1.0
) -> list[Entry]:
    """Marks the points `at` (k, 2), above everything else, and returns what the legend shows."""
    for point, kind in zip(at, kinds, strict=True):
        look = marker(kind, palette, weight)
        axes.plot(*point, linestyle="none", clip_on=False, zorder=10, **look)
        if kind is PointKind.CENTER:
            dot = weight * DOT
            axes.plot(*point, "o", color=palette.ink, markersize=dot, clip_on=False, zorder=11)
    return [_entry(kind, palette) for kind in PointKind if kind in kinds]


def ring(axes: Axes, at: Array, palette: Palette, weight: float = 1.0) -> list[Entry]:
    """Rings around the points `at` (k, 2): the interpolation invented them."""
    look: Look = {
        "linestyle": "none",
        "marker": "o",
        "markersize": 14.0 * weight,
        "markerfacecolor": "none",
        "markeredgecolor": palette.alarm,
        "markeredgewidth": 1.4 * weight,
    }
    if not len(at):
        return []
    axes.plot(*at.T, clip_on=False, zorder=9, **look)
    return [line_entry("invented by the tables", **look | {"markersize": 11.0})]


def cross(axes: Axes, at: Array, palette: Palette, weight: float = 1.0) -> list[Entry]:
    """Crosses at the places `at` (k, 2): fixed points of the formula that the tables lost."""
    look: Look = {
        "linestyle": "none",
        "marker": "X",
        "markersize": 8.5 * weight,
        "markerfacecolor": palette.paper,
        "markeredgecolor": palette.alarm,
        "markeredgewidth": 1.3 * weight,
    }
    if not len(at):
        return []
    axes.plot(*at.T, clip_on=False, zorder=9, **look)
    return [line_entry("of the formula, lost by the tables", **look)]


def rest(axes: Axes, at: Array, palette: Palette, weight: float = 1.0) -> list[Entry]:
    """Stars at the places `at` (k, 2) that trajectories come to that switch without end."""
    look: Look = {
        "linestyle": "none",
        "marker": "*",
        "markersize": 12.0 * weight,
        "markerfacecolor": palette.ink,
        "markeredgecolor": palette.paper,
        "markeredgewidth": 0.8 * weight,
    }
    if not len(at):
        return []
    axes.plot(*at.T, clip_on=False, zorder=10, **look)
    return [line_entry("rest: switches without end", **look)]


def _entry(kind: PointKind, palette: Palette) -> Entry:
    first = Line2D([], [], linestyle="none", **marker(kind, palette))
    dot = Line2D([], [], linestyle="none", marker="o", color=palette.ink, markersize=DOT)
    return Entry(str(kind), (first, dot) if kind is PointKind.CENTER else (first,))

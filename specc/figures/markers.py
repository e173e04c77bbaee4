"""Fixed points as textbooks mark them: filled is stable, open is unstable, half a saddle.

Circles are nodes, squares are foci, a dot within a circle is a center, a half-filled diamond a
saddle, a half-filled circle a degenerate point.
"""

from collections.abc import Sequence
from typing import Final, Literal, TypeAlias, TypedDict

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from runtime.arrays import Array
from specc.figures.style import INK, PAPER
from verifier.topology.features import PointKind

Fill: TypeAlias = Literal["full", "left", "none"]

Entry: TypeAlias = tuple[Line2D, ...]
"""What stands for one thing in a legend: lines drawn upon each other; the first has the label."""

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


def _marker(shape: str, fill: Fill, size: float) -> Marker:
    return Marker(
        marker=shape,
        fillstyle="left" if fill == "left" else "full",
        markersize=size,
        markerfacecolor=PAPER if fill == "none" else INK,
        markerfacecoloralt=PAPER,
        markeredgecolor=INK,
        markeredgewidth=1.3,
    )


MARKERS: Final[dict[PointKind, Marker]] = {
    PointKind.STABLE_NODE: _marker("o", "full", 8.0),
    PointKind.UNSTABLE_NODE: _marker("o", "none", 8.0),
    PointKind.STABLE_FOCUS: _marker("s", "full", 7.2),
    PointKind.UNSTABLE_FOCUS: _marker("s", "none", 7.2),
    PointKind.SADDLE: _marker("D", "left", 7.4),
    PointKind.CENTER: _marker("o", "none", 8.5),
    PointKind.DEGENERATE: _marker("o", "left", 8.5),
}


def mark(axes: Axes, at: Array, kinds: Sequence[PointKind]) -> list[Entry]:
    """Marks the points `at` (k, 2), above everything else, and returns what the legend shows."""
    for point, kind in zip(at, kinds, strict=True):
        axes.plot(*point, linestyle="none", clip_on=False, zorder=10, **MARKERS[kind])
        if kind is PointKind.CENTER:
            axes.plot(*point, "o", color=INK, markersize=DOT, clip_on=False, zorder=11)
    return [_entry(kind) for kind in PointKind if kind in kinds]


def _entry(kind: PointKind) -> Entry:
    marker = Line2D([], [], linestyle="none", label=str(kind), **MARKERS[kind])
    dot = Line2D([], [], linestyle="none", marker="o", color=INK, markersize=DOT)
    return (marker, dot) if kind is PointKind.CENTER else (marker,)

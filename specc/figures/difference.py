"""Where two behaviors differ: a map of the largest difference, and the features of both."""

from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from runtime.arrays import Array
from specc.figures.axes_of_states import name_x, name_y, same_scale, shown, split_at_seams
from specc.figures.legend import Entry, Look, draw_legend, line_entry
from specc.figures.markers import SHAPES
from specc.figures.palettes import PALETTES, Palette
from specc.figures.paper import (
    BELOW,
    LEFT,
    LEGEND,
    LINE,
    axes_at,
    heading,
    new_figure,
    panel_size,
    write_heading,
)
from specc.figures.style import look
from specc.figures.style_names import Style
from specc.texts.comparison import taken_lines, verdict_text
from verifier.topology.comparing.comparison import Comparison
from verifier.topology.comparing.matching import Fate
from verifier.topology.features import PointKind

MOST: Final = (4.7, 4.3)
"""The size of the panel in inches, at most."""

FLAT: Final = (4.7, 2.9)
"""The same of a curve over one axis."""

PIXELS: Final = 640
"""Of the map along each axis: so fine that borders between colours show no stairs."""

LEVELS: Final = (0.25, 0.5, 1.0, 2.0, 4.0)
"""Between the colours, in units of what is allowed."""

ROWS: Final = 0.06
"""Between features of one axis that would hide each other, as a share of the panel's height."""

WORDS: Final = (
    "less than a quarter of what is allowed",
    "less than half of it",
    "within tolerance",
    "up to twice what is allowed",
    "up to four times as much",
    "more",
)

COLOURS: Final = ("#ffffff", "#e8f0f8", "#c9dcef", "#fbd9a6", "#f0a35e", "#c9552d")
"""Blue where it is allowed, orange where it is not; darker is more."""


def draw_difference(comparison: Comparison) -> Figure:
    """The map over two axes, of three the worst along the third; over one axis a curve."""
    palette = PALETTES[Style.SCREEN]
    is_curve = len(comparison.axes) == 1
    shown_axes = comparison.axes[:2]
    keep = not is_curve and same_scale(shown_axes)
    most = FLAT if is_curve else MOST
    size = panel_size((*shown_axes, *shown_axes)[:2], most, same_scale=keep)
    title = f"{comparison.found} held against {comparison.wanted}"
    names = [one.name for one in comparison.taken]
    above = [verdict_text(comparison), *taken_lines(comparison)]
    along = [f"The largest difference along {axis.name}" for axis in comparison.axes[2:]]
    text = heading(title, above, along, size[0] + LEGEND, names)
    below = BELOW + LINE * (1 + len(text.below))
    with look(palette):
        figure = new_figure(LEFT + size[0] + LEGEND, below + size[1] + text.height + 0.1, palette)
        axes = axes_at(figure, (LEFT, below), size)
        entries = (_curve if is_curve else _map)(axes, comparison, palette)
        draw_legend(axes, entries, (1.0 + 0.18 / size[0], 1.0))
        top = below + size[1] + text.height
        write_heading(figure, text, palette, LEFT, top, below - BELOW + 0.05)
    return figure


def _map(axes: Axes, comparison: Comparison, palette: Palette) -> list[Entry]:
    x, y = comparison.axes[:2]
    name_x(axes, x)
    name_y(axes, y)
    worst = comparison.worst.reshape(*comparison.worst.shape[:2], -1).max(axis=-1)
    level = np.digitize(_finer(worst), LEVELS, right=True)
    extent = tuple(value / a.unit.scale for a in (x, y) for value in (a.low, a.high))
    axes.imshow(
        level.T,
        cmap=ListedColormap(COLOURS),
        vmin=-0.5,
        vmax=len(COLOURS) - 0.5,
        origin="lower",
        extent=(extent[0], extent[1], extent[2], extent[3]),
        aspect="auto",
        interpolation="nearest",
        zorder=0,
    )
    present = np.unique(level)
    entries = [
        Entry(WORDS[k], (Patch(facecolor=COLOURS[k], edgecolor=palette.faint, linewidth=0.5),))
        for k in present
    ]
    return [*_features(axes, comparison, palette), *entries]


def _finer(worst: Array) -> Array:
    """The differences at the middles of finer cells, linear between nodes; huge ones cut off."""
    kept = np.minimum(worst, 4.0 * LEVELS[-1])
    for axis in (0, 1):
        count = kept.shape[axis]
        places = (np.arange(PIXELS) + 0.5) / PIXELS * (count - 1)
        low = np.minimum(places.astype(np.int64), count - 2)
        share = np.expand_dims(places - low, 1 - axis)
        kept = np.take(kept, low, axis) * (1.0 - share) + np.take(kept, low + 1, axis) * share
    return kept


def _features(axes: Axes, comparison: Comparison, palette: Palette) -> list[Entry]:
    """Fixed points and cycles: found ones filled and solid, wanted ones open and dashed."""
    entries: list[Entry] = []
    for feature in comparison.features:
        found, wanted = feature.points
        color = palette.ink if feature.fate is Fate.SAME else palette.alarm
        sides = (
            (wanted, feature.wanted, "--", palette.paper),
            (found, feature.found, "-", color),
        )
        for points, kind, dashes, ground in sides:
            style = {"color": color, "linestyle": dashes, "markerfacecolor": ground}
            _path(axes, comparison, points, **style, marker=_shape(kind))
        label = f"{feature.wanted or feature.found}: {feature.fate}"
        if max(len(found), len(wanted)) > 1:
            entries.append(line_entry(label, color=color))
        else:
            shape = _shape(feature.wanted or feature.found)
            entries.append(line_entry(label, color=color, marker=shape, linestyle="none"))
    hint = line_entry("dashed or open: wanted", color=palette.ink, linestyle="--")
    return [*entries, hint] if entries else []


def _shape(kind: str) -> str:
    """The marker of a kind of fixed point: as in portraits, circles, squares and diamonds."""
    return SHAPES[PointKind(kind)][0] if kind in list(PointKind) else "o"


def _path(axes: Axes, comparison: Comparison, points: Array, **style: Any) -> None:
    if len(points) == 1:
        at = shown(comparison.axes, points[0])[:2]
        axes.plot(*at, **{**style, "linestyle": "none"}, clip_on=False, zorder=10)
    for piece in split_at_seams(comparison.axes, points) if len(points) > 1 else ():
        line = {**style, "marker": "none"}
        axes.plot(*shown(comparison.axes, piece)[:, :2].T, **line, linewidth=1.6, zorder=9)


def _curve(axes: Axes, comparison: Comparison, palette: Palette) -> list[Entry]:
    (x,) = comparison.axes[:1]
    name_x(axes, x)
    axes.set_ylabel("difference / allowed")
    axes.plot(comparison.nodes[0] / x.unit.scale, comparison.worst, color=palette.cycle)
    axes.axhline(1.0, color=palette.faint, linestyle="--")
    axes.set_xlim(x.low / x.unit.scale, x.high / x.unit.scale)
    axes.set_ylim(bottom=0.0, top=max(1.15, float(axes.get_ylim()[1])))
    return [
        *_features_below(axes, comparison, palette),
        line_entry("difference", color=palette.cycle),
        line_entry("allowed", color=palette.faint, linestyle="--"),
    ]


def _features_below(axes: Axes, comparison: Comparison, palette: Palette) -> list[Entry]:
    """Of one axis: what is found on the line of zero, filled; what is wanted just above, open.

    Points are marks; cycles, which go there and back, bars from end to end.
    """
    (x,) = comparison.axes
    entries: list[Entry] = []
    for k, feature in enumerate(comparison.features):
        color = palette.ink if feature.fate is Fate.SAME else palette.alarm
        kinds = (feature.found, feature.wanted)
        for row, (points, kind) in enumerate(zip(feature.points, kinds, strict=True)):
            if not len(points):
                continue
            values = points[:, 0] / x.unit.scale
            look: Look = {
                "color": color,
                "marker": _shape(kind) if len(points) == 1 else "|",
                "markerfacecolor": palette.paper if row else color,
                "markersize": 7.5 if len(points) == 1 else 9.0,
                "linestyle": "--" if row else "-",
                "linewidth": 1.6,
            }
            place = axes.get_xaxis_transform()
            ends = np.unique([values.min(), values.max()])
            up = ROWS * ((2 * k + 1) * (len(points) > 1) + row)
            axes.plot(
                ends, np.full(len(ends), up), transform=place, clip_on=False, zorder=9, **look
            )
        label = f"{feature.wanted or feature.found}: {feature.fate}"
        is_point = max(map(len, feature.points)) == 1
        shape = {"marker": _shape(feature.wanted or feature.found), "linestyle": "none"}
        entries.append(line_entry(label, color=color, **(shape if is_point else {})))
    hint = line_entry("dashed or open: wanted", color=palette.ink, linestyle="--")
    return [*entries, hint] if entries else []

"""Coverage: which cells of the declared region the judged windows went through."""

from collections.abc import Iterable, Sequence
from itertools import combinations
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from runtime.arrays import Array
from specc.figures.quantities import axis_label
from specc.figures.style import FAINT, SKY, bare, framed, look
from verifier.report.report import CellAxis, Coverage

SHARE: Final = LinearSegmentedColormap.from_list("share", ["#eef2f6", SKY])
MOST_PAIRS: Final = 3
WRITTEN: Final = 120
"""In at most so many cells the number of samples is written."""


def draw_coverage(coverage: Coverage) -> Figure:
    """One row of cells, a plane of cells, or the planes of the first pairs of several axes."""
    planes = _planes(coverage)
    with look():
        figure = Figure(figsize=(7.2, 1.5 if len(coverage.axes) == 1 else 3.2))
        left = left_of(value for axis in coverage.axes for value in axis.values)
        grid = framed(figure, 1, len(planes), (left, 0.1, 0.5, 0.4))
        grid.update(wspace=0.45)
        for column, (i, j) in enumerate(planes):
            _plane(figure.add_subplot(grid[column]), coverage, i, j)
        if len(coverage.axes) <= 2:
            figure.legend(handles=_legend(coverage.enough), loc="upper left", ncols=2)
    return figure


def left_of(labels: Iterable[str]) -> float:
    """The margin in inches at the left, where such labels may stand beside an axis."""
    return max(0.9, min(2.4, 0.5 + 0.07 * max(map(len, labels), default=0)))


def named_ticks(axis: Axis, places: Array, names: Sequence[str]) -> None:
    """The names of a discrete variable's values at their places (k,); without names, numbers."""
    if names:
        axis.set_ticks(list(places), labels=list(names))


def _planes(coverage: Coverage) -> list[tuple[int, int]]:
    """Pairs of axes; a lone axis is paired with itself."""
    count = len(coverage.axes)
    return [(0, 0)] if count == 1 else list(combinations(range(count), 2))[:MOST_PAIRS]


def _plane(axes: Axes, coverage: Coverage, i: int, j: int) -> None:
    share = _seen_share(coverage, i, j)
    x = _edges(coverage.axes[i])
    y = np.array([0.0, 1.0]) if i == j else _edges(coverage.axes[j])
    axes.pcolormesh(
        x, y, share.T, cmap=SHARE, norm=Normalize(0.0, 1.0), edgecolors=FAINT, linewidth=0.4
    )
    bare(axes)
    axes.set_xlabel(axis_label(coverage.axes[i].name, coverage.axes[i].unit))
    _name(axes.xaxis, coverage.axes[i])
    if i == j:
        axes.set_yticks([])
    else:
        axes.set_ylabel(axis_label(coverage.axes[j].name, coverage.axes[j].unit))
        _name(axes.yaxis, coverage.axes[j])
    if len(coverage.axes) <= 2 and share.size <= WRITTEN:
        _write(axes, coverage, x, y)


def _name(axis: Axis, shown: CellAxis) -> None:
    centres = np.linspace(shown.low, shown.high, 2 * shown.count + 1)[1::2] / shown.unit.scale
    named_ticks(axis, centres, shown.values)


def _seen_share(coverage: Coverage, i: int, j: int) -> Array:
    """The share of seen cells (count i, count j), over the axes that the plane does not show."""
    seen = (coverage.samples >= coverage.enough).astype(np.float64)
    others = tuple(k for k in range(seen.ndim) if k not in {i, j})
    plane = seen.mean(axis=others) if others else seen
    return np.asarray(plane[:, None] if i == j else plane)


def _write(axes: Axes, coverage: Coverage, x: Array, y: Array) -> None:
    counts = coverage.samples.reshape(len(x) - 1, len(y) - 1)
    for (column, row), count in np.ndenumerate(counts):
        axes.text(
            0.5 * (x[column] + x[column + 1]),
            0.5 * (y[row] + y[row + 1]),
            str(count),
            ha="center",
            va="center",
            fontsize=7.0,
            # Dark on the cells' own light colours, whatever the page around them looks like.
            color="#1f2933" if count else "#8a94a0",
        )


def _edges(axis: CellAxis) -> Array:
    return np.linspace(axis.low, axis.high, axis.count + 1) / axis.unit.scale


def _legend(enough: int) -> list[Patch]:
    return [
        Patch(facecolor=SHARE(1.0), edgecolor=FAINT, label=f"seen: {enough} or more samples"),
        Patch(facecolor=SHARE(0.0), edgecolor=FAINT, label="too few"),
    ]

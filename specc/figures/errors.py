"""Errors at the horizon: over time, as a histogram, and over the places where they arose."""

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure

from runtime.arrays import Array
from runtime.program import Unit
from specc.figures.coverage import left_of, named_ticks
from specc.figures.quantities import axis_label
from specc.figures.style import BLUE, FAINT, GREEN, INK, VERMILION, bare, framed, look
from verifier.report.report import Report, VariableResult

SIGNED: Final = LinearSegmentedColormap.from_list("signed", [BLUE, "#dfe3e8", VERMILION])
ROUNDING: Final = 1e-9
"""What moved by less, as a share of its size, stood still."""
MANY: Final = 1500
"""More points than these are stored as an image within the drawing."""


def draw_errors(report: Report, variable: VariableResult) -> Figure:
    """Measured minus predicted at the horizon: over the trace, and how often."""
    scale = variable.unit.scale
    errors = variable.errors / scale
    known = np.isfinite(errors)
    with look():
        figure = Figure(figsize=(7.2, 2.7))
        grid = framed(figure, 1, 4, (0.9, 0.1, 0.5, 0.12))
        over_time = figure.add_subplot(grid[:3])
        counts = figure.add_subplot(grid[3], sharey=over_time)
        counts.tick_params(labelleft=False)
        for axes in (over_time, counts):
            _tolerance_band(axes, variable.tolerance / scale)
            bare(axes)
        over_time.plot(
            report.starts[known],
            errors[known],
            "o",
            color=INK,
            markersize=3.0 if known.sum() < 300 else 1.6,
            markeredgewidth=0.0,
            alpha=0.7,
            rasterized=bool(known.sum() > MANY),
        )
        over_time.set_xlabel("start of the window [s]")
        over_time.set_ylabel(axis_label(f"error of {variable.name}", variable.unit))
        counts.hist(
            errors[known],
            bins=_bins(errors[known]),
            orientation="horizontal",
            color=FAINT,
            alpha=0.6,
        )
        _mean(counts, variable)
        counts.set_xlabel("windows")
    return figure


def draw_error_map(report: Report, variable: VariableResult) -> Figure:
    """The same errors where they arose: over one or two variables, in tolerances."""
    names = places_shown(report)
    size = variable.errors / variable.tolerance
    known = np.isfinite(size)
    with look():
        figure = Figure(figsize=(7.2, 3.1))
        left = left_of(value for name in names for value in _values(report, name))
        axes = figure.add_subplot(framed(figure, 1, 1, (left, 0.1, 0.5, 0.12))[0])
        bare(axes)
        x = _in_unit(report, names[0])
        axes.set_xlabel(axis_label(names[0], _unit(report, names[0])))
        if len(names) == 1:
            _tolerance_band(axes, 1.0)
            axes.plot(x[known], size[known], "o", color=INK, markersize=3.0, markeredgewidth=0.0)
            axes.set_ylabel(f"error of {variable.name} / tolerance")
        else:
            y = _in_unit(report, names[1])
            _colored(figure, axes, np.stack([x, y])[:, known], size[known], variable.name)
            axes.set_ylabel(axis_label(names[1], _unit(report, names[1])))
            _name(axes.yaxis, report, names[1])
        _name(axes.xaxis, report, names[0])
    return figure


def _name(axis: Axis, report: Report, name: str) -> None:
    values = _values(report, name)
    named_ticks(axis, np.arange(float(len(values))), values)


def _values(report: Report, name: str) -> tuple[str, ...]:
    """Of a discrete variable, its values; else none."""
    shown = () if report.coverage is None else report.coverage.axes
    return next((each.values for each in shown if each.name == name), ())


def places_shown(report: Report) -> tuple[str, ...]:
    """The one or two variables over which errors are shown: the coverage's first; what moved."""
    first = [] if report.coverage is None else [axis.name for axis in report.coverage.axes]
    known = [name for name in dict.fromkeys([*first, *report.places]) if name in report.places]
    moving = [name for name in known if _values(report, name) or _moved(report.places[name])]
    return tuple(moving[:2] or known[:1])


def _moved(values: Array) -> bool:
    """Whether a variable took several values, but for what rounding makes of one."""
    return bool(values.size) and bool(np.ptp(values) > ROUNDING * np.max(np.abs(values)))


def _colored(figure: Figure, axes: Axes, at: Array, size: Array, name: str) -> None:
    norm = Normalize(-1.5, 1.5, clip=True)
    order = np.argsort(np.abs(size))
    axes.scatter(
        at[0, order],
        at[1, order],
        c=SIGNED(norm(size[order])),
        s=26.0 if size.size < 300 else 10.0,
        edgecolors=[INK if abs(value) > 1.0 else "none" for value in size[order]],
        linewidths=0.9,
        rasterized=bool(size.size > MANY),
    )
    bar = figure.colorbar(ScalarMappable(norm, SIGNED), ax=axes, extend="both", aspect=14, pad=0.03)
    bar.set_label(f"error of {name} / tolerance")
    bar.outline.set_visible(False)
    bar.set_ticks([-1.0, 0.0, 1.0], labels=["−1", "0", "1"])


def _tolerance_band(axes: Axes, tolerance: float) -> None:
    axes.axhspan(-tolerance, tolerance, color=GREEN, alpha=0.12, linewidth=0.0)
    for side in (-tolerance, tolerance):
        axes.axhline(side, color=GREEN, linewidth=1.0, linestyle=(0, (4, 2)))
    axes.axhline(0.0, color=FAINT, linewidth=0.7)


def _mean(axes: Axes, variable: VariableResult) -> None:
    """The mean error with its confidence interval, beside the ends of the histogram's bars."""
    low, mean, high = (
        value / variable.unit.scale
        for value in (variable.mean_interval.low, variable.mean, variable.mean_interval.high)
    )
    if np.all(np.isfinite((low, mean, high))):
        place = 0.9 * axes.get_xlim()[1]
        axes.plot([place, place], [low, high], "_-", color=VERMILION, markersize=8.0)
        axes.plot(place, mean, "o", color=VERMILION, markersize=4.0)


def _bins(errors: Array) -> int:
    return int(np.clip(np.sqrt(errors.size), 5, 40))


def _unit(report: Report, name: str) -> Unit:
    return report.units.get(name, Unit("1", 1.0))


def _in_unit(report: Report, name: str) -> Array:
    return report.places[name] / _unit(report, name).scale

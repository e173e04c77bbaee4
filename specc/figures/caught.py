"""The self-test: which planted faults were caught, and which were too small to be."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from specc.figures.quantities import quantity
from specc.figures.style import BLUE, FAINT, GREEN, INK, VERMILION, bare, framed, look
from verifier.report.limits import Caught, Limits
from verifier.report.report import Verdict

LOOKS = {
    Verdict.FAIL: ("X", VERMILION, "caught"),
    Verdict.INCONCLUSIVE: ("D", BLUE, "inconclusive"),
    Verdict.PASS: ("o", GREEN, "passed unseen"),
}


def draw_caught(limits: Limits) -> Figure:
    """A row per fault; its sizes as shares of the largest that was tried, on a log scale."""
    rows = [each for each in limits.caught if each.trials]
    with look():
        figure = Figure(figsize=(7.2, 1.05 + 0.34 * max(1, len(rows))))
        labels = [f"{each.fault} of {each.variable}" for each in rows]
        left = 0.3 + min(2.6, 0.078 * max((len(label) for label in labels), default=0))
        axes = figure.add_subplot(framed(figure, 1, 1, (left, 1.25, 0.5, 0.4))[0])
        bare(axes)
        axes.spines["left"].set_visible(False)
        axes.tick_params(axis="y", length=0)
        axes.set_xscale("log")
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.xaxis.set_minor_formatter(NullFormatter())
        for row, each in enumerate(rows):
            _row(axes, row, each)
        axes.set_yticks(range(len(rows)), labels)
        axes.set_ylim(len(rows) - 0.5, -0.5)
        axes.set_xlabel("size, as a share of the largest that was tried")
        figure.legend(handles=_legend(rows), loc="upper left", ncols=3)
    return figure


def _row(axes: Axes, row: int, caught: Caught) -> None:
    sizes = np.abs([trial.size for trial in caught.trials])
    largest = float(np.max(sizes)) or 1.0
    axes.axhline(row, color=FAINT, linewidth=0.4, zorder=1)
    for size, trial in zip(sizes, caught.trials, strict=True):
        marker, color, _ = LOOKS[trial.verdict]
        up = -0.14 if trial.size > 0.0 else 0.14
        axes.plot(size / largest, row + up, marker, color=color, markersize=5.5, clip_on=False)
    text = "not caught" if not caught.is_caught else f"≥ {quantity(caught.smallest, caught.unit)}"
    axes.annotate(
        text,
        (1.0, row),
        xycoords=("axes fraction", "data"),
        xytext=(8, 0),
        textcoords="offset points",
        va="center",
        fontsize=8.0,
        color=INK,
    )


def _legend(rows: list[Caught]) -> list[Line2D]:
    seen = {trial.verdict for each in rows for trial in each.trials}
    return [
        Line2D([], [], linestyle="none", marker=marker, color=color, markersize=6.0, label=label)
        for verdict, (marker, color, label) in LOOKS.items()
        if verdict in seen
    ]

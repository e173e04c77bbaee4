"""What would explain a departure: how much of the held-out error each candidate takes away."""

from typing import Final

from matplotlib.figure import Figure

from specc.figures.style import BLUE, FAINT, INK, bare, framed, look
from verifier.report.diagnosis import Diagnosis
from verifier.report.why import ranked

MOST: Final = 10


def draw_candidates(diagnosis: Diagnosis) -> Figure:
    """A bar per candidate: first those that the diagnosis names, full; then the others, pale."""
    shown = ranked(diagnosis)[:MOST]
    with look():
        figure = Figure(figsize=(7.2, 0.6 + 0.27 * len(shown)))
        left = 0.3 + min(3.0, 0.075 * max(len(each.label) for each in shown))
        axes = figure.add_subplot(framed(figure, 1, 1, (left, 0.45, 0.5, 0.1))[0])
        bare(axes)
        axes.spines["left"].set_visible(False)
        axes.tick_params(axis="y", length=0)
        for row, each in enumerate(shown):
            share = min(max(each.evidence.share, 0.0), 1.0)
            color, alpha = (BLUE, 1.0) if each.is_taken else (FAINT, 0.45)
            axes.barh(row, 100.0 * share, height=0.62, color=color, alpha=alpha, linewidth=0.0)
            text = f"{100.0 * share:.0f} %"
            axes.text(100.0 * share + 1.0, row, text, va="center", fontsize=8.0, color=INK)
        axes.set_yticks(range(len(shown)), [each.label for each in shown])
        axes.set_ylim(len(shown) - 0.4, -0.6)
        axes.set_xlim(0.0, 100.0)
        axes.set_xlabel("explained of the held-out error [%]")
    return figure

"""Features of the field: where the spec has them, and where the robot has them."""

from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from runtime.arrays import Array
from specc.figures.quantities import axis_label
from specc.figures.style import BLUE, VERMILION, bare, framed, look
from verifier.report.features import ComparedFeature, FeatureNumber, Features, FeatureStanding

MARKERS: Final = {"saddle": "X"}
SPEC: Final[dict[str, Any]] = {"color": BLUE, "linestyle": (0, (4, 1.5)), "linewidth": 1.6}
ROBOT: Final[dict[str, Any]] = {"color": VERMILION, "linewidth": 1.8, "alpha": 0.9}
ROOM: Final = 12.0
"""An axis shows at least so many tolerances, so that a hair's breadth does not look like a leap."""
HAIR: Final = 1e-6
"""What is thinner, as a share of its place, is no extent but rounding."""
WORDS: Final = {
    FeatureStanding.EXCEEDED: "differs",
    FeatureStanding.UNDECIDED: "open",
    FeatureStanding.NOT_VISITED: "not visited",
}


def draw_features(features: Features) -> Figure:
    """The first two axes: cycles as loops, points as marks with what the spec allows of them."""
    with look():
        figure = Figure(figsize=(7.2, 4.2))
        axes = figure.add_subplot(framed(figure, 1, 1, (0.9, 0.2, 0.5, 0.4))[0])
        bare(axes)
        scale = np.array([unit.scale for unit in features.units[:2]])
        for feature in features.features:
            if feature.is_cycle:
                _loop(axes, feature, scale)
            else:
                _point(axes, feature, scale)
        axes.margins(0.12)
        _widened(axes, features, scale)
        axes.set_xlabel(axis_label(features.axes[0], features.units[0]))
        axes.set_ylabel(axis_label(features.axes[1], features.units[1]))
        figure.legend(handles=_legend(), loc="upper left", ncols=3, borderaxespad=0.2)
    return figure


def _loop(axes: Axes, feature: ComparedFeature, scale: Array) -> None:
    for path, style in ((feature.spec_path, SPEC), (feature.robot_path, ROBOT)):
        if len(path):
            at = path[:, :2] / scale
            axes.plot(at[:, 0], at[:, 1], **style)
    if feature.standing in WORDS and len(feature.spec_path):
        high = feature.spec_path[np.argmax(feature.spec_path[:, 1]), :2] / scale
        _word(axes, feature, high)


def _point(axes: Axes, feature: ComparedFeature, scale: Array) -> None:
    marker = MARKERS.get(feature.kind, "o")
    if len(feature.spec_path):
        at = feature.spec_path[0, :2] / scale
        allowed = np.array([number.tolerance for number in feature.numbers[:2]]) / scale
        if np.all(np.isfinite(allowed)):
            box = Rectangle(tuple(at - allowed), *(2.0 * allowed), color=BLUE, alpha=0.15, lw=0)
            axes.add_patch(box)
        axes.plot(*at, marker, ms=11.0, mfc="none", mec=BLUE, mew=1.6)
        if feature.standing in WORDS:
            _word(axes, feature, at)
    if len(feature.robot_path):
        at = feature.robot_path[0, :2] / scale
        half = np.array([_half(number) for number in feature.numbers[:2]]) / scale
        axes.errorbar(
            at[0], at[1], xerr=half[0], yerr=half[1], fmt=marker, ms=6.5, color=VERMILION, lw=1.4
        )


def _half(number: FeatureNumber) -> float:
    """Half its interval, 0 where it has none that could be drawn."""
    if number.robot is None:
        return 0.0
    half = 0.5 * (number.robot.interval.high - number.robot.interval.low)
    return half if np.isfinite(half) else 0.0


def _word(axes: Axes, feature: ComparedFeature, at: Array) -> None:
    color = VERMILION if feature.standing is FeatureStanding.EXCEEDED else "0.4"
    axes.annotate(
        WORDS[feature.standing],
        (float(at[0]), float(at[1])),
        xytext=(0.0, 11.0),
        textcoords="offset points",
        ha="center",
        color=color,
    )


def _widened(axes: Axes, features: Features, scale: Array) -> None:
    """Each axis at least `ROOM` tolerances of its points wide, and none as thin as rounding."""
    allowed = [
        [number.tolerance for number in feature.numbers[:2]]
        for feature in features.features
        if not feature.is_cycle and len(feature.numbers) >= 2
    ]
    most = np.array(allowed).reshape(-1, 2)
    most = np.max(np.where(np.isfinite(most), most, 0.0), axis=0, initial=0.0) / scale
    for (low, high), wide, put in (
        (axes.get_xlim(), ROOM * most[0], axes.set_xlim),
        (axes.get_ylim(), ROOM * most[1], axes.set_ylim),
    ):
        largest = max(abs(low), abs(high))
        is_flat = not wide and high - low < HAIR * largest
        more = max(0.0, 0.5 * ((largest if is_flat else wide) - (high - low)))
        put(low - more, high + more)


def _legend() -> list[Any]:
    return [
        Line2D([], [], label="spec", marker="o", markerfacecolor="none", **SPEC),
        Line2D([], [], label="robot, with its interval", marker="o", **ROBOT),
        Patch(label="allowed", color=BLUE, alpha=0.15),
    ]

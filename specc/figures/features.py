"""Features of the field: where the spec has them, and where the robot has them."""

from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from runtime.arrays import Array
from specc.figures.quantities import axis_label
from specc.figures.style import BLUE, VERMILION, bare, framed, look
from verifier.report.features import ComparedFeature, Features

MARKERS: Final = {"saddle": "X"}
SPEC: Final[dict[str, Any]] = {"color": BLUE, "linestyle": (0, (4, 1.5)), "linewidth": 1.6}
ROBOT: Final[dict[str, Any]] = {"color": VERMILION, "linewidth": 1.8, "alpha": 0.9}


def draw_features(features: Features) -> Figure:
    """The first two axes: cycles as loops, points as marks."""
    with look():
        figure = Figure(figsize=(7.2, 4.2))
        axes = figure.add_subplot(framed(figure, 1, 1, (0.9, 0.2, 0.5, 0.4))[0])
        bare(axes)
        scale = np.array([unit.scale for unit in features.units[:2]])
        for feature in features.features:
            _feature(axes, feature, scale)
        axes.margins(0.12)
        axes.set_xlabel(axis_label(features.axes[0], features.units[0]))
        axes.set_ylabel(axis_label(features.axes[1], features.units[1]))
        figure.legend(handles=_legend(), loc="upper left", ncols=2, borderaxespad=0.2)
    return figure


def _feature(axes: Axes, feature: ComparedFeature, scale: Array) -> None:
    marker = MARKERS.get(feature.kind, "o")
    for path, style, face in (
        (feature.spec_path, SPEC, "none"),
        (feature.robot_path, ROBOT, VERMILION),
    ):
        if not len(path):
            continue
        at = path[:, :2] / scale
        if feature.is_cycle:
            axes.plot(at[:, 0], at[:, 1], **style)
        else:
            axes.plot(
                at[0, 0],
                at[0, 1],
                marker,
                markersize=11.0 if face == "none" else 6.5,
                markerfacecolor=face,
                markeredgecolor=style["color"],
                markeredgewidth=1.6,
            )


def _legend() -> list[Line2D]:
    return [
        Line2D([], [], label="spec", marker="o", markerfacecolor="none", **SPEC),
        Line2D([], [], label="robot", marker="o", **ROBOT),
    ]

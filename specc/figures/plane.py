"""The portrait of a plane: streamlines, nullclines, trajectories and fixed points.

Of a map: the step from every place as an arrow, and orbits as dots.
"""

from typing import Final, Literal, TypedDict

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import FancyArrowPatch

from runtime.arrays import Array
from specc.figures.axes_of_states import name_x, name_y, same_scale, shown, split_at_seams
from specc.figures.markers import Entry, mark
from specc.figures.quantities import rate_of
from specc.figures.style import BLUE, GREEN, INK, PURPLE, VERMILION
from verifier.topology.features import Course, Nullcline, Portrait, Trajectory

SPEED: Final = LinearSegmentedColormap.from_list("speed", ["#c9d2dd", "#7d8ea5"])


class Stroke(TypedDict):
    """How a line is drawn."""

    color: str
    linestyle: tuple[float, tuple[float, ...]] | Literal["-"]
    linewidth: float


NULLCLINES: Final = (
    Stroke(color=BLUE, linestyle="-", linewidth=1.5),
    Stroke(color=VERMILION, linestyle=(0.0, (5.0, 2.0)), linewidth=1.5),
)
COURSES: Final = {
    Course.SEED: Stroke(color=INK, linestyle="-", linewidth=1.0),
    Course.STABLE_MANIFOLD: Stroke(color=GREEN, linestyle="-", linewidth=1.7),
    Course.UNSTABLE_MANIFOLD: Stroke(
        color=PURPLE, linestyle=(0.0, (6.0, 1.5, 1.0, 1.5)), linewidth=1.5
    ),
}
ARROWS: Final = 24
"""How many arrows along each axis show the steps of a map."""


def draw_plane(figure: Figure, portrait: Portrait) -> tuple[Axes, list[Entry]]:
    """Draws into `figure`; gives its axes and what the legend shows."""
    axes = figure.add_axes((0.1, 0.1, 0.62, 0.78))
    x, y = portrait.axes
    name_x(axes, x)
    name_y(axes, y)
    if same_scale(portrait.axes):
        axes.set_aspect("equal", adjustable="box", anchor="NW")
    is_map = portrait.every > 0.0
    background = _steps(axes, portrait) if is_map else _streamlines(axes, portrait)
    nullclines = [
        _nullcline(axes, portrait, n, is_map=is_map) for n in portrait.nullclines if n.lines
    ]
    paths = _orbits(axes, portrait) if is_map else _trajectories(axes, portrait)
    return axes, [*_fixed_points(axes, portrait), *paths, *nullclines, *background]


def _speed(portrait: Portrait) -> Array:
    """Speeds on the grid as shares of the domain, ranked: half of all places get half the ink."""
    width = np.array([axis.width for axis in portrait.axes])
    speed = np.linalg.norm(portrait.field.rates / width, axis=-1)
    known = np.isfinite(speed)
    rank = np.full(speed.shape, np.nan)
    order = np.sort(speed[known])
    rank[known] = np.searchsorted(order, speed[known]) / max(1, order.size - 1)
    return rank


def _streamlines(axes: Axes, portrait: Portrait) -> list[Entry]:
    x, y = (n / a.unit.scale for n, a in zip(portrait.field.nodes, portrait.axes, strict=True))
    rates = np.ma.masked_invalid(shown(portrait.axes, portrait.field.rates))
    axes.streamplot(
        x,
        y,
        rates[..., 0].T,
        rates[..., 1].T,
        color=np.ma.masked_invalid(_speed(portrait)).T,
        cmap=SPEED,
        norm=Normalize(0.0, 1.0),
        density=1.25,
        linewidth=0.8,
        arrowsize=0.75,
        zorder=1,
    )
    return [(Line2D([], [], color=SPEED(0.7), linewidth=0.9, label="flow, darker is faster"),)]


def _steps(axes: Axes, portrait: Portrait) -> list[Entry]:
    stride = max(1, len(portrait.field.nodes[0]) // ARROWS)
    every = slice(stride // 2, None, stride)
    at = np.stack(np.meshgrid(*portrait.field.nodes, indexing="ij"), axis=-1)[every, every]
    step = shown(portrait.axes, portrait.field.rates[every, every])
    at = shown(portrait.axes, at)
    width = shown(portrait.axes, np.array([axis.width for axis in portrait.axes]))
    length = np.linalg.norm(step / width, axis=-1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        arrow = step / length * np.minimum(length, 0.8 / ARROWS)
    axes.quiver(
        at[..., 0],
        at[..., 1],
        arrow[..., 0],
        arrow[..., 1],
        np.ma.masked_invalid(_speed(portrait))[every, every],
        cmap=SPEED,
        angles="xy",
        scale_units="xy",
        scale=1.0,
        width=0.0025,
        zorder=1,
    )
    return [(Line2D([], [], color=SPEED(0.7), linewidth=0.9, label="direction of a step"),)]


def _nullcline(axes: Axes, portrait: Portrait, nullcline: Nullcline, *, is_map: bool) -> Entry:
    name = nullcline.of
    stroke = NULLCLINES[[axis.name for axis in portrait.axes].index(name)]
    for line in nullcline.lines:
        axes.plot(*shown(portrait.axes, line).T, zorder=3, **stroke)
    label = f"next {name} = {name}" if is_map else f"{rate_of(name)} = 0"
    return (Line2D([], [], label=label, **stroke),)


def _trajectories(axes: Axes, portrait: Portrait) -> list[Entry]:
    for path in portrait.trajectories:
        stroke = COURSES[path.course]
        for piece in split_at_seams(portrait.axes, path.points):
            axes.plot(*shown(portrait.axes, piece).T, zorder=4, **stroke)
        _arrow(axes, portrait, path, stroke["color"])
    present = {path.course for path in portrait.trajectories}
    names = {Course.SEED: "trajectory"}
    return [
        (Line2D([], [], label=names.get(course, str(course)), **COURSES[course]),)
        for course in Course
        if course in present
    ]


def _arrow(axes: Axes, portrait: Portrait, path: Trajectory, color: str) -> None:
    """An arrowhead half-way along the longest piece of a trajectory."""
    pieces = split_at_seams(portrait.axes, path.points)
    width = np.array([axis.width for axis in portrait.axes])
    lengths = [np.linalg.norm(np.diff(p / width, axis=0), axis=-1) for p in pieces]
    longest = int(np.argmax([length.sum() for length in lengths]))
    along = lengths[longest].cumsum()
    if along.size < 4 or along[-1] < 0.03:
        return
    middle = int(np.clip(np.searchsorted(along, 0.45 * along[-1]), 1, along.size - 1))
    tail, head = shown(portrait.axes, pieces[longest][[middle - 1, middle + 1]])
    axes.add_patch(
        FancyArrowPatch(
            tail, head, arrowstyle="-|>", mutation_scale=12.0, color=color, linewidth=0.0, zorder=5
        )
    )


def _orbits(axes: Axes, portrait: Portrait) -> list[Entry]:
    for path in portrait.trajectories:
        axes.plot(
            *shown(portrait.axes, path.points).T, "o", color=INK, markersize=2.2, mew=0.0, zorder=4
        )
    dot = Line2D([], [], linestyle="none", marker="o", color=INK, markersize=2.8)
    dot.set_label("orbit")
    return [(dot,)] if portrait.trajectories else []


def _fixed_points(axes: Axes, portrait: Portrait) -> list[Entry]:
    """Marks the fixed points; one on the seam of a periodic axis at both of its ends."""
    at: list[Array] = []
    kinds = []
    for point in portrait.fixed_points:
        for copy in _copies(portrait, point.at):
            at.append(shown(portrait.axes, copy))
            kinds.append(point.kind)
    return mark(axes, np.array(at).reshape(-1, 2), kinds)


def _copies(portrait: Portrait, at: Array) -> list[Array]:
    copies = [at]
    for j, axis in enumerate(portrait.axes):
        if not axis.periodic:
            continue
        low = [c for c in copies if c[j] - axis.low < 1e-6 * axis.width]
        high = [c for c in copies if axis.high - c[j] < 1e-6 * axis.width]
        shift = axis.width * np.eye(len(at))[j]
        copies += [c + shift for c in low] + [c - shift for c in high]
    return copies

"""The portrait of three variables: trajectories, manifolds, cycles and points in a box."""

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.ticker import MaxNLocator

from runtime.arrays import Array
from specc.figures.axes_of_states import split_at_seams
from specc.figures.camera import CORNERS, Camera
from specc.figures.legend import Entry, line_entry
from specc.figures.markers import mark, rest
from specc.figures.palettes import Palette
from specc.figures.panel import head_at, places_along
from specc.figures.quantities import axis_label, number
from verifier.topology.features import AxisRange, Portrait

CHUNK: Final = 8
"""Points of a curve that are one piece: pieces are drawn from the farthest to the nearest."""

FADE: Final = 0.62
"""How much of its colour the farthest piece loses."""

HALO: Final = 1.2
"""Points by which a gap around a nearer line is wider than the line."""

STEP: Final = 0.008
"""Points of a curve nearer than this share of the box are left out."""

MARGIN: Final = 0.14
"""For ticks and names around the projected box."""

ABOVE: Final = 0.03
"""For nothing, above it."""

SOLID: Final = 2.85
"""Inches for a unit of the projected box."""

HEAD: Final = 0.1
"""The length of an arrowhead on a thin curve, in inches."""

APART: Final = 1.6
"""How far apart arrowheads stand along a curve, in inches."""

CLEAR: Final = 0.3
"""How far an arrowhead stays from all others, in inches."""

MANY: Final = 1500
"""More pieces than these are stored as an image within the drawing."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Curve:
    """A path (T, 3) in shares of the box, its colour and its width in points."""

    path: Array
    color: str
    width: float


def draw_space(axes: Axes, portrait: Portrait, palette: Palette) -> list[Entry]:
    """Draws into `axes`, which lose their frame; gives what the legend shows."""
    camera = Camera()
    axes.set_axis_off()
    axes.set_aspect("equal")
    _draw_box(axes, portrait.axes, camera, palette)
    curves, entries = _curves(portrait, palette)
    _draw_curves(axes, curves, camera, palette)
    _draw_heads(axes, curves, camera, palette)
    at = np.array([p.at for p in portrait.fixed_points]).reshape(-1, 3)
    shares = _shares(portrait.axes, at)
    _draw_plumb_lines(axes, shares, camera, palette)
    places = camera.projected(shares)[:, :2]
    points = mark(axes, places, [p.kind for p in portrait.fixed_points], palette)
    ends = _shares(portrait.axes, np.array(portrait.rests).reshape(-1, 3))
    points += rest(axes, camera.projected(ends)[:, :2], palette)
    return [*points, *entries]


def size_of_space() -> tuple[float, float]:
    """Width and height of the drawing, in inches."""
    width, height = Camera().size.tolist()
    return SOLID * (width + 2.0 * MARGIN), SOLID * (height + MARGIN + ABOVE)


def _shares(states: tuple[AxisRange, ...], points: Array) -> Array:
    low = np.array([s.low for s in states])
    return np.asarray((points - low) / np.array([s.width for s in states]))


def _curves(portrait: Portrait, palette: Palette) -> tuple[list[Curve], list[Entry]]:
    paths: list[tuple[Array, str, float, str]] = [
        *((t.points, palette.path, 0.8, "trajectory") for t in portrait.trajectories),
        *(
            (
                s.points,
                palette.stable if s.stable else palette.unstable,
                1.2,
                f"{'stable' if s.stable else 'unstable'} manifold",
            )
            for s in portrait.separatrices
        ),
        *((c.points, palette.cycle, 2.0, f"{c.stability} cycle") for c in portrait.cycles),
    ]
    curves = [
        Curve(_thinned(_shares(portrait.axes, piece)), color, width)
        for points, color, width, _ in paths
        for piece in split_at_seams(portrait.axes, points)
    ]
    entries = [line_entry(name, color=color, linewidth=width) for _, color, width, name in paths]
    return curves, entries


def _thinned(path: Array) -> Array:
    """The path without points that lie close to one another; its ends are kept."""
    length = np.concatenate([[0.0], np.linalg.norm(np.diff(path, axis=0), axis=-1).cumsum()])
    step = np.floor(length / STEP)
    keep = np.concatenate([[True], np.diff(step) > 0.0])
    keep[-1] = True
    return np.asarray(path[keep])


def _draw_curves(axes: Axes, curves: list[Curve], camera: Camera, palette: Palette) -> None:
    """All pieces of all curves from far to near, each with a gap around it."""
    pieces: list[tuple[float, Array, Curve]] = []
    for curve in curves:
        places = camera.projected(curve.path)
        for begin in range(0, len(places) - 1, CHUNK):
            piece = places[begin : begin + CHUNK + 1]
            # Where two curves nearly coincide, the heavier one is not to flicker.
            depth = float(piece[:, 2].mean()) + 0.05 * curve.width
            pieces.append((depth, piece[:, :2], curve))
    pieces.sort(key=lambda entry: entry[0])
    lines, colors, widths = [], [], []
    for depth, piece, curve in pieces:
        lines += [piece[1:-1] if len(piece) > 3 else piece, piece]
        colors += [to_rgb(palette.paper), _faded(curve.color, depth, palette)]
        widths += [curve.width + HALO, curve.width]
    axes.add_collection(
        LineCollection(
            lines,
            colors=colors,
            linewidths=widths,
            capstyle="butt",
            zorder=4,
            rasterized=len(pieces) > MANY,
        ),
        autolim=False,
    )


def _draw_heads(axes: Axes, curves: list[Curve], camera: Camera, palette: Palette) -> None:
    """Arrowheads along all curves in the direction of time, in the colour of their depth."""
    shapes, colors, taken = [], [], np.empty((0, 2))
    for curve in curves:
        places = camera.projected(curve.path)
        inches = SOLID * places[:, :2]
        for k in places_along(inches, APART).tolist():
            along = inches[k + 1] - inches[k - 1]
            gaps = np.hypot(*(taken - inches[k]).T)
            if not np.any(along) or np.any(gaps < CLEAR):
                continue
            size = HEAD * (0.75 + 0.25 * curve.width)
            shapes.append(head_at(inches[k], along, size) / SOLID)
            colors.append(_faded(curve.color, float(places[k, 2]), palette))
            taken = np.concatenate([taken, inches[k][None]])
    heads = PolyCollection(shapes, facecolors=colors, edgecolors="none", zorder=4.1)
    axes.add_collection(heads, autolim=False)


def _faded(color: str, depth: float, palette: Palette) -> tuple[float, float, float]:
    """The colour of a piece at a depth between about -0.8 (far) and 0.8 (near)."""
    share = FADE * float(np.clip(0.5 - depth / 1.5, 0.0, 1.0))
    mixed = (1.0 - share) * np.array(to_rgb(color)) + share * np.array(to_rgb(palette.paper))
    r, g, b = mixed.tolist()
    return r, g, b


def _draw_plumb_lines(axes: Axes, shares: Array, camera: Camera, palette: Palette) -> None:
    """From each fixed point down to the floor, so that its place can be read."""
    for share in shares:
        foot = np.array([share[0], share[1], 0.0])
        ends = camera.projected(np.stack([share, foot]))[:, :2]
        axes.plot(*ends.T, color=palette.faint, linewidth=0.7, linestyle=(0, (1, 2)), zorder=3)
        axes.plot(*ends[1], "o", color=palette.faint, markersize=2.2, zorder=3)


def _draw_box(axes: Axes, states: tuple[AxisRange, ...], camera: Camera, palette: Palette) -> None:
    """The three faces at the back with their grid, and the ticks at the outer edges."""
    corners = camera.projected(CORNERS)[:, :2]
    low, high = corners.min(axis=0) - MARGIN, corners.max(axis=0) + np.array([MARGIN, ABOVE])
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    back = np.where(camera.axes[2] > 0.0, 0.0, 1.0)
    lines: list[Array] = []
    for j, state in enumerate(states):
        for tick in [0.0, 1.0, *_ticks(state)[0].tolist()]:
            lines += _grid_lines(j, tick, back)
    projected = [camera.projected(line)[:, :2] for line in lines]
    axes.add_collection(
        LineCollection(projected, colors=palette.slow, linewidths=0.5, zorder=0), autolim=False
    )
    for j, state in enumerate(states):
        _label_edge(axes, state, j, back, camera, palette)


def _ticks(state: AxisRange) -> tuple[Array, list[str]]:
    """Shares of the ticks of an axis, and their texts."""
    scale = state.unit.scale
    low, high = state.low / scale, state.high / scale
    values = np.asarray(MaxNLocator(4, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high))
    inside = values[(values >= low - 1e-9) & (values <= high + 1e-9)]
    return (inside - low) / (high - low), [number(float(v)) for v in inside]


def _grid_lines(j: int, tick: float, back: Array) -> list[Array]:
    """Lines at a tick of axis j across the two faces at the back that contain its direction."""
    lines = []
    for across in {0, 1, 2} - {j}:
        (other,) = {0, 1, 2} - {j, across}
        ends = np.empty((2, 3))
        ends[:, j], ends[:, other], ends[:, across] = tick, back[other], (0.0, 1.0)
        lines.append(ends)
    return lines


def _label_edge(
    axes: Axes, state: AxisRange, j: int, back: Array, camera: Camera, palette: Palette
) -> None:
    """Ticks, their numbers and the name along the edge at which axis j is read."""
    start, outward = _edge(j, back, camera)
    shares, texts = _ticks(state)
    ends = np.stack([start, start])
    ends[1, j] = 1.0
    axes.plot(*camera.projected(ends)[:, :2].T, color=palette.ink, linewidth=0.8, zorder=1)
    for share, text in zip(shares.tolist(), texts, strict=True):
        at = start.copy()
        at[j] = share
        place = camera.projected(at)[:2]
        tick = np.stack([place, place + 0.018 * outward])
        axes.plot(*tick.T, color=palette.ink, linewidth=0.8, zorder=1)
        x, y = (place + 0.055 * outward).tolist()
        axes.text(x, y, text, ha="center", va="center", fontsize=8.0, zorder=1)
    middle = start.copy()
    middle[j] = 0.5
    x, y = (camera.projected(middle)[:2] + 0.14 * outward).tolist()
    upright = 90.0 if j == 2 else 0.0
    label = axis_label(state.name, state.unit)
    axes.text(x, y, label, ha="center", va="center", rotation=upright, fontsize=10.0)


def _edge(j: int, back: Array, camera: Camera) -> tuple[Array, Array]:
    """The start (3,) of the edge at which axis j is read, and the way outwards on the paper."""
    if j == 2:
        # The leftmost upright edge.
        corners = np.array([[x, y, 0.0] for x in (0.0, 1.0) for y in (0.0, 1.0)])
        start = corners[np.argmin(camera.projected(corners)[:, 0])]
        return start, np.array([-1.0, 0.0])
    start = 1.0 - back
    start[j], start[2] = 0.0, 0.0
    middle = start.copy()
    middle[j] = 0.5
    away = camera.projected(middle)[:2] - camera.projected(np.array([0.5, 0.5, 0.0]))[:2]
    away[1] = min(away[1], -0.2)
    return start, away / np.hypot(*away)

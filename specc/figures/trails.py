"""Trails of robots on a floor, with marks of time and of trouble.

They are coloured by what had its way; where only one ever acts, by time.
"""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Colormap, LinearSegmentedColormap

from runtime.arrays import Array, Booleans, Integers
from specc.figures.legend import Entry, Look, line_entry
from specc.figures.palettes import Palette
from specc.figures.quantities import seconds
from specc.figures.scene import NOBODY, Mark, Scene, Trails

DOERS: Final = ("#e69f00", "#cc79a7", "#009e73", "#56b4e9", "#d55e00", "#f0e442", "#0072b2")
"""Okabe and Ito's colours for what acts; each goes with a dash pattern."""
GREYS: Final = ("#000000", "#6e6e6e", "#3c3c3c", "#a0a0a0", "#1c1c1c", "#8a8a8a", "#555555")
DASHES: Final = (
    "-", (0, (5, 1.2)), (0, (1.4, 1)), (0, (6, 1.2, 1.4, 1.2)), (0, (9, 1.5)), (0, (3, 1)),
    (0, (8, 1, 1.4, 1, 1.4, 1)),
)  # fmt: skip
STEPS: Final = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0)
"""Seconds between two marks of time."""
MOST_MARKS: Final = 8
MARGIN: Final = 2.5e-4
"""Share of the floor's longer side by which a straight piece may miss what was there."""
PIECES: Final = 400
"""Of a way that is coloured by time, at least."""
SHORT: Final = 0.01
"""Metres of a way that are too short to be seen."""


def names_of(trails: Trails) -> tuple[str, ...]:
    """Everything that acts, once, in the order of robots."""
    return tuple(dict.fromkeys(name for doers in trails.doers for name in doers))


def pieces(acting: Integers) -> Iterator[tuple[int, int, int]]:
    """Stretches in which one acts: its index, first, and last; each ends where the next begins."""
    if not len(acting):
        return
    changes = np.flatnonzero(np.diff(acting)) + 1
    bounds = [0, *changes.tolist(), len(acting) - 1]
    for first, last in pairwise(bounds):
        if last > first:
            yield int(acting[first]), first, last


def thinned(points: Array, margin: float) -> Booleans:
    """Which of (n, 2) points on a way are enough, so that none is missed by more than `margin`.

    Douglas and Peucker's (1973) method.
    """
    kept = np.zeros(len(points), dtype=np.bool_)
    kept[[0, -1]] = True
    stack = [(0, len(points) - 1)]
    while stack:
        first, last = stack.pop()
        if last - first < 2:
            continue
        along = points[last] - points[first]
        from_first = points[first + 1 : last] - points[first]
        length = float(along @ along)
        share = np.clip(from_first @ along / length, 0.0, 1.0) if length else 0.0
        off = from_first - np.multiply.outer(share, along) if length else from_first
        far = np.hypot(off[:, 0], off[:, 1])
        worst = int(np.argmax(far))
        if far[worst] > margin:
            middle = first + 1 + worst
            kept[middle] = True
            stack += [(first, middle), (middle, last)]
    return kept


def draw_trails(axes: Axes, scene: Scene, trails: Trails, palette: Palette) -> list[Entry]:
    """The ways of all robots; gives the legend's entries."""
    names = names_of(trails)
    margin = MARGIN * float(np.ptp(scene.arena, axis=0).max())
    seen: set[int] = set()
    told = [tuple(place[:2]) for place in trails.robots[-1].tolist()]
    for robot in range(len(scene.robots)):
        if is_by_time(trails):
            _timed(axes, trails, robot, margin, palette)
        else:
            seen |= _trail(axes, trails, robot, names, margin, palette)
        _times(axes, trails, robot, palette, told)
    entries = [
        line_entry(f"{name} acts", linewidth=2.4, **look_of(place, palette))
        for place, name in enumerate(names)
        if place in seen
    ]
    if NOBODY in seen:
        entries.append(line_entry("nobody acts", linewidth=1.2, **look_of(NOBODY, palette)))
    return [*entries, *_troubles(axes, trails, palette)]


def is_by_time(trails: Trails) -> bool:
    """Whether ways are coloured by time: who acts tells nothing where it is always the same."""
    return len(names_of(trails)) <= 1


def time_colors(palette: Palette) -> Colormap:
    """From the beginning of a run to its end: from faint to strong."""
    if palette.hatches:
        return LinearSegmentedColormap.from_list("time", ["#8a8a8a", "#000000"])
    if palette.paper == "#ffffff":
        return LinearSegmentedColormap.from_list("time", ["#f2b04a", "#c8407f", "#35115f"])
    return LinearSegmentedColormap.from_list("time", ["#35608f", "#c65f9c", "#ffe9a8"])


def look_of(place: int, palette: Palette) -> Look:
    """The colour and dashes of what acts; NOBODY is thin and grey."""
    if place == NOBODY:
        return {"color": palette.faint, "linestyle": (0, (1, 1))}
    colors = GREYS if palette.hatches else DOERS
    return {"color": colors[place % len(colors)], "linestyle": DASHES[place % len(DASHES)]}


def _trail(
    axes: Axes,
    trails: Trails,
    robot: int,
    names: tuple[str, ...],
    margin: float,
    palette: Palette,
) -> set[int]:
    """One robot's way, a piece for each stretch in which one acts; gives who is seen to act."""
    points = trails.robots[:, robot, :2]
    ways: dict[int, list[Array]] = {}
    for doer, first, last in pieces(trails.acting[:, robot]):
        place = NOBODY if doer == NOBODY else names.index(trails.doers[robot][doer])
        stretch = points[first : last + 1]
        ways.setdefault(place, []).append(stretch[thinned(stretch, margin)])
    _ground(axes, [way for stretches in ways.values() for way in stretches], palette)
    for place, stretches in ways.items():
        width = 1.2 if place == NOBODY else 2.2
        axes.add_collection(
            LineCollection(
                stretches, linewidths=width, zorder=5.1, **_many(look_of(place, palette))
            )
        )
    return {place for place, stretches in ways.items() if any(map(_is_long, stretches))}


def _timed(axes: Axes, trails: Trails, robot: int, margin: float, palette: Palette) -> None:
    """One robot's way, coloured by time."""
    points, times = trails.robots[:, robot, :2], trails.times
    kept = thinned(points, margin)
    kept[:: max(len(points) // PIECES, 1)] = True
    rows = np.flatnonzero(kept)
    pieces_of = np.stack([points[rows[:-1]], points[rows[1:]]], axis=1)
    _ground(axes, [points[rows]], palette)
    middle = 0.5 * (times[rows[:-1]] + times[rows[1:]])
    span = max(float(times[-1] - times[0]), 1e-9)
    colors = time_colors(palette)((middle - times[0]) / span)
    axes.add_collection(
        LineCollection(list(pieces_of), colors=colors, linewidths=2.0, capstyle="round", zorder=5.1)
    )


def _ground(axes: Axes, ways: list[Array], palette: Palette) -> None:
    """A rim around ways, that parts them where they cross."""
    axes.add_collection(
        LineCollection(ways, colors=palette.paper, linewidths=3.4, alpha=0.85, zorder=5.0)
    )


def _is_long(way: Array) -> bool:
    return float(np.hypot(*np.diff(way, axis=0).T).sum()) > SHORT


def _many(one: Look) -> Look:
    """A look as collections are told it."""
    return {"colors": one["color"], "linestyles": [one["linestyle"]]}


def _times(
    axes: Axes, trails: Trails, robot: int, palette: Palette, told: list[tuple[float, ...]]
) -> None:
    """Marks of time along a way; their seconds where nothing is told near by.

    told: where something is told already; what is told here is added to it.
    """
    times = trails.times
    step = time_step(float(times[-1] - times[0]))
    apart = 0.075 * float(np.diff(axes.get_xlim())[0])
    first = math.ceil(float(times[0]) / step + 1e-9)
    for count in range(first, math.ceil(float(times[-1]) / step - 1e-9)):
        at = int(np.searchsorted(times, count * step - 1e-9))
        x, y = trails.robots[at, robot, :2].tolist()
        axes.plot(x, y, "o", ms=3.4, mfc=palette.paper, mec=palette.ink, mew=0.9, zorder=6)
        if all(abs(x - u) > apart or abs(y - v) > 0.5 * apart for u, v in told):
            axes.annotate(
                seconds(count * step), (x, y), (4, 4), textcoords="offset points", fontsize=7,
                color=palette.ink, zorder=9,
                bbox={"facecolor": palette.paper, "alpha": 0.7, "pad": 0.6, "edgecolor": "none"},
            )  # fmt: skip
            told.append((x, y))


def time_step(duration: float) -> float:
    """Seconds between marks: the least of the usual ones that gives few enough.

    >>> time_step(60.0), time_step(3.0)
    (10.0, 0.5)
    """
    return next((step for step in STEPS if duration / step <= MOST_MARKS), STEPS[-1])


def _troubles(axes: Axes, trails: Trails, palette: Palette) -> list[Entry]:
    """Where robots touched something, and where they were stuck."""
    entries = []
    touch: Look = {
        "marker": "x", "linestyle": "None", "ms": 5.0, "mew": 1.4, "color": palette.alarm,
        "zorder": 7,
    }  # fmt: skip
    stuck: Look = {
        "marker": "s", "linestyle": "None", "ms": 9.0, "mew": 1.6, "mec": palette.alarm,
        "mfc": "none", "zorder": 7,
    }  # fmt: skip
    for marks, drawn, name in (
        (trails.contacts, touch, "touched something"),
        (trails.jams, stuck, "stuck"),
    ):
        if marks:
            kept = _apart(marks)
            axes.plot([m.x for m in kept], [m.y for m in kept], **drawn)
            entries.append(line_entry(f"{name} ({len(marks)})", **drawn))
    for jam in trails.jams:
        _tell_jam(axes, jam, palette)
    return entries


def _tell_jam(axes: Axes, jam: Mark, palette: Palette) -> None:
    """How long a robot was stuck, on the side on which there is more room."""
    is_left = jam.x < float(np.mean(axes.get_xlim()))
    axes.annotate(
        f"stuck for {seconds(jam.end - jam.time)}", (jam.x, jam.y), (14 if is_left else -14, -9),
        textcoords="offset points", fontsize=7, color=palette.alarm, zorder=9, va="top",
        ha="left" if is_left else "right",
        bbox={"facecolor": palette.paper, "alpha": 0.7, "pad": 0.6, "edgecolor": "none"},
    )  # fmt: skip


def _apart(marks: tuple[Mark, ...]) -> list[Mark]:
    """One of all marks that are within a centimetre of one another."""
    return list({(round(m.x, 2), round(m.y, 2)): m for m in marks}.values())

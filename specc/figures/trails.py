"""Trails of robots on a floor, coloured by what had its way; where only one ever acts, by time.

Of a run so long that its trails would black the floor out only the last part is drawn so; what was
before is thin and faint, and darkest where robots were most often.
"""

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Colormap, LinearSegmentedColormap

from runtime.arrays import Array, Booleans, Integers
from specc.figures.legend import Entry, Look, line_entry
from specc.figures.moments import STEPS
from specc.figures.palettes import Palette
from specc.figures.quantities import seconds
from specc.figures.scene import NOBODY, Scene, Trails

DOERS: Final = ("#e69f00", "#cc79a7", "#009e73", "#56b4e9", "#d55e00", "#f0e442", "#0072b2")
"""Okabe and Ito's colours for what acts; each goes with a dash pattern."""
GREYS: Final = ("#000000", "#6e6e6e", "#3c3c3c", "#a0a0a0", "#1c1c1c", "#8a8a8a", "#555555")
DASHES: Final = (
    "-", (0, (5, 1.2)), (0, (1.4, 1)), (0, (6, 1.2, 1.4, 1.2)), (0, (9, 1.5)), (0, (3, 1)),
    (0, (8, 1, 1.4, 1, 1.4, 1)),
)  # fmt: skip
MARGIN: Final = 4e-4
"""Share of the floor's longer side by which a straight piece may miss what was there."""
NOBODY_NAME: Final = "nobody"
"""Of `NOBODY`, in words."""
SELDOM: Final = 0.02
"""The share of the time below which the legend of a film does not tell who acts."""
SHADES: Final = 100
"""Colours of a way that is coloured by time."""
WIDTH: Final = 2.2
"""Points of the line of a way."""
CROWDED: Final = 0.22
"""The share of the floor from which on lines on it are too many to be told apart."""
CLEAR: Final = 0.1
"""The share of it that the lines of the last part of such a run take."""
OFTEN: Final = 0.16
"""How dark one faint line is; where more lie upon one another it is darker."""
SHORT: Final = 0.01
"""Metres of a way that are too short to be seen."""


def names_of(trails: Trails) -> tuple[str, ...]:
    """Everything that acts, once, in the order of robots."""
    return tuple(dict.fromkeys(name for doers in trails.doers for name in doers))


def shares_of(trails: Trails) -> dict[str, float]:
    """What share of the time each has its way, of all robots together; at last nobody."""
    shares = dict.fromkeys(names_of(trails), 0.0)
    for robot, doers in enumerate(trails.doers):
        for place, name in enumerate(doers):
            shares[name] += float(np.mean(trails.acting[:, robot] == place)) / len(trails.doers)
    return shares | {NOBODY_NAME: float(np.mean(trails.acting == NOBODY))}


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


def fresh_since(scene: Scene, trails: Trails, per_metre: float) -> float:
    """From when on ways are drawn in full: from the beginning, if they don't fill the floor.

    per_metre: points of the paper for a metre.
    """
    begun, ended = float(trails.times[0]), float(trails.times[-1])
    steps = np.hypot(*np.moveaxis(np.diff(trails.robots[:, :, :2], axis=0), 2, 0))
    inked = float(steps.sum()) * WIDTH / per_metre / area(scene.arena)
    if inked <= CROWDED:
        return begun
    wanted = (ended - begun) * CLEAR / inked
    return ended - max((step for step in STEPS if step <= wanted), default=STEPS[0])


def area(corners: Array) -> float:
    """Of a polygon (n, 2)."""
    x, y = corners.T
    return 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))


def part_of(trails: Trails, since: float, until: float = np.inf) -> Trails:
    """The part of a run's ways between two times; what happened on them is kept as it is."""
    rows = slice(
        int(np.searchsorted(trails.times, since - 1e-9)),
        int(np.searchsorted(trails.times, until + 1e-9)),
    )
    return replace(
        trails,
        times=trails.times[rows],
        things=trails.things[rows],
        robots=trails.robots[rows],
        acting=trails.acting[rows],
    )


def draw_trails(
    axes: Axes, scene: Scene, trails: Trails, since: float, palette: Palette
) -> list[Entry]:
    """The ways of all robots, in full from `since` on; gives the legend's entries."""
    names = names_of(trails)
    margin = MARGIN * float(np.ptp(scene.arena, axis=0).max())
    seen: set[int] = set()
    entries = []
    if since > trails.times[0]:
        entries.append(_older(axes, part_of(trails, trails.times[0], since), margin, palette))
    fresh = part_of(trails, since)
    for robot in range(len(scene.robots)):
        if is_by_time(trails):
            _timed(axes, fresh, robot, margin, palette)
        else:
            seen |= _trail(axes, fresh, robot, names, margin, palette)
    entries += [
        line_entry(acts(name), linewidth=2.4, **look_of(place, palette))
        for place, name in enumerate(names)
        if place in seen
    ]
    if NOBODY in seen:
        entries.append(line_entry(acts(NOBODY_NAME), linewidth=1.2, **look_of(NOBODY, palette)))
    return entries


def _older(axes: Axes, trails: Trails, margin: float, palette: Palette) -> Entry:
    """Ways of long ago, in pieces, so that they darken where they cross; an image in every file."""
    rows = max(len(trails.times) // SHADES, 2)
    ways = []
    for robot in range(trails.robots.shape[1]):
        points = trails.robots[:, robot, :2]
        for first in range(0, len(points) - 1, rows):
            stretch = points[first : first + rows + 1]
            ways.append(stretch[thinned(stretch, margin)])
    axes.add_collection(
        LineCollection(
            ways, colors=palette.ink, linewidths=1.0, alpha=OFTEN, zorder=2.0, rasterized=True
        )
    )
    told = f"where it was before, until {seconds(float(trails.times[-1]))}"
    return line_entry(told, color=palette.ink, alpha=0.4, linewidth=1.2)


def acts(name: str) -> str:
    """That one acts, or several together.

    >>> acts("seek"), acts("mostly seek"), acts("seek + avoid")
    ('seek acts', 'mostly seek', 'seek + avoid act')
    """
    if name.startswith("mostly "):
        return name
    return f"{name} act" if " + " in name else f"{name} acts"


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
        width = 1.2 if place == NOBODY else WIDTH
        axes.add_collection(
            LineCollection(
                stretches, linewidths=width, zorder=5.1, **_many(look_of(place, palette))
            )
        )
    return {place for place, stretches in ways.items() if any(map(_is_long, stretches))}


def _timed(axes: Axes, trails: Trails, robot: int, margin: float, palette: Palette) -> None:
    """One robot's way, coloured by time: a piece for each shade."""
    points, times = trails.robots[:, robot, :2], trails.times
    span = max(float(times[-1] - times[0]), 1e-9)
    shades = np.minimum((SHADES * (times - times[0]) / span).astype(np.int64), SHADES - 1)
    ways, colors = [], []
    for shade, first, last in pieces(shades):
        stretch = points[first : last + 1]
        ways.append(stretch[thinned(stretch, margin)])
        colors.append(time_colors(palette)((shade + 0.5) / SHADES))
    _ground(axes, ways, palette)
    axes.add_collection(
        LineCollection(ways, colors=colors, linewidths=2.0, capstyle="round", zorder=5.1)
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

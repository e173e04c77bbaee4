"""A run's stage: what stands still is drawn once, and each moment only what moves upon it.

Films and windows show its pictures.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.text import Text
from PIL import Image

from runtime.arrays import Array, Integers
from specc.figures.eyes import Glimpse, arcs, glimpses, hits
from specc.figures.footprints import lamps_at, outline, patch, placed, reach_of
from specc.figures.legend import Entry, draw_legend, line_entry
from specc.figures.moving_names import MovingNames
from specc.figures.palettes import Palette
from specc.figures.paper import axes_at, new_figure, spaced
from specc.figures.quantities import number
from specc.figures.scene import NOBODY, EyeKind, Scene, Trails
from specc.figures.trails import NOBODY_NAME, acts, look_of
from specc.figures.world import LAMP, bounds, floor, light_image

DPI: Final = 80
LONG: Final = 6.4
"""Inches of the longer side of the floor."""
HEAD: Final = 0.45
LEGEND: Final = 1.75
MARGIN: Final = 0.12
LINE: Final = 0.21
"""Of the lines that tell who acts."""
TAIL: Final = 8.0
"""Seconds of way that a robot draws behind it."""
POINTS: Final = 80
"""Of such a way, at most."""
CORNERS: Final = 20


@final
@dataclass(frozen=True, eq=False, slots=True)
class Moment:
    """What is to be seen at one time.

    things (t, 3), robots (r, 3): poses. acting: (r,) as in `Trails`. past_robots (m, r, 3),
    past_acting (m, r): the same up to now. glimpses: for each robot what its eyes say; None of one
    that has said nothing yet.
    """

    time: float
    things: Array
    robots: Array
    acting: Integers
    past_robots: Array
    past_acting: Integers
    glimpses: tuple[tuple[Glimpse | None, ...], ...] = ()


def moment_of(trails: Trails, row: int, tail: float = TAIL) -> Moment:
    """The moment of one sample, with the last `tail` seconds of the ways to it."""
    now = float(trails.times[row])
    first = int(np.searchsorted(trails.times, now - tail))
    marks = np.append(np.arange(first, row, max((row - first) // POINTS, 1)), row)
    return Moment(
        time=now,
        things=trails.things[row],
        robots=trails.robots[row],
        acting=trails.acting[row],
        past_robots=trails.robots[marks],
        past_acting=trails.acting[marks],
        glimpses=tuple(glimpses(said, now) for said in trails.said),
    )


@final
class Stage:
    """A figure of a scene, on which moments are shown."""

    def __init__(
        self,
        scene: Scene,
        doers: Sequence[Sequence[str]],
        palette: Palette,
        names: Sequence[str],
        *,
        speed: float = 1.0,
        told: Sequence[str] = (),
    ) -> None:
        """doers: for each robot what may act; it may grow.

        names: of all that act, in the order of their colours. told: those of which the legend
        tells; "nobody" may be one.
        """
        self._scene, self._doers, self._palette = scene, doers, palette
        self._names, self._speed, self._legend = list(names), speed, list(told)
        self._things = [outline(item.shape, CORNERS) for item in scene.things]
        self._robots = [outline(item.shape, CORNERS) for item in scene.robots]
        self._loose = [i for i, item in enumerate(scene.things) if not item.is_fixed]
        self._is_set = False

    def at(self, moment: Moment) -> Image.Image:
        """The picture of one moment."""
        if not self._is_set:
            self._set(moment)
            self._is_set = True
        self._relight(moment.time)
        self._move(moment)
        self._canvas.restore_region(self._still)
        for artist in self._movers:
            artist.draw(self._canvas.get_renderer())
        picture = np.asarray(self._canvas.buffer_rgba())[:, :, :3].copy()
        self._given.stamp(picture)
        return Image.fromarray(picture)

    def _set(self, moment: Moment) -> None:
        """All that stands still, and what will be moved."""
        entries = _entries(self._names, self._legend, self._palette)
        entries += _sensed(self._scene, self._palette)
        figure, self._axes, self._image = _still(self._scene, moment, entries, self._palette)
        self._figure, self._canvas, self._lit = figure, _canvas(figure), -1
        self._movers = [*self._bodies(), *self._words(figure)]
        for artist in self._movers:
            artist.set_animated(True)
        self._canvas.draw()
        self._still = self._canvas.copy_from_bbox(figure.bbox)

    def _relight(self, time: float) -> None:
        """Draw all that stands still again, where the light is another than before."""
        glow = self._scene.glow
        if glow is None or self._image is None or glow.at(time) == self._lit:
            return
        self._lit = glow.at(time)
        self._image.set_data(glow.lux[self._lit])
        self._canvas.draw()
        self._still = self._canvas.copy_from_bbox(self._figure.bbox)

    def _bodies(self) -> list[Artist]:
        """What will be moved on the floor."""
        palette = self._palette
        self._pushed = PolyCollection([], fc=palette.tints[5], ec=palette.ink, lw=0.8, zorder=3)
        self._ways = LineCollection([], linewidths=2.2, zorder=4)
        self._seen = LineCollection([], zorder=4.5)
        self._hulls = PolyCollection([], ec=palette.ink, lw=1.0, zorder=5)
        self._noses = LineCollection([], colors=palette.paper, linewidths=1.6, zorder=6)
        self._hit = LineCollection([], colors=palette.alarm, linewidths=3.0, zorder=7)
        movers: list[Artist] = []
        for each in (self._pushed, self._ways, self._seen, self._hulls, self._noses, self._hit):
            self._axes.add_collection(each, autolim=False)
            movers.append(each)
        (self._lamps,) = self._axes.plot(
            [], [], "*", ms=13.0, mfc=LAMP, mec=palette.ink, mew=0.8, zorder=8
        )
        self._given = MovingNames(self._axes, self._scene, palette)
        return [*movers, self._lamps]

    def _words(self, figure: Figure) -> list[Artist]:
        """The clock, and for each robot who acts in it."""
        width, height = figure.get_size_inches()
        x = 1.0 - (LEGEND + MARGIN - 0.12) / width
        self._clock = figure.text(x, 1.0 - 0.1 / height, "", fontsize=11, va="top")
        self._told: list[Text] = []
        for robot in range(len(self._robots)):
            y = MARGIN + LINE * (len(self._robots) - 1 - robot)
            self._told.append(figure.text(x, y / height, "", fontsize=9, va="bottom"))
        return [self._clock, *self._told]

    def _move(self, moment: Moment) -> None:
        poses, robots = moment.things, moment.robots
        self._pushed.set_verts([placed(p, poses[i]) for i in self._loose for p in self._things[i]])
        hulls = [(i, part) for i, parts in enumerate(self._robots) for part in parts]
        colors = [self._color(i, int(doer)) for i, doer in enumerate(moment.acting)]
        self._hulls.set_verts([placed(part, robots[i]) for i, part in hulls])
        self._hulls.set_facecolor([colors[i] for i, _ in hulls])
        self._noses.set_segments(
            [
                placed(np.array([[0.0, 0.0], [reach_of(parts), 0.0]]), pose)
                for parts, pose in zip(self._robots, robots, strict=True)
            ]
        )
        self._draw_ways(moment)
        self._draw_eyes(moment)
        self._lamps.set_data(*lamps_at(self._scene, poses).T)
        self._given.move(poses, robots)
        self._write(moment, colors)

    def _draw_ways(self, moment: Moment) -> None:
        """The last seconds of each robot's way, a piece for each sample, by who acted."""
        segments: list[Array] = []
        colors = []
        for robot in range(len(self._robots)):
            points = moment.past_robots[:, robot, :2]
            segments += list(np.stack([points[:-1], points[1:]], axis=1))
            colors += [self._color(robot, int(d)) for d in moment.past_acting[:-1, robot]]
        self._ways.set_segments(segments)
        self._ways.set_color(colors or ["none"])

    def _draw_eyes(self, moment: Moment) -> None:
        """What the robots' eyes say: arcs of what is free, lines to what is seen, bumpers hit."""
        palette, drawn, struck = self._palette, [], []
        for robot, seen in enumerate(moment.glimpses):
            item, pose = self._scene.robots[robot], moment.robots[robot]
            drawn += arcs(item.eyes, seen, pose)
            struck += hits(item.eyes, seen, pose, reach_of(self._robots[robot]))
        self._seen.set_segments([line for line, _ in drawn])
        self._seen.set_color(
            [palette.stable if near else palette.faint for _, near in drawn] or ["none"]
        )
        self._seen.set_linewidth([1.5 if near else 0.7 for _, near in drawn] or [1.0])
        self._hit.set_segments(struck)

    def _write(self, moment: Moment, colors: list[str]) -> None:
        """The time, and who acts."""
        fast = "" if self._speed == 1.0 else f"   ×{number(self._speed)}"
        self._clock.set_text(f"{moment.time:.1f} s{fast}")
        for robot, told in enumerate(self._told):
            doer = int(moment.acting[robot])
            name = NOBODY_NAME if doer == NOBODY else self._doers[robot][doer]
            told.set_text(f"■ {self._scene.robots[robot].name}: {name}")
            told.set_color(colors[robot])

    def _color(self, robot: int, doer: int) -> str:
        place = NOBODY
        if doer != NOBODY:
            name = self._doers[robot][doer]
            if name not in self._names:
                self._names.append(name)
            place = self._names.index(name)
        return str(look_of(place, self._palette)["color"])


def _still(
    scene: Scene, moment: Moment, entries: Sequence[Entry], palette: Palette
) -> tuple[Figure, Axes, AxesImage | None]:
    """The figure with all that stands still, and the light on its floor."""
    left, low, right, high = bounds(scene)
    scale = LONG / max(right - left, high - low)
    size = (scale * (right - left), scale * (high - low))
    width = even(MARGIN * 2 + size[0] + LEGEND)
    height = even(MARGIN + max(size[1], 1.2 + LINE * len(scene.robots)) + HEAD)
    figure = new_figure(width, height, palette)
    figure.set_dpi(DPI)
    axes = axes_at(figure, (MARGIN, MARGIN), size)
    floor(axes, scene)
    axes.set_xticks([])
    axes.set_yticks([])
    shown = None
    if scene.glow is not None:
        shown = light_image(axes, scene.glow, palette)
        shown.set_clip_path(patch([scene.arena]).get_path(), axes.transData)
    for index, item in enumerate(scene.things):
        if item.is_fixed:
            parts = [placed(part, moment.things[index]) for part in outline(item.shape)]
            axes.add_patch(patch(parts, fc=palette.faint, ec=palette.ink, lw=0.8, zorder=2))
    title = spaced(scene.title)
    figure.text(MARGIN / width, 1.0 - 0.1 / height, title, fontsize=12, fontweight="bold", va="top")
    corner = ((MARGIN + size[0] + 0.12) / width, (MARGIN + size[1]) / height)
    draw_legend(figure, entries, corner)
    return figure, axes, shown


def _entries(names: Sequence[str], told: Sequence[str], palette: Palette) -> list[Entry]:
    """What each colour of a robot and its way means; nothing where names are not known yet."""
    drawn = [(place, acts(name)) for place, name in enumerate(names) if name in told]
    if NOBODY_NAME in told:
        drawn.append((NOBODY, acts(NOBODY_NAME)))
    return [
        line_entry(label, color=look_of(place, palette)["color"], linewidth=2.6)
        for place, label in drawn
    ]


def _sensed(scene: Scene, palette: Palette) -> list[Entry]:
    """What lines around robots mean, of the sensors that they have."""
    kinds = {eye.kind for robot in scene.robots for eye in robot.eyes}
    found = line_entry("found by a sensor", color=palette.stable, linewidth=1.5)
    free = line_entry("free up to there", color=palette.faint, linewidth=0.7)
    bumped = line_entry("bumper is hit", color=palette.alarm, linewidth=3.0)
    entries = [found] if kinds & {EyeKind.RANGE, EyeKind.SIGHT} else []
    entries += [free] if EyeKind.RANGE in kinds else []
    return entries + ([bumped] if EyeKind.BUMP in kinds else [])


def _canvas(figure: Figure) -> Any:
    """What a figure is drawn on; its methods have no types."""
    return FigureCanvasAgg(figure)


def even(inches: float) -> float:
    """A length that is an even number of pixels, as coders of films want it.

    >>> even(1.0), even(1.001) * 80
    (1.0, 82.0)
    """
    return 2 * int(np.ceil(0.5 * inches * DPI - 1e-9)) / DPI

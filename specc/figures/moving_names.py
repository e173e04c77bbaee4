"""Names on a film: beside what moves, and away from robots and from one another.

Each is drawn once, and stamped upon every picture.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final, TypeAlias, final

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from runtime.arrays import Array
from specc.figures.footprints import lamps_at, outline, placed, reach_of
from specc.figures.labels import ROOM, Box, Words, meets_polygon
from specc.figures.names import STAR, named_on_films
from specc.figures.palettes import Palette
from specc.figures.scene import Scene

Bytes: TypeAlias = npt.NDArray[np.uint8]

SIDES: Final = ((0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0))
"""Where names may stand: above, below, right, left."""
GAP: Final = 2.0
"""Points between what has a name and the name."""
CORNERS: Final = 20


@final
@dataclass(slots=True)
class _Bearer:
    """A name, how far what bears it reaches (points), its last side, and where it is now."""

    name: str
    raster: Bytes
    size: tuple[float, float]
    reach: float
    side: int = 0
    box: Box | None = None


@final
class MovingNames:
    """The names of robots, lights and things on a stage; one without a free side is not shown."""

    def __init__(self, axes: Axes, scene: Scene, palette: Palette) -> None:
        """The axes have their limits and their place on the paper."""
        self._axes, self._scene, self._palette = axes, scene, palette
        self._scale = 72.0 / axes.figure.dpi
        limits = np.column_stack([axes.get_xlim(), axes.get_ylim()])
        low, high = self._on_paper(limits)
        self._paper = Box(*low.tolist(), *high.tolist())
        self._metre = (self._paper.right - self._paper.left) / float(np.ptp(limits[:, 0]))
        self._hulls = [outline(item.shape, CORNERS) for item in scene.robots]
        self._things = named_on_films(scene)
        self._bearers = [*self._of_robots(), *self._of_lamps(), *self._of_things()]

    @property
    def shown(self) -> dict[str, Box]:
        """Where names are now, in points of the paper."""
        return {bearer.name: bearer.box for bearer in self._bearers if bearer.box is not None}

    def stamp(self, picture: Bytes) -> None:
        """Put the names on a picture (height, width, 3) of the whole figure."""
        for bearer in self._bearers:
            if bearer.box is not None:
                x = round(bearer.box.left / self._scale)
                y = round(len(picture) - bearer.box.high / self._scale)
                height, width, _ = bearer.raster.shape
                part = picture[y : y + height, x : x + width]
                part[:] = _over(bearer.raster[: len(part), : part.shape[1]], part)

    def move(self, things: Array, robots: Array) -> None:
        """Put every name beside its bearer, things being at poses (t, 3) and robots at (r, 3)."""
        hulls = [
            self._on_paper(placed(part, pose))
            for parts, pose in zip(self._hulls, robots, strict=True)
            for part in parts
        ]
        lamps = lamps_at(self._scene, things)
        at = np.vstack([robots[:, :2], lamps, things[self._things][:, :2].reshape(-1, 2)])
        taken = [
            Box(x - STAR, y - STAR, x + STAR, y + STAR) for x, y in self._on_paper(lamps).tolist()
        ]
        for bearer, middle in zip(self._bearers, self._on_paper(at), strict=True):
            bearer.box = self._free(bearer, middle, hulls, taken)
            if bearer.box is not None:
                taken.append(bearer.box)

    def _free(
        self, bearer: _Bearer, middle: Array, hulls: list[Array], taken: list[Box]
    ) -> Box | None:
        """The first free place beside a bearer; the side it was at last is tried first."""
        order = [bearer.side, *(s for s in range(len(SIDES)) if s != bearer.side)]
        for side in order:
            box = _beside(middle, bearer.reach + GAP, SIDES[side], bearer.size)
            wide = box.wider(ROOM)
            if not wide.is_in(self._paper) or any(wide.meets(other) for other in taken):
                continue
            if not any(meets_polygon(wide, hull) for hull in hulls):
                bearer.side = side
                return box
        return None

    def _of_robots(self) -> Iterator[_Bearer]:
        for item, parts in zip(self._scene.robots, self._hulls, strict=True):
            words = Words(item.name, 9.0, self._palette.ink, self._palette.paper, is_bold=True)
            yield self._bearer(words, reach_of(parts) * self._metre)

    def _of_lamps(self) -> Iterator[_Bearer]:
        for lamp in self._scene.lamps:
            yield self._bearer(Words(lamp.name, 8.0, self._palette.ink, self._palette.paper), STAR)

    def _of_things(self) -> Iterator[_Bearer]:
        for index in self._things:
            item = self._scene.things[index]
            words = Words(item.name, 7.5, self._palette.ink, self._palette.paper)
            yield self._bearer(words, 0.75 * reach_of(outline(item.shape)) * self._metre)

    def _bearer(self, words: Words, reach: float) -> _Bearer:
        raster = raster_of(words, 72.0 / self._scale)
        height, width, _ = raster.shape
        return _Bearer(words.text, raster, (width * self._scale, height * self._scale), reach)

    def _on_paper(self, points: Array) -> Array:
        paper: Array = self._axes.transData.transform(points.reshape(-1, 2)) * self._scale
        return paper


def raster_of(words: Words, dpi: float) -> Bytes:
    """Words as a picture (height, width, 4) with what is behind them."""
    width, height = words.extent
    figure = Figure(figsize=(width / 72.0, height / 72.0), dpi=dpi)
    figure.patch.set(facecolor=words.halo, alpha=0.65)
    figure.text(
        0.5, 0.5, words.text, fontsize=words.size, color=words.color, ha="center", va="center",
        fontweight="bold" if words.is_bold else "normal",
    )  # fmt: skip
    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba()).copy()


def _over(upper: Bytes, lower: Bytes) -> Bytes:
    """A picture with transparency over one without (Porter and Duff 1984)."""
    share = upper[:, :, 3:].astype(np.uint16)
    mixed: Bytes = ((upper[:, :, :3] * share + lower * (255 - share) + 127) // 255).astype(np.uint8)
    return mixed


def _beside(middle: Array, gap: float, side: tuple[float, float], size: tuple[float, float]) -> Box:
    """A box of a size that stands at one side of a place."""
    x, y = (middle + np.array(side) * (gap + 0.5 * np.array(size))).tolist()
    return Box(x - 0.5 * size[0], y - 0.5 * size[1], x + 0.5 * size[0], y + 0.5 * size[1])

"""Words on a floor, put where they cover no robot and no other words, and as little else as can be.

Places are tried around what is told of, near ones first, as Christensen, Marks and Shieber (1995)
compare; the first that costs least is kept, so equal pictures come from equal runs.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import text_to_path

from runtime.arrays import Array, Booleans

DIRECTIONS: Final = 16
GAPS: Final = (2.5, 7.0, 14.0, 24.0, 38.0)
"""Points between what is told of and its words."""
LEADER: Final = 10.0
"""Points from which on a line leads from the words to what they tell of."""
PAD: Final = 0.8
"""Points around words that belong to them."""
ROOM: Final = 1.0
"""Points more that words keep from others."""
DENSE: Final = 2.0
"""Points between two places of a line that words should not cover."""
MARK: Final = 4
"""Places of a line that a mark counts for."""
BODY: Final = 20.0
"""Places of a line that a thing counts for."""
FAR: Final = 0.25
"""What a point of distance costs, where a covered place of a line costs one."""


@final
@dataclass(frozen=True, slots=True)
class Box:
    """An upright rectangle, in points of the paper."""

    left: float
    low: float
    right: float
    high: float

    def meets(self, other: "Box") -> bool:
        """Whether the two have a place in common."""
        across = self.left < other.right and other.left < self.right
        return across and self.low < other.high and other.low < self.high

    def is_in(self, other: "Box") -> bool:
        """Whether all of it lies in another."""
        across = other.left <= self.left and self.right <= other.right
        return across and other.low <= self.low and self.high <= other.high

    def holds(self, points: Array) -> Booleans:
        """Which of (n, 2) points lie in it."""
        x, y = points[:, 0], points[:, 1]
        inside: Booleans = (x > self.left) & (x < self.right) & (y > self.low) & (y < self.high)
        return inside

    def wider(self, by: float) -> "Box":
        """The same with a rim."""
        return Box(self.left - by, self.low - by, self.right + by, self.high + by)

    @property
    def corners(self) -> Array:
        """(4, 2), counter-clockwise."""
        (x, y), (u, v) = (self.left, self.low), (self.right, self.high)
        return np.array([[x, y], [u, y], [u, v], [x, v]])


def meets_polygon(box: Box, corners: Array) -> bool:
    """Whether a box and a convex polygon (n, 2) have a place in common (separating axes)."""
    edges = np.roll(corners, -1, axis=0) - corners
    axes = np.vstack([np.eye(2), np.column_stack([-edges[:, 1], edges[:, 0]])])
    ours, theirs = box.corners @ axes.T, corners @ axes.T
    apart = (ours.max(axis=0) <= theirs.min(axis=0)) | (theirs.max(axis=0) <= ours.min(axis=0))
    return not apart.any()


def is_within(box: Box, corners: Array) -> bool:
    """Whether all of a box lies in a convex polygon (n, 2) that runs counter-clockwise."""
    edges = np.roll(corners, -1, axis=0) - corners
    off = box.corners[:, None, :] - corners[None, :, :]
    return bool((edges[:, 0] * off[..., 1] >= edges[:, 1] * off[..., 0]).all())


@final
@dataclass(frozen=True, slots=True)
class Words:
    """What is written, and how. halo: what is behind it, empty for nothing."""

    text: str
    size: float
    color: str
    halo: str = ""
    is_bold: bool = False

    @property
    def extent(self) -> tuple[float, float]:
        """Width and height in points, with the rim that belongs to it."""
        font = FontProperties(size=self.size, weight="bold" if self.is_bold else "normal")
        width, ours = _measured(self.text, font)
        _, usual = _measured("lp", font)
        return width + 2.0 * PAD, max(ours, usual) + 2.0 * PAD


@final
@dataclass(frozen=True, slots=True)
class Note:
    """Words that belong beside a place of the floor (metres), which reaches `radius` points far."""

    words: Words
    at: tuple[float, float]
    radius: float


@final
class Labels:
    """The words on one floor; each lies where nothing was that must not be covered."""

    def __init__(self, axes: Axes, arena: Array) -> None:
        """The axes have their limits and their place on the paper; words stay in the arena's box.

        arena: (k, 2) its corners.
        """
        self._axes, self._scale = axes, 72.0 / axes.figure.dpi
        low, high = self._on_paper(np.array([arena.min(axis=0), arena.max(axis=0)]))
        self._paper = Box(*low.tolist(), *high.tolist())
        self._metre = float((high - low)[0] / np.ptp(arena[:, 0]))
        self._taken: list[Box] = []
        self._bodies: list[Array] = []
        self._things: list[Array] = []
        self._lines = np.zeros((0, 2))

    @property
    def per_metre(self) -> float:
        """Points of the paper for a metre of the floor."""
        return self._metre

    def keep_off(self, polygons: Iterable[Array]) -> None:
        """Convex polygons (n, 2) of the floor that no words may cover."""
        self._bodies += [self._on_paper(polygon) for polygon in polygons]

    def keep_off_mark(self, at: Sequence[float], radius: float) -> None:
        """A mark of `radius` points that no words may cover."""
        x, y = self._on_paper(np.array([at]))[0].tolist()
        self._taken.append(Box(x - radius, y - radius, x + radius, y + radius))

    def spare_bodies(self, polygons: Iterable[Array]) -> None:
        """Convex polygons (n, 2) of the floor that words should not cover."""
        self._things += [self._on_paper(polygon) for polygon in polygons]

    def spare(self, line: Array) -> None:
        """A line (n, 2) of the floor that words should not cover."""
        self._lines = np.vstack([self._lines, dense(self._on_paper(line), DENSE)])

    def spare_places(self, places: Array) -> None:
        """Marks at (n, 2) of the floor that words should not cover."""
        self._lines = np.vstack([self._lines, np.repeat(self._on_paper(places), MARK, axis=0)])

    def put_on(self, words: Words, parts: Sequence[Array]) -> bool:
        """Write on a footprint of convex polygons, if there is room on one; says whether."""
        for part in parts:
            corners = self._on_paper(part)
            box = _around(corners.mean(axis=0), words.extent)
            if is_within(box.wider(ROOM), corners) and self._cost(box) <= BODY:
                self._write(words, box)
                return True
        return False

    def put_by(self, note: Note) -> bool:
        """Write near the place that is told of; False where there is no room."""
        words, radius = note.words, note.radius
        middle = self._on_paper(np.array([note.at]))[0]
        best: tuple[float, Box, float] | None = None
        for gap, box in _places(middle, radius, words.extent):
            if best is not None and FAR * gap >= best[0]:
                break
            cost = self._cost(box) + FAR * gap
            if best is None or cost < best[0]:
                best = (cost, box, gap) if math.isfinite(cost) else best
        if best is None:
            return False
        _, box, gap = best
        if gap >= LEADER:
            self._lead(words, box, middle, radius)
        self._write(words, box)
        return True

    def _cost(self, box: Box) -> float:
        """Places of lines that are covered; infinite where words must not be."""
        wide = box.wider(ROOM)
        if not wide.is_in(self._paper) or any(wide.meets(other) for other in self._taken):
            return math.inf
        if any(meets_polygon(wide, body) for body in self._bodies):
            return math.inf
        things = sum(meets_polygon(wide, thing) for thing in self._things)
        return float(wide.holds(self._lines).sum()) + BODY * things

    def _write(self, words: Words, box: Box) -> None:
        self._taken.append(box)
        x, y = self._on_floor(0.5 * (box.left + box.right), 0.5 * (box.low + box.high))
        behind = {"facecolor": words.halo, "alpha": 0.75, "pad": PAD, "edgecolor": "none"}
        self._axes.text(
            x, y, words.text, fontsize=words.size, color=words.color, ha="center", va="center",
            fontweight="bold" if words.is_bold else "normal", zorder=9,
            bbox=behind if words.halo else None,
        )  # fmt: skip

    def _lead(self, words: Words, box: Box, middle: Array, radius: float) -> None:
        """A thin line from words to what they tell of."""
        low, high = np.array([box.left, box.low]), np.array([box.right, box.high])
        end = np.clip(middle, low, high)
        way = end - middle
        begin = middle + way * (radius / max(float(np.hypot(*way)), radius))
        ends = np.array([self._on_floor(*point) for point in (begin, end)])
        self._axes.plot(*ends.T, color=words.color, lw=0.5, zorder=8.9)

    def _on_paper(self, points: Array) -> Array:
        paper: Array = self._axes.transData.transform(points) * self._scale
        return paper

    def _on_floor(self, x: float, y: float) -> tuple[float, float]:
        """A place of the paper, in metres."""
        at = self._axes.transData.inverted().transform((x / self._scale, y / self._scale))
        return float(at[0]), float(at[1])


def dense(line: Array, step: float) -> Array:
    """Places (m, 2) along a line (n, 2), no two neighbours farther apart than `step`."""
    lengths = np.hypot(*np.diff(line, axis=0).T)
    far = np.concatenate([[0.0], np.cumsum(lengths)])
    wanted = np.linspace(0.0, far[-1], max(math.ceil(far[-1] / step), 1) + 1)
    return np.column_stack([np.interp(wanted, far, line[:, axis]) for axis in (0, 1)])


def _places(middle: Array, radius: float, size: tuple[float, float]) -> Iterator[tuple[float, Box]]:
    """Boxes around a place, near ones first, and to the upper right first."""
    turns = np.arange(DIRECTIONS) * math.tau / DIRECTIONS
    order = np.argsort(
        np.abs((turns - math.pi / 4.0 + math.pi) % math.tau - math.pi), kind="stable"
    )
    for gap in GAPS:
        for turn in turns[order].tolist():
            way = np.array([math.cos(turn), math.sin(turn)])
            beside = np.clip(1.5 * way, -1.0, 1.0) * (0.5 * size[0], 0.5 * size[1])
            yield gap, _around(middle + (radius + gap) * way + beside, size)


def _around(middle: Array, size: tuple[float, float]) -> Box:
    (x, y), (width, height) = middle.tolist(), size
    return Box(x - 0.5 * width, y - 0.5 * height, x + 0.5 * width, y + 0.5 * height)


def _measured(text: str, font: FontProperties) -> tuple[float, float]:
    """Width and height in points."""
    width, height, _ = text_to_path.get_text_width_height_descent(text, font, ismath=False)
    return float(width), float(height)

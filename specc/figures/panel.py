"""A panel: axes of a known size, in which a portrait is drawn.

Knowing the size in inches, lines keep an even distance and arrowheads their shape, whatever the
units of the axes are.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from runtime.arrays import Array, Integers
from specc.figures.axes_of_states import shown, split_at_seams
from specc.figures.palettes import Palette
from verifier.topology.features import AxisRange

HEAD: Final = np.array([[0.62, 0.0], [-0.38, 0.36], [-0.2, 0.0], [-0.38, -0.36]])
"""An arrowhead of length one that points along x."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Panel:
    """Axes over two states. size: (2,) inches; weight: of all lines, less in small panels."""

    axes: Axes
    states: tuple[AxisRange, ...]
    palette: Palette
    size: Array
    weight: float = 1.0

    @property
    def is_small(self) -> bool:
        """Whether it is one of many."""
        return self.weight < 1.0

    @property
    def corner(self) -> Array:
        """The lower corner, (2,), SI."""
        return np.array([state.low for state in self.states])

    @property
    def width(self) -> Array:
        """The widths of the domain, (2,), SI."""
        return np.array([state.width for state in self.states])

    def inches(self, points: Array) -> Array:
        """Where points (..., 2) stand on the paper."""
        return np.asarray((points - self.corner) / self.width * self.size)

    def from_inches(self, places: Array) -> Array:
        """The points (..., 2) in the axes' own units at places on the paper."""
        return shown(self.states, self.corner + places / self.size * self.width)

    def shown(self, points: Array) -> Array:
        """Points (..., 2) in the axes' own units."""
        return shown(self.states, points)

    def pieces(self, points: Array) -> list[Array]:
        """A path (T, 2) as pieces within the domain."""
        return split_at_seams(self.states, points)


def draw_heads(
    panel: Panel,
    places: Array,
    directions: Array,
    size: float,
    colors: str | list[tuple[float, float, float, float]],
    zorder: float,
) -> None:
    """Arrowheads of a `size` in inches at `places` (k, 2), inches, along `directions` (k, 2)."""
    if not len(places):
        return
    pairs = zip(places, directions, strict=True)
    shapes = panel.from_inches(np.stack([head_at(at, along, size) for at, along in pairs]))
    heads = PolyCollection(list(shapes), facecolors=colors, edgecolors="none", zorder=zorder)
    panel.axes.add_collection(heads, autolim=False)


def head_at(place: Array, direction: Array, size: float) -> Array:
    """The corners (4, 2) of an arrowhead of a `size` at a place (2,) along a direction (2,)."""
    along = direction / np.hypot(*direction)
    across = np.array([-along[1], along[0]])
    return np.asarray(place + size * (HEAD[:, :1] * along + HEAD[:, 1:] * across))


def places_along(path: Array, apart: float) -> Integers:
    """Indices of a path (T, 2), inches, where arrowheads stand: evenly, none near the ends."""
    steps = np.hypot(*np.diff(path, axis=0).T)
    length = np.concatenate([[0.0], steps.cumsum()])
    if len(path) < 3 or length[-1] < 0.25:
        return np.empty(0, dtype=np.int64)
    count = max(1, round(length[-1] / apart))
    wanted = (np.arange(count) + 0.5) / count * length[-1]
    return np.asarray(np.clip(np.searchsorted(length, wanted), 1, len(path) - 2))

"""Light in a world: at a place, and on the whole floor.

Sources are points that throw I cos / r^2 on a horizontal surface; what stands in the way lets its
transmittance through, once for each thing. Things lower than a light have finite shadows. Nothing
is reflected: `ambient` stands for that.
"""

import math
from collections.abc import Sequence
from typing import final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.world.geometry import Geometry
from runtime.world.kernels.parts import Parts
from runtime.world.kernels.shade import illuminance
from runtime.world.kernels.shadow_map import shine
from runtime.world.model import Light
from runtime.world.rays import NOBODY, Place, View, half_cosine

ANYWHERE = View(1.0, 0.0, half_cosine(2.0 * math.pi), 0.0)
"""The view of a meter that accepts light from all round."""


@final
class Sources:
    """The lights of a world, carried along by the things that they stand on.

    Attributes:
        rows: (l, 8) as the kernels want them, as of the last `place`.
        owners: (l,) who carries each; -1 for one that hangs from above.
    """

    def __init__(self, lights: Sequence[Light], geometry: Geometry) -> None:
        self._lights = tuple(lights)
        self._placed: list[list[float]] = [[] for _ in self._lights]
        self._geometry = geometry
        found = [geometry.names.index(light.on) if light.on else NOBODY for light in lights]
        self.owners = np.array(found, dtype=np.int64)
        self._carried = [index for index, owner in enumerate(found) if owner >= 0]
        self.rows = np.zeros((len(found), 8))
        self.rows[:, 2] = [light.height for light in lights]
        self.rows[:, 3] = [light.power for light in lights]
        self.rows[:, 6] = [half_cosine(light.cone) for light in lights]
        self.rows[:, 7] = self.owners
        for index in range(len(found)):
            self._put(index)

    def place(self) -> None:
        """Bring the lights to where their carriers are."""
        for index in self._carried:
            self._put(index)

    def _put(self, index: int) -> None:
        pose, owner = self._lights[index].pose, self.owners[index]
        at = self._geometry.poses[owner].tolist() if owner >= 0 else [0.0, 0.0, 0.0]
        if at == self._placed[index]:
            return
        self._placed[index] = at
        x, y, heading = at
        cosine, sine = math.cos(heading), math.sin(heading)
        self.rows[index, :2] = (
            x + cosine * pose.x - sine * pose.y,
            y + sine * pose.x + cosine * pose.y,
        )
        self.rows[index, 4:6] = math.cos(heading + pose.heading), math.sin(heading + pose.heading)


def light_at(
    parts: Parts, sources: Array, place: Place, *, view: View = ANYWHERE, skip: int = NOBODY
) -> float:
    """Lux that reaches a place (x, y, height) from all sources (l, 8), ambient light left out.

    view: from where a meter accepts light; it has no reach. skip: the owner that throws no shadow.
    """
    return float(illuminance(place, view, sources, skip, parts))


@final
class LightMap:
    """The light on the floor, lux, on cells over the bounding box of the arena.

    Attributes:
        xs, ys: (nx,), (ny,) the middles of the cells.
        lux: (ny, nx) as of the last `update`; read it, do not keep or write it.
        worked: cells times sources that the last `update` worked out.
    """

    def __init__(
        self,
        parts: Parts,
        sources: Sources,
        box: tuple[float, float, float, float],
        cells: tuple[int, int],
        ambient: float,
    ) -> None:
        """Lay the map out and fill it; box: least x and y, largest x and y. cells: (nx, ny)."""
        (left, low, right, high), (columns, rows) = box, cells
        self.xs = left + (np.arange(columns, dtype=np.float64) + 0.5) * ((right - left) / columns)
        self.ys = low + (np.arange(rows, dtype=np.float64) + 0.5) * ((high - low) / rows)
        self._parts, self._sources, self._ambient = parts, sources, ambient
        self._by_source = np.zeros((len(sources.rows), rows, columns))
        self._kept = _copy(parts)
        self._lit_from = np.full_like(sources.rows, np.nan)
        self.lux = np.empty((rows, columns))
        self.worked = 0
        self.update()

    def update(self) -> None:
        """Work out anew what may have changed: in the shadows of what moved, old and new.

        The same numbers come out, bit for bit, as from a map made anew.
        """
        self._sources.place()
        parts, sources = self._parts, self._sources.rows
        anew: Booleans = (sources != self._lit_from).any(axis=1)
        changed = self._changed()
        if not (anew.any() or changed.any()):
            self.worked = 0
            if not len(sources):
                self.lux[:] = self._ambient
            return
        self.worked = shine(
            self._by_source, self.xs, self.ys, sources, anew, changed, self._kept, parts
        )
        self._kept.segments[:] = parts.segments
        self._kept.discs[:] = parts.discs
        self._lit_from[:] = sources
        self.lux[:] = self._ambient
        for by_one in self._by_source:
            self.lux += by_one

    def _changed(self) -> Booleans:
        """Which parts (p,) stand elsewhere than at the last update."""
        edges = (self._parts.segments != self._kept.segments).any(axis=1)
        discs = (self._parts.discs != self._kept.discs).any(axis=1)
        rows = self._parts.rows
        changed = np.zeros(len(rows), dtype=np.bool_)
        is_disc = rows[:, 1] == 0
        changed[is_disc] = discs[rows[is_disc, 0]]
        for offset in range(int(rows[:, 1].max(initial=0))):
            has = rows[:, 1] > offset
            changed[has] |= edges[rows[has, 0] + offset]
        return changed


def _copy(parts: Parts) -> Parts:
    return parts._replace(segments=parts.segments.copy(), discs=parts.discs.copy())

"""Rays and lines of sight through a world: what is hit or seen, how far away, and whose it is."""

import math
from typing import NamedTuple, TypeAlias, final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.world.geometry import Geometry
from runtime.world.kernels.parts import Parts
from runtime.world.kernels.rays import cast, nearest_hit, nearest_seen
from runtime.world.kernels.shade import ALL_ROUND

Place: TypeAlias = tuple[float, float, float]
"""Three floats, none of them an int: kernels are compiled for those."""
WIDER = 1.0 + 1e-9
"""Circles around parts are so much larger that rounding loses nothing."""
NOBODY = -1
"""An owner that nothing has."""


@final
class View(NamedTuple):
    """Where an eye looks: a unit direction, the cosine of half its width, and its reach (m)."""

    x: float
    y: float
    cosine: float
    reach: float


def parts_of(geometry: Geometry) -> Parts:
    """The convex parts of a world, in the order of owners; they move along with the geometry."""
    edges = len(geometry.segments)
    owner, part = geometry.owner, geometry.part
    starts = np.flatnonzero(np.diff(part[:edges], prepend=-1))
    counts = np.diff(starts, append=edges)
    rows = [*starts.tolist(), *range(edges, len(owner))]
    table = [
        (row if row < edges else row - edges, count, owner[row])
        for row, count in zip(rows, [*counts.tolist(), *[0] * len(geometry.discs)], strict=True)
    ]
    order = sorted(range(len(rows)), key=lambda index: (owner[rows[index]], part[rows[index]]))
    chosen = np.array([rows[index] for index in order], dtype=np.int64)
    found = [table[index] for index in order]
    circles = [_circle(geometry, first, count) for first, count, _ in found]
    around = [(*row, a, b) for row, (a, b, _) in zip(found, circles, strict=True)]
    return Parts(
        np.array(around, dtype=np.int64).reshape(-1, 5),
        np.array([radius for *_, radius in circles]),
        geometry.low[chosen],
        geometry.high[chosen],
        geometry.transmittance[chosen],
        geometry.segments,
        geometry.discs,
    )


def _circle(geometry: Geometry, first: int, count: int) -> tuple[int, int, float]:
    """Two corners of a part, and the radius of the circle around it from half-way between them.

    The two for which it is least; they stay, as parts are rigid.
    """
    if count == 0:
        return first, first, float(geometry.discs[first, 2]) * WIDER
    edges = geometry.segments[first : first + count]
    corners = np.vstack([edges[:, :2], edges[:, 2:]])
    middles = 0.5 * (edges[:, None, :2] + edges[None, :, 2:])
    away: Array = np.hypot(*np.moveaxis(corners - middles[:, :, None], -1, 0)).max(axis=-1)
    a, b = divmod(int(away.argmin()), count)
    return first + a, first + b, float(away[a, b]) * WIDER


def spread(width: float, count: int) -> Array:
    """Angles (count,) spread evenly over a full `width` around 0.

    The outermost lie on the edges of the width; of a full circle they are no direction twice.
    """
    step = 0.0
    if count > 1:
        step = width / (count if width >= 2.0 * math.pi else count - 1)
    return (np.arange(count, dtype=np.float64) - 0.5 * (count - 1)) * step


def first_hits(
    parts: Parts, rays: Array, *, reach: float, height: float, skip: int
) -> tuple[Array, Integers]:
    """How far rays (n, 4) come at `height`, at most `reach`, and whose it is that they hit.

    skip: the owner that they pass through (`NOBODY`: none). A ray that begins inside something
    has the distance 0; one that hits nothing has the reach, and -1 for the owner.
    """
    return cast(rays, reach, height, skip, parts)


def least_range(
    parts: Parts,
    place: Place,
    turns: Array,
    *,
    reach: float,
    height: float,
    skip: int,
) -> float:
    """The least of `first_hits` from a place (x, y, heading) in directions turned by `turns`."""
    return float(nearest_hit(place, turns, reach, height, skip, parts))


def half_cosine(width: float) -> float:
    """How views and cones of a full angle `width` are told to kernels.

    >>> half_cosine(2 * math.pi)
    -2.0
    """
    return ALL_ROUND if width >= 2.0 * math.pi else math.cos(0.5 * width)


def nearest_visible(
    parts: Parts, eye: Place, view: View, targets: Array, owners: Integers, *, skip: int
) -> tuple[int, float]:
    """Which of the targets (m, 3) an eye (x, y, height) sees nearest, and how far along the floor.

    A target is hidden where anything stands between it and the eye, at the heights of the line
    between them: all but `skip` and the target's own owner. (-1, reach) where it sees none.
    """
    index, distance = nearest_seen(eye, view, targets, owners, skip, parts)
    return int(index), float(distance)

"""Rays and lines of sight through a world: what is hit or seen, how far away, and whose it is."""

import math
from typing import NamedTuple, final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.world.geometry import Geometry
from runtime.world.kernels.parts import Parts
from runtime.world.kernels.rays import cast, nearest_seen
from runtime.world.kernels.shade import ALL_ROUND

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
    return Parts(
        np.array([table[index] for index in order], dtype=np.int64).reshape(-1, 3),
        geometry.low[chosen],
        geometry.high[chosen],
        geometry.transmittance[chosen],
        geometry.segments,
        geometry.discs,
    )


def fan(x: float, y: float, heading: float, width: float, count: int) -> Array:
    """Rays (count, 4), x, y and a unit direction, spread evenly over `width` around `heading`.

    The outermost lie on the edges of the width; of a full circle they are no direction twice.
    """
    step = 0.0
    if count > 1:
        step = width / (count if width >= 2.0 * math.pi else count - 1)
    middle = 0.5 * (count - 1)
    turns = [heading + (index - middle) * step for index in range(count)]
    return np.array([(x, y, math.cos(turn), math.sin(turn)) for turn in turns])


def first_hits(
    parts: Parts, rays: Array, *, reach: float, height: float, skip: int
) -> tuple[Array, Integers]:
    """How far rays (n, 4) come at `height`, at most `reach`, and whose it is that they hit.

    skip: the owner that they pass through (`NOBODY`: none). A ray that begins inside something
    has the distance 0; one that hits nothing has the reach, and -1 for the owner.
    """
    return cast(rays, reach, height, skip, parts)


def half_cosine(width: float) -> float:
    """How views and cones of a full angle `width` are told to kernels.

    >>> half_cosine(2 * math.pi)
    -2.0
    """
    return ALL_ROUND if width >= 2.0 * math.pi else math.cos(0.5 * width)


def nearest_visible(
    parts: Parts, eye: Array, view: View, targets: Array, owners: Integers, *, skip: int
) -> tuple[int, float]:
    """Which of the targets (m, 3) an eye (3,) sees nearest, and how far along the floor.

    A target is hidden where anything stands between it and the eye, at the heights of the line
    between them: all but `skip` and the target's own owner. (-1, reach) where it sees none.
    """
    index, distance = nearest_seen(eye, np.array(view), targets, owners, skip, parts)
    return int(index), float(distance)

"""Whether footprints overlap, and whether one lies within an arena: exact for convex parts."""

import math
from collections.abc import Iterator
from typing import Final, TypeAlias

from compiler.world.shapes import HERE, Corners, placed
from runtime.world.model import Pose, Shape

Part: TypeAlias = tuple[Corners, float]
"""Corners, and by how much the part reaches beyond them: a disc is one corner and its radius."""

TOUCHING: Final = 1e-6
"""Metres: parts that overlap by less only touch."""


def overlap(one: Shape, at: Pose, other: Shape, there: Pose) -> bool:
    """Whether two footprints have floor in common."""
    return any(
        _depth(first, second) > TOUCHING
        for first in _parts(one, at)
        for second in _parts(other, there)
    )


def within(shape: Shape, at: Pose, arena: Corners) -> bool:
    """Whether a footprint lies in the arena, and no wall goes through it."""
    for corners, radius in _parts(shape, at):
        if not all(_inside(corner, arena) for corner in corners):
            return False
        walls = zip(arena, (*arena[1:], arena[0]), strict=True)
        if any(_depth((corners, radius), (wall, 0.0)) > TOUCHING for wall in walls):
            return False
    return True


def overlap_floor(shape: Shape, at: Pose, arena: Corners) -> bool:
    """Whether any of a footprint lies on the floor of the arena.

    A part through which no wall goes is on one side of them, as its middle is.
    """
    walls = tuple(zip(arena, (*arena[1:], arena[0]), strict=True))
    for corners, radius in _parts(shape, at):
        middle = (math.fsum(x for x, _ in corners), math.fsum(y for _, y in corners))
        if _inside((middle[0] / len(corners), middle[1] / len(corners)), arena):
            return True
        if any(_depth((corners, radius), (wall, 0.0)) > TOUCHING for wall in walls):
            return True
    return False


def narrowest(shape: Shape) -> float:
    """The least width (m) of a footprint, over directions a degree apart."""
    parts = tuple(_parts(shape, HERE))
    return min(_width(parts, math.radians(angle)) for angle in range(180))


def _width(parts: tuple[Part, ...], angle: float) -> float:
    cos, sin = math.cos(angle), math.sin(angle)
    along = [(x * cos + y * sin, radius) for corners, radius in parts for x, y in corners]
    return max(at + radius for at, radius in along) - min(at - radius for at, radius in along)


def _parts(shape: Shape, at: Pose) -> Iterator[Part]:
    for disc in shape.discs:
        yield (placed(at, (disc.x, disc.y)),), disc.radius
    for polygon in shape.polygons:
        yield tuple(placed(at, corner) for corner in polygon.vertices), 0.0


def _depth(one: Part, other: Part) -> float:
    """How deep two convex parts overlap; below 0 where an axis parts them (Ericson 2005, 5.2.1).

    Axes: the normals of all edges, and from round ends to the nearest corner of the other.
    """
    depth = math.inf
    for x, y in (*_axes(one, other), *_axes(other, one)):
        a = [x * p + y * q for p, q in one[0]]
        b = [x * p + y * q for p, q in other[0]]
        reach = one[1] + other[1]
        depth = min(depth, max(a) - min(b) + reach, max(b) - min(a) + reach)
    return depth


def _axes(one: Part, other: Part) -> Iterator[tuple[float, float]]:
    corners, radius = one
    for a, b in zip(corners, (*corners[1:], corners[0]), strict=True):
        size = math.hypot(b[0] - a[0], b[1] - a[1])
        if size > 0.0:
            yield (b[1] - a[1]) / size, (a[0] - b[0]) / size
    if len(corners) == 2 or radius > 0.0:
        for a in corners:
            near = min(other[0], key=lambda b: math.hypot(b[0] - a[0], b[1] - a[1]))
            size = math.hypot(near[0] - a[0], near[1] - a[1])
            yield ((near[0] - a[0]) / size, (near[1] - a[1]) / size) if size else (1.0, 0.0)


def _inside(point: tuple[float, float], arena: Corners) -> bool:
    """Whether a point is in a simple polygon: an odd number of edges to its right."""
    x, y = point
    inside = False
    for (ax, ay), (bx, by) in zip(arena, (*arena[1:], arena[0]), strict=True):
        if (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax):
            inside = not inside
    return inside or _on_edge(point, arena)


def _on_edge(point: tuple[float, float], arena: Corners) -> bool:
    return any(
        _depth(((point,), TOUCHING), (wall, 0.0)) > 0.0
        for wall in zip(arena, (*arena[1:], arena[0]), strict=True)
    )

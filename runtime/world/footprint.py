"""Footprints: what is inside one, its area, its centre, and how its weight is spread.

A thing's weight is spread evenly over its footprint; where parts overlap, it counts once.
"""

import math
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.world.model import Disc, Polygon, Pose, Shape

CELLS: Final = 48
"""Cells along the longer side of a footprint, where it is taken as points."""
FEWEST: Final = 12
"""Cells along its shorter side, at least."""
ENOUGH: Final = 400
FINEST: Final = 1000


@final
@dataclass(frozen=True, slots=True)
class Spread:
    """How the weight of a thing lies on the floor, in its own frame.

    x, y: its centre (m). gyration: the mean square distance from it (m²), which times the mass is
    the moment of inertia. arm: the mean distance from it (m), which times the friction of the
    floor on it is the torque that turns it on the spot.
    """

    x: float
    y: float
    gyration: float
    arm: float


def contains(shape: Shape, points: Array) -> Booleans:
    """Which of `points` (n, 2), in the shape's frame, are within it or on its edge."""
    found = np.zeros(len(points), dtype=np.bool_)
    for disc in shape.discs:
        found |= np.hypot(points[:, 0] - disc.x, points[:, 1] - disc.y) <= disc.radius
    for polygon in shape.polygons:
        within = np.ones(len(points), dtype=np.bool_)
        for (x, y), (u, v) in _edges(polygon):
            within &= (u - x) * (points[:, 1] - y) - (v - y) * (points[:, 0] - x) >= 0.0
        found |= within
    return found


def points_of(shape: Shape, across: int = CELLS) -> Array:
    """Points (n, 2) that cover a footprint evenly: the middles of the cells inside it.

    across: cells along the longer side; more where so few are inside that they say little.
    """
    low, high = bounds(shape)
    extent = high - low
    while True:
        # Multiples of six: no middle lies on a border between two or three equal clusters.
        least = np.maximum(across * extent / extent.max(), FEWEST)
        cells = 6 * np.ceil(least / 6.0).astype(np.int64)
        x, y = (low[k] + extent[k] * (np.arange(cells[k]) + 0.5) / cells[k] for k in range(2))
        grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
        inside = grid[contains(shape, grid)]
        if len(inside) >= ENOUGH or across >= FINEST:
            return inside if len(inside) else np.array([(low + high) / 2.0])
        across *= 2


def bounds(shape: Shape) -> tuple[Array, Array]:
    """The least and the largest x and y of a footprint, each (2,)."""
    corners = [corner for polygon in shape.polygons for corner in polygon.vertices]
    for disc in shape.discs:
        corners.append((disc.x - disc.radius, disc.y - disc.radius))
        corners.append((disc.x + disc.radius, disc.y + disc.radius))
    points = np.array(corners, dtype=np.float64)
    return points.min(axis=0), points.max(axis=0)


def spread(shape: Shape) -> Spread:
    """How the weight of a thing of this shape lies on the floor.

    Of a single part exact, but for the arm of a polygon; of a compound by points, within 1 %.
    """
    points = points_of(shape)
    if len(shape.discs) == 1 and not shape.polygons:
        (disc,) = shape.discs
        return Spread(disc.x, disc.y, disc.radius**2 / 2.0, disc.radius * 2.0 / 3.0)
    if len(shape.polygons) == 1 and not shape.discs:
        x, y, gyration = _of_polygon(shape.polygons[0])
    else:
        x, y = points.mean(axis=0).tolist()
        gyration = float(((points - (x, y)) ** 2).sum(axis=1).mean())
    arm = float(np.hypot(points[:, 0] - x, points[:, 1] - y).mean())
    return Spread(x, y, gyration, arm)


def scaled(shape: Shape, factor: float) -> Shape:
    """The same footprint, `factor` times as large about the origin of its frame."""
    return Shape(
        tuple(Disc(d.x * factor, d.y * factor, d.radius * factor) for d in shape.discs),
        tuple(
            Polygon(tuple((x * factor, y * factor) for x, y in polygon.vertices))
            for polygon in shape.polygons
        ),
    )


def in_world(shape: Shape, pose: Pose) -> tuple[Array, Array]:
    """The edges (s, 4) and circles (d, 3) of a footprint that stands at `pose`."""
    cosine, sine = math.cos(pose.heading), math.sin(pose.heading)

    def moved(x: float, y: float) -> tuple[float, float]:
        return pose.x + cosine * x - sine * y, pose.y + sine * x + cosine * y

    edges = [(*moved(*a), *moved(*b)) for p in shape.polygons for a, b in _edges(p)]
    circles = [(*moved(d.x, d.y), d.radius) for d in shape.discs]
    return np.array(edges).reshape(-1, 4), np.array(circles).reshape(-1, 3)


def _edges(polygon: Polygon) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    corners = polygon.vertices
    return list(zip(corners, (*corners[1:], corners[0]), strict=True))


def _of_polygon(polygon: Polygon) -> tuple[float, float, float]:
    """Centre and mean square distance from it: the sum of the triangles to the first corner."""
    (x0, y0), *_ = polygon.vertices
    area = first_x = first_y = second = 0.0
    for (a, b), (c, d) in _edges(polygon):
        x, y, u, v = a - x0, b - y0, c - x0, d - y0
        twice = x * v - u * y
        area += twice / 2.0
        first_x += twice * (x + u) / 6.0
        first_y += twice * (y + v) / 6.0
        second += twice * (x * x + x * u + u * u + y * y + y * v + v * v) / 12.0
    x, y = first_x / area, first_y / area
    return x0 + x, y0 + y, second / area - x * x - y * y

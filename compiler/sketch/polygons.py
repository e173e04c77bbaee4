"""Closed polygons in the frame: what is inside, what crosses, and who sees all of it.

Vertices are (V, 2), in the order in which they are passed, the first not repeated.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array

MEETING: Final = 1e-9
"""Vertices closer than this are one."""
LATTICE: Final = 41
"""Points per axis among which a place that sees a whole curve is sought."""


def area(vertices: Array) -> float:
    """The signed area: positive where the curve turns from the first axis to the second."""
    following = np.roll(vertices, -1, axis=0)
    return float(np.sum(_cross(vertices, following)) / 2.0)


def encloses(vertices: Array, point: Array) -> bool:
    """Whether the point lies inside (winding number)."""
    rays = vertices - point
    following = np.roll(rays, -1, axis=0)
    angles = np.arctan2(_cross(rays, following), np.sum(rays * following, axis=-1))
    return bool(abs(np.sum(angles)) > np.pi)


def distance_to(vertices: Array, point: Array) -> float:
    """How far a point is from the curve."""
    edges = np.roll(vertices, -1, axis=0) - vertices
    along = np.sum((point - vertices) * edges, axis=-1) / np.sum(edges * edges, axis=-1)
    nearest = vertices + np.clip(along, 0.0, 1.0)[:, np.newaxis] * edges
    return float(np.min(np.linalg.norm(nearest - point, axis=-1)))


def distance_to_line(points: Array, point: Array) -> float:
    """How far a point is from the open polyline through points (V, 2)."""
    edges = np.diff(points, axis=0)
    along = np.sum((point - points[:-1]) * edges, axis=-1) / np.sum(edges * edges, axis=-1)
    nearest = points[:-1] + np.clip(along, 0.0, 1.0)[:, np.newaxis] * edges
    return float(np.min(np.linalg.norm(nearest - point, axis=-1)))


def distance_along(vertices: Array, point: Array, way: Array) -> float:
    """How far (in lengths of `way`) the curve is first met from a point; inf where it is not."""
    edges = np.roll(vertices, -1, axis=0) - vertices
    start = vertices - point
    turn = _cross(way, edges)
    meets = turn != 0.0
    safe = np.where(meets, turn, 1.0)
    far, share = _cross(start, edges) / safe, _cross(start, way) / safe
    met = far[meets & (far > 0.0) & (share >= 0.0) & (share <= 1.0)]
    return float(met.min(initial=np.inf))


def repeated(vertices: Array) -> int | None:
    """The first vertex at which the curve passes through an earlier one again; None: none does."""
    for i, vertex in enumerate(vertices):
        if np.any(np.linalg.norm(vertices[:i] - vertex, axis=-1) < MEETING):
            return i
    return None


def crosses_itself(vertices: Array) -> bool:
    """Whether two edges that are no neighbors meet."""
    count = len(vertices)
    return any(
        _meet(vertices[i], vertices[(i + 1) % count], vertices[j], vertices[(j + 1) % count])
        for i in range(count)
        for j in range(i + 2, count)
        if (j + 1) % count != i
    )


def cross_each_other(first: Array, second: Array) -> bool:
    """Whether two curves meet."""
    return any(
        _meet(a, b, c, d)
        for a, b in zip(first, np.roll(first, -1, axis=0), strict=True)
        for c, d in zip(second, np.roll(second, -1, axis=0), strict=True)
    )


def sees_all(vertices: Array, point: Array) -> bool:
    """Whether every ray from the point meets the curve once: the curve is star-shaped about it."""
    return _sight(vertices, point) > 0.0


def viewpoint(curves: list[Array]) -> Array | None:
    """The place that sees all of every curve best; None where no place does.

    The middle of the innermost curve (the last one) is taken if it will do.
    """
    inner = curves[-1]
    middle: Array = inner.mean(axis=0)
    sights = [_sight(curve, middle) for curve in curves]
    if min(sights) > 0.1 * max(_size(inner), 1e-12):
        return middle
    low, high = inner.min(axis=0), inner.max(axis=0)
    axes = [np.linspace(a, b, LATTICE) for a, b in zip(low, high, strict=True)]
    places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    best = np.array([min(_sight(curve, place) for curve in curves) for place in places])
    found: Array = np.asarray(places[int(best.argmax())], dtype=np.float64)
    return found if best.max() > 0.0 else None


def _size(vertices: Array) -> float:
    return float(np.sqrt(abs(area(vertices))))


def _sight(vertices: Array, point: Array) -> float:
    """The least distance from the point to the line of an edge, negative where it sees behind."""
    edges = np.roll(vertices, -1, axis=0) - vertices
    lengths = np.linalg.norm(edges, axis=-1)
    sides = _cross(edges, point - vertices) / np.where(lengths > 0.0, lengths, 1.0)
    return float(np.min(np.sign(area(vertices)) * sides))


def _cross(a: Array, b: Array) -> Array:
    found: Array = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return found


def _meet(a: Array, b: Array, c: Array, d: Array) -> bool:
    """Whether the segments ab and cd meet."""
    if np.any(np.maximum(a, b) < np.minimum(c, d)) or np.any(np.maximum(c, d) < np.minimum(a, b)):
        return False
    first, second = _cross(b - a, c - a), _cross(b - a, d - a)
    third, fourth = _cross(d - c, a - c), _cross(d - c, b - c)
    return bool(first * second <= 0.0 and third * fourth <= 0.0)

"""How deep two footprints stand in one another: separating axes, apart from what the world uses."""

from collections.abc import Sequence
from itertools import combinations
from typing import TypeAlias

import numpy as np

from runtime.arrays import Array
from runtime.world.model import Shape

Part: TypeAlias = tuple[Array, float]
"""Corners (k, 2) of a convex part, and a radius around them: a disc is one corner."""


def parts_at(shape: Shape, pose: Array) -> list[Part]:
    """The convex parts of a footprint that stands at `pose` (x, y, heading)."""
    x, y, heading = pose
    turned = np.array([[np.cos(heading), np.sin(heading)], [-np.sin(heading), np.cos(heading)]])
    discs = [(np.array([[disc.x, disc.y]]), disc.radius) for disc in shape.discs]
    polygons = [(np.array(polygon.vertices), 0.0) for polygon in shape.polygons]
    return [(corners @ turned + (x, y), radius) for corners, radius in (*discs, *polygons)]


def depth(one: Part, other: Part) -> float:
    """The least way (m) that takes two parts apart; negative where they are."""
    (a, r), (b, s) = one, other
    axes = [*_normals(a), *_normals(b)]
    if len(a) == 1 or len(b) == 1:
        gaps = (a[:, None] - b[None]).reshape(-1, 2)
        lengths = np.hypot(*gaps.T)
        axes += [gap / length for gap, length in zip(gaps, lengths, strict=True) if length > 0.0]
    found = np.inf
    for axis in axes:
        along, beside = a @ axis, b @ axis
        shared = min(along.max() - beside.min(), beside.max() - along.min())
        found = min(found, shared + r + s)
    return float(found)


def beyond_walls(part: Part, arena: Array) -> float:
    """How far (m) a part is outside a convex arena, (k, 2) counter-clockwise."""
    corners, radius = part
    along = np.roll(arena, -1, axis=0) - arena
    outward = np.column_stack([along[:, 1], -along[:, 0]]) / np.hypot(*along.T)[:, None]
    return float((np.einsum("ijk,jk->ij", corners[:, None] - arena, outward) + radius).max())


def deepest(shapes: Sequence[Shape], poses: Array, arena: Array) -> float:
    """The deepest that any two footprints, or one and a wall, stand in one another (m)."""
    stood = [parts_at(shape, pose) for shape, pose in zip(shapes, poses, strict=True)]
    pairs = (
        depth(one, other)
        for first, second in combinations(stood, 2)
        for one in first
        for other in second
        if _near(one, other)
    )
    walls = max(beyond_walls(part, arena) for parts in stood for part in parts)
    return max(walls, max(pairs, default=-np.inf))


def _near(one: Part, other: Part) -> bool:
    """Whether boxes along the axes overlap: others need no closer look."""
    (a, r), (b, s) = one, other
    reach = r + s
    return bool(
        (a.min(axis=0) <= b.max(axis=0) + reach).all()
        and (b.min(axis=0) <= a.max(axis=0) + reach).all()
    )


def _normals(corners: Array) -> list[Array]:
    if len(corners) == 1:
        return []
    along = np.roll(corners, -1, axis=0) - corners
    return list(np.column_stack([along[:, 1], -along[:, 0]]) / np.hypot(*along.T)[:, None])

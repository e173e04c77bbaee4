"""Footprints on a floor: outlines of things and robots, and where they stand."""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from runtime.arrays import Array
from runtime.world.model import Shape
from specc.figures.scene import Scene

CORNERS: Final = 40
"""Of a circle that is drawn."""
MOVED: Final = 5e-3
"""Metres, or a share of a radian: what is less is no move."""


def outline(shape: Shape, corners: int = CORNERS) -> list[Array]:
    """The parts of a footprint as closed polygons in its own frame."""
    turn = np.linspace(0.0, math.tau, corners, endpoint=False)
    circles = [
        np.column_stack([d.x + d.radius * np.cos(turn), d.y + d.radius * np.sin(turn)])
        for d in shape.discs
    ]
    return [*circles, *(np.array(polygon.vertices) for polygon in shape.polygons)]


def placed(points: Array, pose: Array) -> Array:
    """Points (k, 2) of a frame that stands at `pose` (x, y, heading), in the world."""
    x, y, heading = pose.tolist()
    c, s = math.cos(heading), math.sin(heading)
    there: Array = points @ np.array([[c, s], [-s, c]]) + (x, y)
    return there


def patch(parts: Sequence[Array], **drawn: object) -> Patch:
    """One patch from several closed polygons."""
    vertices = [np.vstack([part, part[:1]]) for part in parts]
    codes = [[Path.MOVETO, *[Path.LINETO] * (len(part) - 1), Path.CLOSEPOLY] for part in parts]
    path = Path(np.vstack(vertices), np.concatenate(codes))
    drawn_patch: Patch = PathPatch(path, **drawn)
    return drawn_patch


def moved(poses: Array) -> bool:
    """Whether a thing (n, 3) was anywhere else than at its start."""
    off = np.abs(poses - poses[0])
    return bool((off > MOVED).any())


def reach_of(parts: Sequence[Array]) -> float:
    """How far a footprint reaches from its origin."""
    return max(float(np.hypot(part[:, 0], part[:, 1]).max()) for part in parts)


def lamps_at(scene: Scene, things: Array) -> Array:
    """Where lights are (k, 2), the things being at poses (t, 3)."""
    at = [
        placed(np.array([[lamp.x, lamp.y]]), things[lamp.on] if lamp.on >= 0 else np.zeros(3))[0]
        for lamp in scene.lamps
    ]
    return np.array(at).reshape(-1, 2)

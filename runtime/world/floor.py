"""The floor: friction on feet, because one point cannot turn a pushed box as a surface does.

A body that slides on a floor is held at every point of its footprint against that point's own
velocity. A few *feet* with shares of the weight come close (Goyal, Ruina and Papadopoulos 1991 on
limit surfaces): each is a joint that holds its point with a limited force. A joint in the middle
and one on the angle, the usual recipe, is wrong for pushing: it forgets that what turns slides.
"""

import math
from dataclasses import dataclass
from typing import Final, final

import numpy as np
import pymunk

from runtime.arrays import Array, Integers
from runtime.world.chipmunk import feel_evenly
from runtime.world.footprint import Spread, points_of
from runtime.world.model import Shape

GRAVITY: Final = 9.81
FEET: Final = (2, 2)
"""Feet along and across a footprint."""
CELLS: Final = 24
ROUNDS: Final = 100
EVEN: Final = 1e-6
"""The relative difference of widths below which a footprint has no longer axis."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Feet:
    """Where a thing stands: places (k, 2) in its own frame, and shares (k,) of its weight."""

    places: Array
    shares: Array


def feet_of(shape: Shape, spread: Spread, grid: tuple[int, int] = FEET) -> Feet:
    """Feet that hold a footprint as its whole surface would.

    They are the centres of clusters of its points (k-means), begun from a grid along its principal
    axes, so that a symmetric footprint has symmetric feet and chance no part in it. Their mean is
    the centre of mass, and their mean distance from it that of the surface, so that both pure
    motions meet the right resistance. grid: clusters along the longer axis, and across it.
    """
    points = points_of(shape, CELLS)
    points = points - points.mean(axis=0)
    centres = _along_axes(points, grid)
    for _ in range(ROUNDS):
        nearest = _nearest(points, centres)
        moved = np.array([points[nearest == k].mean(axis=0) for k in np.unique(nearest)])
        if np.array_equal(moved, centres):
            break
        centres = moved
    nearest = _nearest(points, centres)
    shares = np.bincount(nearest, minlength=len(centres)) / len(points)
    centres = centres - shares @ centres
    arm = float(shares @ np.hypot(*centres.T))
    even = centres * (spread.arm / arm if arm > 0.0 else 1.0)
    return Feet(even + np.array([spread.x, spread.y]), shares)


def stand(space: pymunk.Space, body: pymunk.Body, feet: Feet, friction: float) -> None:
    """Let a body stand on the floor: `friction` between the two times its weight holds it."""
    force = friction * body.mass * GRAVITY
    if force <= 0.0:
        return
    for (x, y), share in zip(feet.places.tolist(), feet.shares.tolist(), strict=True):
        joint = pymunk.PivotJoint(space.static_body, body, (0.0, 0.0), (x, y))
        joint.max_bias = 0.0
        joint.max_force = force * share
        space.add(joint)
    feel_evenly(body)


def _nearest(points: Array, centres: Array) -> Integers:
    distances = ((points[:, None, :] - centres[None, :, :]) ** 2).sum(axis=2)
    nearest: Integers = distances.argmin(axis=1).astype(np.int64)
    return nearest


def _along_axes(points: Array, grid: tuple[int, int]) -> Array:
    """A grid over the points along their principal axes, as wide as an even spread would be."""
    (xx, xy), (_, yy) = points.T @ points / len(points)
    difference = math.hypot(xx - yy, 2.0 * xy)
    angle = 0.5 * math.atan2(2.0 * xy, xx - yy) if difference > EVEN * (xx + yy) else 0.0
    axes = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    width = np.sqrt(12.0 * ((points @ axes.T) ** 2).mean(axis=0))
    steps = [((np.arange(k) + 0.5) / k - 0.5) * w for k, w in zip(grid, width, strict=True)]
    centres: Array = np.stack(np.meshgrid(*steps, indexing="ij"), axis=-1).reshape(-1, 2) @ axes
    return centres

"""The floor: friction on feet, because one point cannot turn a pushed box as a surface does.

A body that slides on a floor is held at every point of its footprint against that point's own
velocity. A few *feet* with shares of the weight come close (Goyal, Ruina and Papadopoulos 1991 on
limit surfaces): each is a joint that holds its point with a limited force. A joint in the middle
and one on the angle, the usual recipe, is wrong for pushing: it forgets that what turns slides.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np
import pymunk

from runtime.arrays import Array, Integers
from runtime.world.footprint import Spread, points_of
from runtime.world.model import Shape

GRAVITY: Final = 9.81
FEET: Final = 6
"""How many feet a thing stands on: four are enough for a box, random polygons need more."""
ROUNDS: Final = 100


@final
@dataclass(frozen=True, eq=False, slots=True)
class Feet:
    """Where a thing stands: places (k, 2) in its own frame, and shares (k,) of its weight."""

    places: Array
    shares: Array


def feet_of(shape: Shape, spread: Spread, count: int = FEET) -> Feet:
    """Feet that hold a footprint as its whole surface would.

    They are the centres of clusters of its points (k-means, from points far from one another, so
    that chance has no part in it); their mean is the centre of mass, and their mean distance from
    it that of the surface, so that both pure motions meet the right resistance.
    """
    points = points_of(shape)
    points = points - points.mean(axis=0)
    count = min(count, len(points))
    centres = _far_apart(points, count)
    for _ in range(ROUNDS):
        nearest = _nearest(points, centres)
        moved = np.array([points[nearest == k].mean(axis=0) for k in range(count)])
        if np.array_equal(moved, centres):
            break
        centres = moved
    shares = np.bincount(_nearest(points, centres), minlength=count) / len(points)
    centres = centres - shares @ centres
    arm = float(shares @ np.hypot(*centres.T))
    stretched = centres * (spread.arm / arm if arm > 0.0 else 1.0)
    return Feet(stretched + np.array([spread.x, spread.y]), shares)


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


def _nearest(points: Array, centres: Array) -> Integers:
    distances = ((points[:, None, :] - centres[None, :, :]) ** 2).sum(axis=2)
    nearest: Integers = distances.argmin(axis=1).astype(np.int64)
    return nearest


def _far_apart(points: Array, count: int) -> Array:
    """`count` points, each as far from those before it as can be."""
    chosen = [int(np.argmax((points**2).sum(axis=1)))]
    distance = ((points - points[chosen[0]]) ** 2).sum(axis=1)
    while len(chosen) < count:
        chosen.append(int(np.argmax(distance)))
        distance = np.minimum(distance, ((points - points[chosen[-1]]) ** 2).sum(axis=1))
    return points[chosen]

"""A second implementation of pushing, which shares nothing with the physics: quasi-static.

A box on many pressure points, each held by dry friction against its own velocity. A pusher touches
it at one point; of all motions that follow the pusher, the box makes the one whose friction is the
wrench of the contact force (Goyal, Ruina and Papadopoulos 1991): for a force along a fixed
direction this is the least power of friction at a given power of the force, a convex problem. The
force lies within the friction cone of the contact; the box sticks where that is so, else it slides
along the pusher with the force on the edge of the cone (Mason 1986).
"""

import math
from collections.abc import Sequence

import numpy as np
from scipy.optimize import brentq

from runtime.arrays import Array

POINTS = 12
"""Pressure points along each side of the polygon's frame: 144 of a box."""
SMOOTH = 1e-5
"""Below this speed the friction of a point is rounded off, where the push has speed one."""


def pushed(
    corners: Sequence[tuple[float, float]],
    pose: tuple[float, float, float],
    pusher: tuple[float, float],
    radius: float,
    travel: float,
    friction: float,
    steps: int = 1500,
) -> tuple[float, float, float]:
    """Where a thing ends that a disc pushes by moving `travel` along x.

    corners: of a convex polygon, counter-clockwise. pose: of its centre of mass, which is the
    origin of its corners. friction: of the contact.
    """
    outline = np.array(corners, dtype=np.float64)
    support = _points(outline)
    x, y, heading = pose
    px, py = pusher
    guess = np.array([1.0, 0.0, 0.0])
    for _ in range(steps):
        px += travel / steps
        turn = _rotation(heading)
        local = turn.T @ (px - x, py - y)
        nearest = _nearest(outline, local)
        away = turn @ (nearest - local)
        depth = radius - math.hypot(*away)
        if depth <= 0.0:
            continue
        normal = away / math.hypot(*away)
        arm = turn @ nearest
        guess = _motion(support @ turn.T, arm, normal, friction, guess)
        point = guess[:2] + guess[2] * np.array([-arm[1], arm[0]])
        share = depth / float(normal @ point)
        x, y, heading = np.array([x, y, heading]) + share * guess
    return float(x), float(y), float(heading)


def _points(outline: Array) -> Array:
    """Points that cover a polygon evenly: the middles of the cells inside it."""
    low, high = outline.min(axis=0), outline.max(axis=0)
    xs, ys = (low[k] + (high[k] - low[k]) * (np.arange(POINTS) + 0.5) / POINTS for k in (0, 1))
    points = np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2)
    for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        edge, away = b - a, points - a
        points = points[edge[0] * away[:, 1] - edge[1] * away[:, 0] >= 0.0]
    return points - points.mean(axis=0)


def _nearest(outline: Array, place: Array) -> Array:
    """The point of a polygon's edges that is nearest to a place outside."""
    edges = np.roll(outline, -1, axis=0) - outline
    along = ((place - outline) * edges).sum(axis=1) / (edges**2).sum(axis=1)
    points = outline + np.clip(along, 0.0, 1.0)[:, None] * edges
    found: Array = points[((points - place) ** 2).sum(axis=1).argmin()]
    return found


def _motion(support: Array, arm: Array, normal: Array, friction: float, guess: Array) -> Array:
    """The direction in which the box moves (vx, vy, turn) as the pusher moves along x."""
    side = np.array([-normal[1], normal[0]])

    def tried(slope: float, start: Array) -> tuple[Array, float]:
        """The motion for a force in this direction, and how its point slips along the pusher."""
        motion = _least_power(support, arm, normal + slope * side, start)
        point = motion[:2] + motion[2] * np.array([-arm[1], arm[0]])
        return motion, float(side @ point) / float(normal @ point) - side[0] / normal[0]

    motion, slip = tried(-friction, guess)
    if slip >= 0.0 or friction == 0.0:
        return motion
    motion, slip = tried(friction, guess)
    if slip <= 0.0:
        return motion
    # It sticks: the force within the cone for which nothing slips.
    slope = brentq(lambda slope: tried(slope, motion)[1], -friction, friction, xtol=1e-5)
    return tried(slope, motion)[0]


def _least_power(support: Array, arm: Array, force: Array, guess: Array) -> Array:
    """The motion of least friction power among those in which the force has power one."""
    wrench = np.array([force[0], force[1], arm[0] * force[1] - arm[1] * force[0]])
    basis = np.linalg.svd(wrench[None, :])[2][1:].T
    centre = wrench / (wrench @ wrench)
    z = basis.T @ (guess / float(guess @ wrench) - centre)
    for _ in range(50):
        motion = centre + basis @ z
        u = motion[0] - motion[2] * support[:, 1]
        v = motion[1] + motion[2] * support[:, 0]
        speed = np.sqrt(u * u + v * v + SMOOTH**2)
        jacobian = np.stack(
            [
                np.stack([np.ones_like(u), np.zeros_like(u), -support[:, 1]]),
                np.stack([np.zeros_like(u), np.ones_like(u), support[:, 0]]),
            ]
        )
        velocity = np.stack([u, v])
        slope = np.einsum("dkn,dn,n->k", jacobian, velocity, 1.0 / speed)
        bend = np.einsum("dkn,dln,n->kl", jacobian, jacobian, 1.0 / speed)
        pulled = np.einsum("dkn,dn->kn", jacobian, velocity)
        bend -= np.einsum("kn,ln,n->kl", pulled, pulled, speed**-3)
        step = -np.linalg.solve(basis.T @ bend @ basis + 1e-12 * np.eye(2), basis.T @ slope)
        power = speed.sum()
        size = 1.0
        while size > 1e-6:
            motion = centre + basis @ (z + size * step)
            u = motion[0] - motion[2] * support[:, 1]
            v = motion[1] + motion[2] * support[:, 0]
            if np.sqrt(u * u + v * v + SMOOTH**2).sum() <= power:
                break
            size *= 0.5
        z = z + size * step
        if np.abs(size * step).max() < 1e-10:
            break
    return centre + basis @ z


def _rotation(angle: float) -> Array:
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, -sine], [sine, cosine]])

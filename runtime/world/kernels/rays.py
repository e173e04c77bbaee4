"""Rays along the floor and lines of sight, compiled."""

import math

import numpy as np

from runtime.arrays import Array, Integers
from runtime.kernels.cache import inlined
from runtime.world.kernels.cache import kernel
from runtime.world.kernels.parts import Parts, middle, span, stands_between


@inlined
def is_at(height: float, parts: Parts, row: int) -> bool:
    """Whether a part is met at a height; the same rule as of `stands_between`."""
    return bool((parts.low[row] < height or parts.low[row] <= 0.0) and height < parts.high[row])


@kernel
def cast(
    rays: Array, reach: float, height: float, skip: int, parts: Parts
) -> tuple[Array, Integers]:
    """Follow rays (n, 4), x, y and a unit direction, at one height to what they hit first.

    skip: the owner that is not hit. Returns the distances (n,), 0 for a ray that begins inside
    something and `reach` where nothing is nearer, and the owners (n,), -1 for nothing.
    """
    total = len(parts.rows)
    xs, ys, radii = np.empty(total), np.empty(total), np.empty(total)
    there = np.empty(total, dtype=np.int64)
    count = 0
    for row in range(total):
        if parts.rows[row, 2] != skip and is_at(height, parts, row):
            xs[count], ys[count] = middle(parts, row)
            radii[count] = parts.radius[row]
            there[count] = row
            count += 1
    distances, owners = np.full(len(rays), reach), np.full(len(rays), -1)
    room = np.empty(count)
    for ray in range(len(rays)):
        ox, oy, dx, dy = rays[ray, 0], rays[ray, 1], rays[ray, 2], rays[ray, 3]
        # Without branches, so that several circles are looked at with one instruction.
        for k in range(count):
            rx, ry = xs[k] - ox, ys[k] - oy
            room[k] = radii[k] - abs(rx * dy - ry * dx)
        nearest, hit = reach, -1
        for k in range(count):
            if room[k] < 0.0:
                continue
            along = (xs[k] - ox) * dx + (ys[k] - oy) * dy
            if along < -radii[k] or along - radii[k] > nearest:
                continue
            enters, leaves = span(ox, oy, dx, dy, parts, there[k])
            if enters <= leaves and leaves >= 0.0 and enters < nearest:
                nearest, hit = max(enters, 0.0), parts.rows[there[k], 2]
        distances[ray], owners[ray] = nearest, hit
    return distances, owners


@kernel
def nearest_hit(
    place: tuple[float, float, float],
    turns: Array,
    reach: float,
    height: float,
    skip: int,
    parts: Parts,
) -> float:
    """The least distance along rays from a place (x, y, heading), turned by `turns` (n,)."""
    rays = np.empty((len(turns), 4))
    for ray in range(len(turns)):
        rays[ray, 0], rays[ray, 1] = place[0], place[1]
        rays[ray, 2], rays[ray, 3] = (
            math.cos(place[2] + turns[ray]),
            math.sin(place[2] + turns[ray]),
        )
    return float(cast(rays, reach, height, skip, parts)[0].min())


@inlined
def is_hidden(
    eye: tuple[float, float, float],
    way: tuple[float, float, float],
    skip: int,
    target: int,
    parts: Parts,
) -> bool:
    """Whether anything but `skip` and `target` stands between `eye` and `eye + way`."""
    for row in range(len(parts.rows)):
        owner = parts.rows[row, 2]
        if owner not in (skip, target) and stands_between(eye, way, parts, row):
            return True
    return False


@kernel
def nearest_seen(
    eye: tuple[float, float, float],
    view: tuple[float, float, float, float],
    targets: Array,
    owners: Integers,
    skip: int,
    parts: Parts,
) -> tuple[int, float]:
    """The nearest of targets (m, 3) that an eye (x, y, height) sees, and how far it is.

    view: a unit direction, the cosine of half the width (-2: all round), and the reach.
    owners: (m,) whose the targets are; those do not hide them. Distances are along the floor.
    Returns -1 and the reach where none is seen.
    """
    x, y, z = eye
    best, nearest = -1, view[3]
    for row in range(len(targets)):
        dx, dy = targets[row, 0] - x, targets[row, 1] - y
        distance = math.sqrt(dx * dx + dy * dy)
        if distance > nearest or (distance == nearest and best >= 0):
            continue
        if dx * view[0] + dy * view[1] < view[2] * distance:
            continue
        if not is_hidden((x, y, z), (dx, dy, targets[row, 2] - z), skip, owners[row], parts):
            best, nearest = row, distance
    return best, nearest

"""Layout: where scattered things and random robots stand, by the seed.

Places are drawn evenly and kept where they are free (rejection sampling). Each scatter and each
robot draws from a generator of its own; but what is laid later keeps clear of what is there, so a
further scatter may move those after it.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.chance import generator
from runtime.world import footprint
from runtime.world.kernels import nearness
from runtime.world.model import Body, Pose, Scatter, Shape, Thing, World

TRIES: Final = 5_000
"""Places tried before there is said to be no room."""
ROOM: Final = 0.02
"""How far from all else (m) a robot starts whose place is random."""


@final
class NoRoomError(ValueError):
    """There is no room for a thing or a robot.

    Attributes:
        name: what is to be placed.
        origin: where the spec says so, empty for a robot.
    """

    def __init__(self, name: str, origin: str) -> None:
        super().__init__(
            f"there is no room for '{name}': {TRIES:,} places were tried at random, and it stands "
            "too near to something at each; make it smaller, its gap narrower, or the arena larger"
        )
        self.name = name
        self.origin = origin

    def __reduce__(self) -> tuple[type["NoRoomError"], tuple[str, str]]:
        """Made anew in another process, where runs are spread over several."""
        return type(self), (self.name, self.origin)


@final
@dataclass(frozen=True, slots=True)
class Layout:
    """Where all stand at the beginning: declared and scattered things, and the robots."""

    things: tuple[Thing, ...]
    starts: tuple[Pose, ...]


def lay_out(world: World, robots: Sequence[tuple[str, Body, Pose | None]], seed: int) -> Layout:
    """Place scattered things, then the robots whose start is None.

    Raises:
        NoRoomError: there is no room.
    """
    ground = _Ground(world.arena)
    for thing in world.things:
        ground.put(thing.shape, thing.pose, (thing.low, thing.high))
    for _, body, pose in robots:
        if pose is not None:
            ground.put(body.shape, pose, (body.low, body.high))
    scattered = [thing for scatter in world.scattered for thing in _laid(scatter, ground, seed)]
    starts = []
    for name, body, pose in robots:
        where = pose
        if where is None:
            random = generator(seed, "start", name)
            where = ground.found(body.shape, (body.low, body.high), ROOM, None, random)
            if where is None:
                raise NoRoomError(name, "")
            ground.put(body.shape, where, (body.low, body.high))
        starts.append(where)
    return Layout((*world.things, *scattered), tuple(starts))


def _laid(scatter: Scatter, ground: "_Ground", seed: int) -> list[Thing]:
    """The copies of one scatter: their sizes, which are fixed, and where they stand."""
    random = generator(seed, "scatter", scatter.name)
    prototype = scatter.prototype
    fixed = np.zeros(scatter.count, dtype=np.bool_)
    fixed[random.permutation(scatter.count)[: round(scatter.fixed * scatter.count)]] = True
    sizes = random.uniform(*scatter.sizes, scatter.count)
    found = []
    for index, size in enumerate(sizes.tolist()):
        name = f"{scatter.name}_{index + 1}"
        shape = footprint.scaled(prototype.shape, size)
        heights = (prototype.low, prototype.high)
        pose = ground.found(shape, heights, scatter.gap, scatter.area, random)
        if pose is None:
            raise NoRoomError(name, scatter.origin)
        ground.put(shape, pose, heights)
        is_fixed = prototype.is_fixed or bool(fixed[index])
        mass = prototype.mass * size**2
        found.append(
            replace(prototype, name=name, shape=shape, pose=pose, is_fixed=is_fixed, mass=mass)
        )
    return found


@final
class _Ground:
    """An arena with what stands in it so far."""

    def __init__(self, arena: tuple[tuple[float, float], ...]) -> None:
        corners = np.array(arena, dtype=np.float64)
        self._arena = np.hstack([corners, np.roll(corners, -1, axis=0)])
        self._shapes: list[tuple[Shape, Pose, tuple[float, float], float]] = []
        self._edges = self._arena
        self._circles = np.empty((0, 3))
        self._edge_heights = np.tile((-np.inf, np.inf), (len(corners), 1))
        self._circle_heights = np.empty((0, 2))

    def put(self, shape: Shape, pose: Pose, heights: tuple[float, float]) -> None:
        """Note that something stands there."""
        edges, circles = footprint.in_world(shape, pose)
        self._shapes.append((shape, pose, heights, _reach(shape)))
        self._edges = np.vstack([self._edges, edges])
        self._circles = np.vstack([self._circles, circles])
        self._edge_heights = np.vstack([self._edge_heights, np.tile(heights, (len(edges), 1))])
        self._circle_heights = np.vstack(
            [self._circle_heights, np.tile(heights, (len(circles), 1))]
        )

    def found(
        self,
        shape: Shape,
        heights: tuple[float, float],
        gap: float,
        area: tuple[float, float, float, float] | None,
        random: np.random.Generator,
    ) -> Pose | None:
        """A pose, drawn evenly, in which a footprint is at least `gap` from all else; or None."""
        low, high = self._arena[:, :2].min(axis=0), self._arena[:, :2].max(axis=0)
        if area is not None:
            low, high = np.array(area[:2]), np.array(area[2:])
        walls = np.vstack([self._edge_heights, self._circle_heights])
        taken = (walls[:, 0] < heights[1]) & (walls[:, 1] > heights[0])
        for _ in range(TRIES):
            x, y = random.uniform(low, high).tolist()
            pose = Pose(x, y, float(random.uniform(-np.pi, np.pi)))
            edges, circles = footprint.in_world(shape, pose)
            if not _within(self._arena, np.vstack([edges[:, :2], circles[:, :2]])):
                continue
            near = nearness.gap(edges, circles, self._edges, self._circles, taken, np.inf)
            if near > 0.0 and near >= gap and not self._hidden(shape, pose, heights):
                return pose
        return None

    def _hidden(self, shape: Shape, pose: Pose, heights: tuple[float, float]) -> bool:
        """Whether one stands wholly within another: no outlines cross, but they overlap."""
        reach = _reach(shape)
        return any(
            math.hypot(pose.x - where.x, pose.y - where.y) <= reach + other_reach
            and heights[0] < there[1]
            and there[0] < heights[1]
            and (_covers(other, where, shape, pose) or _covers(shape, pose, other, where))
            for other, where, there, other_reach in self._shapes
        )


def _reach(shape: Shape) -> float:
    """How far a point of a footprint is from the origin of its frame."""
    corners = [math.hypot(*corner) for part in shape.polygons for corner in part.vertices]
    return max((*corners, *(math.hypot(d.x, d.y) + d.radius for d in shape.discs)))


def _covers(shape: Shape, pose: Pose, other: Shape, where: Pose) -> bool:
    """Whether a footprint holds a point of a part of another one."""
    edges, circles = footprint.in_world(other, where)
    points = np.vstack([edges[:, :2], circles[:, :2]])
    away = points - (pose.x, pose.y)
    cosine, sine = np.cos(pose.heading), np.sin(pose.heading)
    local = np.stack(
        [cosine * away[:, 0] + sine * away[:, 1], cosine * away[:, 1] - sine * away[:, 0]], axis=1
    )
    return bool(footprint.contains(shape, local).any())


def _within(arena: Array, points: Array) -> bool:
    """Whether points are all inside the walls: rays up cross them an odd number of times."""
    x1, y1, x2, y2 = arena.T[:, :, None]
    x, y = points.T
    spans = (x1 > x) != (x2 > x)
    crossing = y1 + (x - x1) * (y2 - y1) / np.where(spans, x2 - x1, 1.0)
    return bool(((spans & (crossing > y)).sum(axis=0) % 2 == 1).all())

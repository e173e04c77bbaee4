"""What senses see of a world: flat arrays of edges and circles, brought up to date as bodies move.

One *owner* is a thing, a robot, or the walls of the arena: things first (declared, then scattered),
then robots, then the walls. A footprint is a union of convex parts; the edges of a polygon stand
together, counter-clockwise.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.direct_calls import machine_code
from runtime.world.kernels import nearness
from runtime.world.model import Pose, Shape


@final
@dataclass(frozen=True, eq=False, slots=True)
class Geometry:
    """Everything that stands in a world, as arrays; read them at once, never keep or write them.

    names: of the owners. things, robots: how many of each; the walls are the last owner.
    segments: (s, 4) edges x1, y1, x2, y2 in the world. discs: (d, 3) x, y, radius.
    owner, part: (s + d,) segments first, then discs: whose it is, and of which convex part (parts
    are counted through the world; every edge of the arena is a part of its own).
    low, high, transmittance: (s + d,) what its owner fills of the height (m), and the share of
    light that passes; walls are opaque and endless.
    poses: (owners, 3) x, y, heading; of the walls 0.
    moved: (owners,) the number of the step in which it last moved; 0 for one that never did.
    """

    names: tuple[str, ...]
    things: int
    robots: int
    segments: Array
    discs: Array
    owner: Integers
    part: Integers
    low: Array
    high: Array
    transmittance: Array
    poses: Array
    moved: Integers


@final
@dataclass(frozen=True, eq=False, slots=True)
class Outline:
    """The footprint of one owner, in its own frame, and how it stands in the world."""

    name: str
    shape: Shape
    pose: Pose
    low: float
    high: float
    transmittance: float


@final
class Plan:
    """The geometry of a world, moved along with its bodies.

    Attributes:
        geometry: as of the last `place`.
    """

    def __init__(
        self, things: tuple[Outline, ...], robots: tuple[Outline, ...], arena: Array
    ) -> None:
        """Lay the arrays out; arena: (k, 2) corners of the walls, counter-clockwise."""
        outlines = (*things, *robots)
        parts = 0
        edges: list[tuple[float, ...]] = []
        edge_rows: list[tuple[int, int]] = []
        circles: list[tuple[float, ...]] = []
        circle_rows: list[tuple[int, int]] = []
        for owner, outline in enumerate(outlines):
            for polygon in outline.shape.polygons:
                corners = polygon.vertices
                for a, b in zip(corners, (*corners[1:], corners[0]), strict=True):
                    edges.append((*a, *b))
                    edge_rows.append((owner, parts))
                parts += 1
            for disc in outline.shape.discs:
                circles.append((disc.x, disc.y, disc.radius))
                circle_rows.append((owner, parts))
                parts += 1
        walls = np.hstack([arena, np.roll(arena, -1, axis=0)])
        wall_rows = [(len(outlines), parts + index) for index in range(len(walls))]
        rows = np.array([*edge_rows, *wall_rows, *circle_rows], dtype=np.int64).reshape(-1, 2)

        self._edges = np.array(edges, dtype=np.float64).reshape(-1, 4)
        self._circles = np.array(circles, dtype=np.float64).reshape(-1, 3)
        self._first_edges = _first([owner for owner, _ in edge_rows], len(outlines))
        self._first_circles = _first([owner for owner, _ in circle_rows], len(outlines))
        owners = len(outlines) + 1
        whose: Integers = rows[:, 0].copy()
        self.geometry = Geometry(
            names=(*(outline.name for outline in outlines), "walls"),
            things=len(things),
            robots=len(robots),
            segments=np.vstack([np.zeros((len(edges), 4)), walls]),
            discs=self._circles.copy(),
            owner=whose,
            part=rows[:, 1].copy(),
            low=np.array([*(outline.low for outline in outlines), -np.inf])[whose],
            high=np.array([*(outline.high for outline in outlines), np.inf])[whose],
            transmittance=np.array([*(o.transmittance for o in outlines), 0.0])[whose],
            poses=np.zeros((owners, 3)),
            moved=np.zeros(owners, dtype=np.int64),
        )
        # None is there yet: a pose that is no number differs from every other.
        self.geometry.poses[:-1] = np.nan
        self._place: Callable[..., None] | None = None
        started = [(o.pose.x, o.pose.y, o.pose.heading) for o in outlines]
        self.place(np.array(started, dtype=np.float64).reshape(-1, 3), 0)

    def place(self, poses: Array, step: int) -> None:
        """Bring things and robots to where they are after step `step`.

        poses: (owners - 1, 3 or more), of which the first columns are x, y and heading.
        """
        geometry = self.geometry
        given = (
            poses,
            step,
            geometry.poses,
            geometry.moved,
            self._first_edges,
            self._edges,
            geometry.segments,
            self._first_circles,
            self._circles,
            geometry.discs,
        )
        if self._place is None:
            self._place = machine_code(nearness.place, given)
        self._place(*given)

    def outline(self, owner: int) -> tuple[Array, Array]:
        """The edges (s, 4) and circles (d, 3) of a thing or a robot where it is: no copies."""
        edges = slice(self._first_edges[owner], self._first_edges[owner + 1])
        circles = slice(self._first_circles[owner], self._first_circles[owner + 1])
        return self.geometry.segments[edges], self.geometry.discs[circles]


def _first(owners: list[int], count: int) -> Integers:
    """The first row of each owner, of rows that are sorted by owner; then the end."""
    first: Integers = np.searchsorted(owners, np.arange(count + 1)).astype(np.int64)
    return first

"""Random scenes for the senses, and plain answers to what is hit, hidden and lit in them.

The second implementation shares no idea with the kernels: a way is cut where it crosses an outline,
and the middle of each piece is inside or not by counting crossings (even and odd).
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from runtime.arrays import Array
from runtime.world.geometry import Geometry, Outline, Plan
from runtime.world.light import Sources
from runtime.world.model import Disc, Light, Polygon, Pose, Shape

SIDE = 4.0
ARENA = np.array([(0.0, 0.0), (SIDE, 0.0), (SIDE, SIDE), (0.0, SIDE)])
BENT = np.array([(0.0, 0.0), (SIDE, 0.0), (SIDE, SIDE), (2.5, SIDE), (2.5, 2.5), (0.0, 2.5)])
ALL_ROUND = 2.0 * math.pi


def polygon(rng: np.random.Generator, size: float) -> Polygon:
    """A convex polygon: corners on a circle, in a place of its own."""
    count = int(rng.integers(3, 8))
    turns = np.sort(rng.uniform(0.0, 2.0 * math.pi, count))
    x, y = rng.uniform(-0.1, 0.1, 2)
    corners = [(float(x + size * math.cos(t)), float(y + size * math.sin(t))) for t in turns]
    return Polygon(tuple(corners))


def box(length: float, width: float) -> Shape:
    x, y = 0.5 * length, 0.5 * width
    return Shape((), (Polygon(((-x, -y), (x, -y), (x, y), (-x, y))),))


def shape(rng: np.random.Generator) -> Shape:
    """A circle, a polygon, or several that overlap."""
    size = float(rng.uniform(0.05, 0.3))
    disc = Disc(*(float(v) for v in rng.uniform(-0.1, 0.1, 2)), size)
    kind = rng.integers(4)
    if kind == 0:
        return Shape((disc,), ())
    if kind == 1:
        return Shape((disc,), (polygon(rng, size), polygon(rng, 0.7 * size)))
    return Shape((), (polygon(rng, size),))


def pose(rng: np.random.Generator) -> Pose:
    return Pose(*(float(v) for v in (*rng.uniform(0.1, SIDE - 0.1, 2), rng.uniform(-4.0, 4.0))))


def outline(
    name: str,
    form: Shape,
    at: Pose,
    heights: tuple[float, float] = (0.0, 0.3),
    transmittance: float = 0.0,
) -> Outline:
    return Outline(name, form, at, *heights, transmittance)


def random_plan(rng: np.random.Generator, count: int) -> Plan:
    """So many things, some of which hang, some of which let light through; one robot; walls."""
    things = [
        outline(
            f"thing_{index}",
            shape(rng),
            pose(rng),
            (float(rng.choice([0.0, 0.0, rng.uniform(0.05, 0.2)])), float(rng.uniform(0.2, 0.6))),
            float(rng.choice([0.0, 0.0, 0.3, 0.8])),
        )
        for index in range(count)
    ]
    robot = outline("robot", Shape((Disc(0.0, 0.0, 0.12),), ()), pose(rng), (0.0, 0.1))
    return Plan(tuple(things), (robot,), BENT if rng.integers(2) else ARENA)


def plan_of(*things: Outline, robots: tuple[Outline, ...] = ()) -> Plan:
    return Plan(tuple(things), robots, ARENA)


def random_lights(rng: np.random.Generator, count: int, carriers: int) -> tuple[Light, ...]:
    """Some hang, some are carried by things; some shine in a cone."""
    return tuple(
        Light(
            f"light_{index}",
            f"thing_{rng.integers(carriers)}" if carriers and rng.integers(3) == 0 else "",
            pose(rng),
            float(rng.uniform(0.1, 1.0)),
            float(rng.uniform(1.0, 20.0)),
            float(rng.choice([ALL_ROUND, ALL_ROUND, 1.0, 4.0])),
            "",
        )
        for index in range(count)
    )


def lamp(
    x: float, y: float, height: float, power: float, cone: float = ALL_ROUND, heading: float = 0.0
) -> Light:
    return Light("lamp", "", Pose(x, y, heading), height, power, cone, "")


def sources_of(geometry: Geometry, *lights: Light) -> Array:
    return Sources(lights, geometry).rows


def fan(x: float, y: float, heading: float, turns: Array) -> Array:
    """Rays (n, 4), x, y and a unit direction, from one place, turned from `heading`."""
    headings = heading + turns
    places = np.broadcast_to((x, y), (len(turns), 2))
    rays = np.column_stack([places, np.cos(headings), np.sin(headings)])
    return np.ascontiguousarray(rays)


@dataclass(frozen=True)
class Part:
    """A convex part, taken from the flat arrays by plain means."""

    owner: int
    edges: Array
    disc: Array | None
    low: float
    high: float
    transmittance: float

    def cuts(self, a: Array, b: Array) -> list[float]:
        """The shares of the way from a to b at which it crosses the outline."""
        d = b - a
        if self.disc is not None:
            r = a - self.disc[:2]
            roots = np.roots([d @ d, 2.0 * r @ d, r @ r - self.disc[2] ** 2])
            return [float(root.real) for root in roots if abs(root.imag) < 1e-12]
        found = []
        for x1, y1, x2, y2 in self.edges:
            along = np.array([x2 - x1, y2 - y1])
            matrix = np.column_stack([d, -along])
            if abs(np.linalg.det(matrix)) < 1e-15:
                continue
            t, u = np.linalg.solve(matrix, np.array([x1, y1]) - a)
            if 0.0 <= u <= 1.0:
                found.append(float(t))
        return found

    def holds(self, point: Array) -> bool:
        """Whether a point is inside: an odd number of edges is to the right of it."""
        if self.disc is not None:
            return math.hypot(*(point - self.disc[:2])) < self.disc[2]
        crossings = 0
        for x1, y1, x2, y2 in self.edges:
            if (y1 > point[1]) != (y2 > point[1]):
                crossings += point[0] < x1 + (point[1] - y1) / (y2 - y1) * (x2 - x1)
        return crossings % 2 == 1

    def pieces(self, a: Array, b: Array) -> Iterator[tuple[float, float]]:
        """The shares of the way from a to b between which it is inside."""
        cuts = [t for t in self.cuts(a, b) if 0.0 < t < 1.0]
        if len(self.edges) == 1:
            yield from ((t, t) for t in cuts)
            return
        ends = sorted({0.0, *cuts, 1.0})
        for first, last in pairwise(ends):
            if self.holds(a + 0.5 * (first + last) * (b - a)):
                yield first, last


def plain_parts(geometry: Geometry) -> list[Part]:
    edges = len(geometry.segments)
    found = []
    for number in sorted(set(geometry.part.tolist())):
        rows = np.flatnonzero(geometry.part == number)
        row = rows[0]
        disc = geometry.discs[row - edges] if row >= edges else None
        found.append(
            Part(
                int(geometry.owner[row]),
                geometry.segments[rows] if disc is None else np.zeros((0, 4)),
                disc,
                float(geometry.low[row]),
                float(geometry.high[row]),
                float(geometry.transmittance[row]),
            )
        )
    return found


def in_the_way(part: Part, a: Array, b: Array) -> bool:
    """Whether a part stands between two places (x, y, height)."""
    for first, last in part.pieces(a[:2], b[:2]):
        heights = [a[2] + t * (b[2] - a[2]) for t in (first, last)]
        if max(heights) > part.low and min(heights) < part.high:
            return True
    return False


def plain_hit(
    parts: list[Part], ray: Array, reach: float, height: float, skip: int
) -> tuple[float, int]:
    """How far a ray comes, and whose it is that it hits."""
    a, b = ray[:2], ray[:2] + reach * ray[2:]
    best = (reach, -1)
    for part in parts:
        if part.owner != skip and (part.low < height or part.low <= 0.0) and height < part.high:
            starts = [first * reach for first, _ in part.pieces(a, b)]
            best = min(best, (min(starts, default=reach + 1.0), part.owner))
    return best


def plain_lux(
    parts: list[Part], lights: Array, place: Array, skip: int, view: tuple[float, float] | None
) -> float:
    """Lux at a place; view: heading and full width of what is accepted."""
    total = 0.0
    for x, y, height, power, ux, uy, cosine, carrier in lights:
        way = place - np.array([x, y, height])
        distance = float(np.linalg.norm(way))
        flat = math.hypot(way[0], way[1])
        if way[2] >= 0.0 or (flat > 0.0 and (way[0] * ux + way[1] * uy) / flat < cosine):
            continue
        if view is not None:
            bearing = math.remainder(math.atan2(-way[1], -way[0]) - view[0], 2.0 * math.pi)
            if abs(bearing) > 0.5 * view[1]:
                continue
        shading = {
            part.owner: part.transmittance
            for part in parts
            if part.owner not in (skip, int(carrier))
            and in_the_way(part, np.array([x, y, height]), place)
        }
        cosine_of_incidence = -way[2] / distance
        total += power * cosine_of_incidence / distance**2 * math.prod(shading.values())
    return total

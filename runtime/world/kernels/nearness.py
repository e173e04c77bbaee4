"""How far footprints are from one another, and where they are once their owners moved; compiled."""

import math

from runtime.arrays import Array, Booleans, Integers
from runtime.kernels.cache import inlined, part
from runtime.world.kernels.cache import kernel


@inlined
def to_edge(x: float, y: float, edges: Array, row: int) -> float:
    """The squared distance of a point from an edge."""
    ax, ay = edges[row, 0], edges[row, 1]
    dx, dy = edges[row, 2] - ax, edges[row, 3] - ay
    length = dx * dx + dy * dy
    along = 0.0
    if length > 0.0:
        along = min(max(((x - ax) * dx + (y - ay) * dy) / length, 0.0), 1.0)
    away: float = (ax + along * dx - x) ** 2 + (ay + along * dy - y) ** 2
    return away


@inlined
def side(x: float, y: float, edges: Array, row: int) -> float:
    """On which side of an edge a point is: positive to its left."""
    dx, dy = edges[row, 2] - edges[row, 0], edges[row, 3] - edges[row, 1]
    turned: float = dx * (y - edges[row, 1]) - dy * (x - edges[row, 0])
    return turned


@inlined
def apart(low: float, high: float, other_low: float, other_high: float) -> float:
    """How far two intervals are apart; 0 where they overlap."""
    return max(0.0, other_low - high, low - other_high)


@part
def between_edges(a: Array, i: int, b: Array, j: int, least: float) -> float:
    """The lesser of `least` and the squared distance of two edges; 0 where they cross."""
    x = apart(
        min(a[i, 0], a[i, 2]), max(a[i, 0], a[i, 2]), min(b[j, 0], b[j, 2]), max(b[j, 0], b[j, 2])
    )
    y = apart(
        min(a[i, 1], a[i, 3]), max(a[i, 1], a[i, 3]), min(b[j, 1], b[j, 3]), max(b[j, 1], b[j, 3])
    )
    if x * x + y * y >= least:
        return least
    parted = side(a[i, 0], a[i, 1], b, j) * side(a[i, 2], a[i, 3], b, j) > 0.0
    if not parted and side(b[j, 0], b[j, 1], a, i) * side(b[j, 2], b[j, 3], a, i) < 0.0:
        return 0.0
    return min(
        least,
        to_edge(a[i, 0], a[i, 1], b, j),
        to_edge(a[i, 2], a[i, 3], b, j),
        to_edge(b[j, 0], b[j, 1], a, i),
        to_edge(b[j, 2], b[j, 3], a, i),
    )


@part
def from_outline(x: float, y: float, edges: Array, circles: Array) -> float:
    """The distance of a point from the edges and circles of an outline; negative in a circle."""
    least = math.inf
    for i in range(len(edges)):
        least = min(least, math.sqrt(to_edge(x, y, edges, i)))
    for i in range(len(circles)):
        least = min(least, math.hypot(circles[i, 0] - x, circles[i, 1] - y) - circles[i, 2])
    return least


@kernel
def gap(
    edges: Array,
    circles: Array,
    others: Array,
    other_circles: Array,
    taken: Booleans,
    reach: float,
) -> float:
    """The least distance between outlines: 0 where they cross, `reach` where none is nearer.

    edges (s, 4), circles (d, 3) of one footprint; others (t, 4), other_circles (e, 3) of all else,
    of which those count that are `taken` (t + e,). What lies wholly within another is not seen.
    """
    to_others, to_circles = taken[: len(others)], taken[len(others) :]
    least = reach
    for j in range(len(others)):
        if to_others[j]:
            for i in range(len(edges)):
                least = math.sqrt(between_edges(edges, i, others, j, least * least))
            for i in range(len(circles)):
                away = math.sqrt(to_edge(circles[i, 0], circles[i, 1], others, j))
                least = min(least, max(away - circles[i, 2], 0.0))
    for j in range(len(other_circles)):
        if to_circles[j]:
            away = from_outline(other_circles[j, 0], other_circles[j, 1], edges, circles)
            least = min(least, away - other_circles[j, 2])
    return max(least, 0.0)


@kernel
def place(
    wanted: Array,
    step: int,
    poses: Array,
    moved: Integers,
    first_edges: Integers,
    local_edges: Array,
    edges: Array,
    first_circles: Integers,
    local_circles: Array,
    circles: Array,
) -> None:
    """Bring owners to the poses `wanted` (n, 3 or more), and what moved of their rows with them.

    first_edges, first_circles: (n + 1,) the first row of each owner. The rest as in `Geometry`.
    """
    for owner in range(len(wanted)):
        x, y, heading = wanted[owner, 0], wanted[owner, 1], wanted[owner, 2]
        if x == poses[owner, 0] and y == poses[owner, 1] and heading == poses[owner, 2]:
            continue
        poses[owner, 0], poses[owner, 1], poses[owner, 2] = x, y, heading
        moved[owner] = step
        cosine, sine = math.cos(heading), math.sin(heading)
        for row in range(first_edges[owner], first_edges[owner + 1]):
            for end in (0, 2):
                u, v = local_edges[row, end], local_edges[row, end + 1]
                edges[row, end] = x + cosine * u - sine * v
                edges[row, end + 1] = y + sine * u + cosine * v
        for row in range(first_circles[owner], first_circles[owner + 1]):
            u, v = local_circles[row, 0], local_circles[row, 1]
            circles[row, 0] = x + cosine * u - sine * v
            circles[row, 1] = y + sine * u + cosine * v

"""Where a straight line goes through the convex parts that stand in a world.

A line is o + t d, on the floor; o and d are (x, y, height) where heights matter.
"""

import math
from typing import NamedTuple, final

from runtime.arrays import Array, Integers
from runtime.kernels.cache import inlined

NOWHERE = (math.inf, -math.inf)
"""Where a line is that misses."""


@final
class Parts(NamedTuple):
    """The p convex parts of all that stands in a world, in the order of their owners.

    rows: (p, 5) first, count, owner, and two corners: `count` edges from row `first` of `segments`,
    counter-clockwise, or, where `count` is 0, the circle in row `first` of `discs`. One edge alone
    is a wall without thickness.
    radius: (p,) of a circle around it; its middle is half-way between the two corners (edges that
    begin there and end there), or that of the circle.
    low, high, transmittance: (p,). segments: (s, 4). discs: (d, 3).
    """

    rows: Integers
    radius: Array
    low: Array
    high: Array
    transmittance: Array
    segments: Array
    discs: Array


@inlined
def middle(parts: Parts, part: int) -> tuple[float, float]:
    """The middle of the circle around a part."""
    a, b = parts.rows[part, 3], parts.rows[part, 4]
    if parts.rows[part, 1] == 0:
        return parts.discs[a, 0], parts.discs[a, 1]
    return (
        0.5 * (parts.segments[a, 0] + parts.segments[b, 2]),
        0.5 * (parts.segments[a, 1] + parts.segments[b, 3]),
    )


@inlined
def inside_polygon(
    ox: float, oy: float, dx: float, dy: float, segments: Array, first: int, count: int
) -> tuple[float, float]:
    """From which t to which the line is inside a convex polygon (Cyrus and Beck 1978)."""
    enters, leaves = -math.inf, math.inf
    for row in range(first, first + count):
        ex = segments[row, 2] - segments[row, 0]
        ey = segments[row, 3] - segments[row, 1]
        left = ex * (oy - segments[row, 1]) - ey * (ox - segments[row, 0])
        slope = ex * dy - ey * dx
        if slope > 0.0:
            enters = max(enters, -left / slope)
        elif slope < 0.0:
            leaves = min(leaves, -left / slope)
        elif left < 0.0:
            return NOWHERE
        if enters > leaves:
            return NOWHERE
    return enters, leaves


@inlined
def inside_disc(
    ox: float, oy: float, dx: float, dy: float, discs: Array, row: int
) -> tuple[float, float]:
    """From which t to which the line is inside a circle."""
    rx, ry = ox - discs[row, 0], oy - discs[row, 1]
    a = dx * dx + dy * dy
    b = rx * dx + ry * dy
    c = rx * rx + ry * ry - discs[row, 2] * discs[row, 2]
    if a == 0.0:
        return (-math.inf, math.inf) if c <= 0.0 else NOWHERE
    square = b * b - a * c
    if square < 0.0:
        return NOWHERE
    root = math.sqrt(square)
    return (-b - root) / a, (-b + root) / a


@inlined
def across_edge(
    ox: float, oy: float, dx: float, dy: float, segments: Array, row: int
) -> tuple[float, float]:
    """The t at which the line crosses an edge, twice.

    The side of a corner is the same for both edges that share it: no line slips through between.
    """
    ax, ay = segments[row, 0] - ox, segments[row, 1] - oy
    bx, by = segments[row, 2] - ox, segments[row, 3] - oy
    if (dx * ay - dy * ax > 0.0) == (dx * by - dy * bx > 0.0):
        return NOWHERE
    ex, ey = bx - ax, by - ay
    slope = dx * ey - dy * ex
    if slope == 0.0:
        return NOWHERE
    t = (ax * ey - ay * ex) / slope
    return t, t


@inlined
def span(
    ox: float, oy: float, dx: float, dy: float, parts: Parts, part: int
) -> tuple[float, float]:
    """From which t to which the line is inside a part; the first is larger where it misses."""
    first, count = parts.rows[part, 0], parts.rows[part, 1]
    if count == 0:
        return inside_disc(ox, oy, dx, dy, parts.discs, first)
    if count == 1:
        return across_edge(ox, oy, dx, dy, parts.segments, first)
    return inside_polygon(ox, oy, dx, dy, parts.segments, first, count)


@inlined
def stands_between(
    o: tuple[float, float, float], d: tuple[float, float, float], parts: Parts, part: int
) -> bool:
    """Whether a part stands between the places o and o + d in space.

    What is touched from above or below only is not in the way; below what stands on the floor
    nothing passes.
    """
    x, y = middle(parts, part)
    off = (x - o[0]) * d[1] - (y - o[1]) * d[0]
    if off * off > parts.radius[part] * parts.radius[part] * (d[0] * d[0] + d[1] * d[1]):
        return False
    enters, leaves = span(o[0], o[1], d[0], d[1], parts, part)
    if enters > leaves or leaves < 0.0 or enters > 1.0:
        return False
    at_first = o[2] + max(enters, 0.0) * d[2]
    at_last = o[2] + min(leaves, 1.0) * d[2]
    if min(at_first, at_last) >= parts.high[part]:
        return False
    return bool(max(at_first, at_last) > parts.low[part] or parts.low[part] <= 0.0)

"""The light on all cells of a floor, compiled; only where something changed, if nothing else.

Directions around a source are sorted into bins of equal diamond angle. A bin lists the parts that
may shade in its directions, in the order of their owners, each with the squares of the distances
between which its shadow may lie. Lists may hold too much, never too little; what shades is decided
by the same test for all cells, so that a cell's number does not depend on when it was worked out.
"""

import math

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.kernels.cache import inlined, part
from runtime.world.kernels.cache import kernel
from runtime.world.kernels.parts import Parts, stands_between
from runtime.world.kernels.shade import arrives

BINS = 720
NEAR = 1e-9
"""Bounds of shadows are so much wider, relative to distances, that rounding loses nothing."""


@inlined
def bin_of(dx: float, dy: float) -> int:
    """The bin of a direction; counter-clockwise from x."""
    size = abs(dx) + abs(dy)
    if size == 0.0:
        return 0
    diamond = 1.0 - dx / size if dy >= 0.0 else 3.0 + dx / size
    return min(int(diamond * (BINS / 4)), BINS - 1)


@inlined
def bins_between(rx: float, ry: float, lx: float, ly: float) -> tuple[int, int]:
    """First bin and number of bins from a right to a left direction, one more at either end."""
    first = bin_of(rx, ry) - 1
    return first % BINS, (bin_of(lx, ly) + 1 - first) % BINS + 1


@part
def disc_reach(x: float, y: float, discs: Array, row: int) -> tuple[int, int, float, float]:
    """Bins, least and largest distance of a circle, seen from (x, y)."""
    cx, cy, radius = discs[row, 0] - x, discs[row, 1] - y, discs[row, 2]
    square = cx * cx + cy * cy
    distance = math.sqrt(square)
    if distance <= radius * (1.0 + NEAR) + NEAR:
        return 0, BINS, 0.0, distance + radius
    sine = radius / distance
    cosine = math.sqrt(1.0 - sine * sine)
    first, count = bins_between(
        cx * cosine + cy * sine,
        cy * cosine - cx * sine,
        cx * cosine - cy * sine,
        cy * cosine + cx * sine,
    )
    return first, count, distance - radius, distance + radius


@part
def edges_reach(
    x: float, y: float, segments: Array, first: int, count: int
) -> tuple[int, int, float, float]:
    """Bins, least and largest distance of an edge or a polygon, seen from (x, y)."""
    rx, ry = segments[first, 0] - x, segments[first, 1] - y
    lx, ly = rx, ry
    least, largest = math.inf, 0.0
    around = True
    for row in range(first, first + count):
        ax, ay = segments[row, 0] - x, segments[row, 1] - y
        bx, by = segments[row, 2] - x, segments[row, 3] - y
        if rx * by - ry * bx < 0.0:
            rx, ry = bx, by
        if lx * by - ly * bx > 0.0:
            lx, ly = bx, by
        ex, ey = bx - ax, by - ay
        length = ex * ex + ey * ey
        t = min(max(-(ax * ex + ay * ey) / length, 0.0), 1.0)
        px, py = ax + t * ex, ay + t * ey
        least = min(least, px * px + py * py)
        largest = max(largest, ax * ax + ay * ay, bx * bx + by * by)
        if ax * by - ay * bx < -NEAR * length:
            around = False
    least, largest = math.sqrt(least), math.sqrt(largest)
    if around and count > 1:
        return 0, BINS, 0.0, largest
    if least <= NEAR * largest:
        return 0, BINS, 0.0, largest
    start, number = bins_between(rx, ry, lx, ly)
    return start, number, least, largest


@part
def shadow_of(light: Array, parts: Parts, row: int) -> tuple[int, int, float, float]:
    """Bins of a part's shadow on the floor, and squares of the distances it lies between.

    No bins where it throws none: as high above the floor as the light, or higher.
    """
    height = light[2]
    low, high = max(parts.low[row], 0.0), parts.high[row]
    if low >= height:
        return 0, 0, math.inf, -math.inf
    first, count = parts.rows[row, 0], parts.rows[row, 1]
    if count == 0:
        start, number, least, largest = disc_reach(light[0], light[1], parts.discs, first)
    else:
        start, number, least, largest = edges_reach(
            light[0], light[1], parts.segments, first, count
        )
    near = least * height / (height - low) * (1.0 - NEAR)
    far = math.inf
    if high < height:
        far = largest * height / (height - high) * (1.0 + NEAR)
    return start, number, near * near, far * far


@part
def mark(light: Array, parts: Parts, changed: Booleans, near: Array, far: Array) -> None:
    """Widen, in each bin, the distances in which shadows of changed parts may lie."""
    for row in range(len(parts.rows)):
        if changed[row] and parts.rows[row, 2] != int(light[7]):
            start, number, least, largest = shadow_of(light, parts, row)
            for k in range(start, start + number):
                near[k % BINS] = min(near[k % BINS], least)
                far[k % BINS] = max(far[k % BINS], largest)


@part
def sort_into_bins(light: Array, parts: Parts) -> tuple[Integers, Integers, Array]:
    """Where the list of each bin begins (BINS + 1,), all lists, and each part's bounds (p, 2)."""
    total = len(parts.rows)
    reach = np.empty((total, 2), dtype=np.int64)
    bounds = np.empty((total, 2))
    begin = np.zeros(BINS + 1, dtype=np.int64)
    for row in range(total):
        start, number, bounds[row, 0], bounds[row, 1] = shadow_of(light, parts, row)
        if parts.rows[row, 2] == int(light[7]):
            number = 0
        reach[row, 0], reach[row, 1] = start, number
        for k in range(start, start + number):
            begin[k % BINS + 1] += 1
    for k in range(BINS):
        begin[k + 1] += begin[k]
    lists = np.empty(begin[BINS], dtype=np.int64)
    filled = begin[:BINS].copy()
    for row in range(total):
        for k in range(reach[row, 0], reach[row, 0] + reach[row, 1]):
            lists[filled[k % BINS]] = row
            filled[k % BINS] += 1
    return begin, lists, bounds


@inlined
def passes(
    light: Array,
    dx: float,
    dy: float,
    parts: Parts,
    begin: Integers,
    lists: Integers,
    bounds: Array,
    k: int,
) -> float:
    """The share of light that reaches the floor at (dx, dy) from below the source, in bin k."""
    share, before = 1.0, -1
    square = dx * dx + dy * dy
    for index in range(begin[k], begin[k + 1]):
        row = lists[index]
        if parts.rows[row, 2] == before or not bounds[row, 0] <= square <= bounds[row, 1]:
            continue
        if stands_between((light[0], light[1], light[2]), (dx, dy, -light[2]), parts, row):
            share *= parts.transmittance[row]
            before = parts.rows[row, 2]
            if share == 0.0:
                break
    return share


@kernel
def shine(
    by_source: Array,
    xs: Array,
    ys: Array,
    sources: Array,
    anew: Booleans,
    changed: Booleans,
    was: Parts,
    parts: Parts,
) -> int:
    """Bring the light of each source on the floor up to date; by_source (l, ny, nx), lux.

    anew: (l,) sources of which all is worked out. changed: (p,) parts that stood in `was` where
    they no longer stand in `parts`: of the other sources only what lies in a shadow of theirs,
    old or new, is worked out. Returns how many cells of how many sources were.
    """
    worked = 0
    for index in range(len(sources)):
        light = sources[index]
        near = np.full(BINS, 0.0 if anew[index] else math.inf)
        far = np.full(BINS, math.inf if anew[index] else -math.inf)
        if not anew[index]:
            mark(light, was, changed, near, far)
            mark(light, parts, changed, near, far)
            if near.min() == math.inf:
                continue
        begin, lists, bounds = sort_into_bins(light, parts)
        for i in range(len(ys)):
            dy = ys[i] - light[1]
            for j in range(len(xs)):
                dx = xs[j] - light[0]
                k = bin_of(dx, dy)
                if not near[k] <= dx * dx + dy * dy <= far[k]:
                    continue
                lux = arrives(light, dx, dy, light[2])
                if lux > 0.0:
                    lux *= passes(light, dx, dy, parts, begin, lists, bounds, k)
                by_source[index, i, j] = lux
                worked += 1
    return worked

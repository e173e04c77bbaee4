"""The light on all cells of a floor, compiled; only where something changed, if nothing else.

The shadow that a convex part throws on the floor is convex: of all that lies between heights
`low` and `high`, the light from height h meets on its way to the floor what is between the shares
1 - high / h and 1 - low / h of the way. So the shadow ends behind the part's near edges, stretched
by 1 over the second share, before its far edges, stretched by 1 over the first, and between the
two lines from the source that touch it. Each is a half-plane a dx + b dy + c >= 0 around the
source, and on a row of cells a shadow is one interval of columns.

Where a shadow is does not depend on when, or with what else, it is worked out, and shadows are
multiplied in the order of their owners: so a part of the map has the numbers of the whole.
"""

import math
from typing import TypeAlias

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.kernels.cache import inlined, part
from runtime.world.kernels.cache import kernel
from runtime.world.kernels.parts import NOWHERE, Parts
from runtime.world.kernels.shade import arrives

Grid: TypeAlias = tuple[float, float, int]
"""The dx of the first column, the distance of columns, and how many there are."""
Columns: TypeAlias = tuple[int, int]
"""From one column to before another."""
DISC_ROWS = 6
"""Of a circle: two lines that touch it, two chords, and two circles x, y, radius (-1: none)."""


@inlined
def shares_of_way(light: Array, parts: Parts, row: int) -> tuple[float, float]:
    """From which to which share of its way to the floor the light is as high as a part."""
    height = light[2]
    first = 1.0 - parts.high[row] / height if parts.high[row] < height else 0.0
    last = 1.0 - parts.low[row] / height if parts.low[row] > 0.0 else 1.0
    return first, last


@part
def polygon_shadow(
    light: Array, parts: Parts, row: int, near: float, far: float, planes: Array
) -> int:
    """Write the half-planes of the shadow of a polygon or an edge; returns how many they are.

    near, far: the shares of the way at its far end and at its near end.
    """
    first, count = parts.rows[row, 0], parts.rows[row, 1]
    segments = parts.segments
    used, begins, ends = 0, -1, -1
    before = count > 1 and is_front(light, segments, first + count - 1)
    for edge in range(first, first + count):
        ax, ay = segments[edge, 0] - light[0], segments[edge, 1] - light[1]
        ex, ey = segments[edge, 2] - segments[edge, 0], segments[edge, 3] - segments[edge, 1]
        left = ey * ax - ex * ay
        if count == 1 and left > 0.0:
            return wall_shadow(-left, ax + ex, ay + ey, -ex, -ey, planes)
        if count == 1:
            return wall_shadow(left, ax, ay, ex, ey, planes)
        share = far if left < 0.0 else near
        planes[used, 0], planes[used, 1], planes[used, 2] = -share * ey, share * ex, left
        used += 1
        if left < 0.0 and not before:
            begins = edge
        if before and not left < 0.0:
            ends = edge
        before = left < 0.0
    if begins >= 0 and ends < 0:
        ends = first
    if begins >= 0:
        lx, ly = segments[begins, 0] - light[0], segments[begins, 1] - light[1]
        rx, ry = segments[ends, 0] - light[0], segments[ends, 1] - light[1]
        planes[used, 0], planes[used, 1], planes[used, 2] = -ry, rx, 0.0
        planes[used + 1, 0], planes[used + 1, 1], planes[used + 1, 2] = ly, -lx, 0.0
        used += 2
    return used


@inlined
def is_front(light: Array, segments: Array, edge: int) -> bool:
    """Whether a source is on the outer side of an edge."""
    ax, ay = segments[edge, 0] - light[0], segments[edge, 1] - light[1]
    ex, ey = segments[edge, 2] - segments[edge, 0], segments[edge, 3] - segments[edge, 1]
    return bool(ey * ax - ex * ay < 0.0)


@inlined
def wall_shadow(left: float, ax: float, ay: float, ex: float, ey: float, planes: Array) -> int:
    """Write the half-planes of what is behind an edge from a to a + e, a to the left."""
    planes[0, 0], planes[0, 1], planes[0, 2] = -ey, ex, left
    planes[1, 0], planes[1, 1], planes[1, 2] = -(ay + ey), ax + ex, 0.0
    planes[2, 0], planes[2, 1], planes[2, 2] = ay, -ax, 0.0
    if left == 0.0:
        planes[0, 2] = -math.inf
    return 3


@part
def disc_shadow(
    light: Array, discs: Array, row: int, near: float, far: float, planes: Array
) -> int:
    """Write the shadow of a circle: what is between two chords, and the circles at its ends."""
    cx, cy, radius = discs[row, 0] - light[0], discs[row, 1] - light[1], discs[row, 2]
    square = cx * cx + cy * cy - radius * radius
    planes[:DISC_ROWS] = 0.0
    planes[4, 2] = planes[5, 2] = -1.0
    if near > 0.0:
        planes[5, 0], planes[5, 1], planes[5, 2] = cx / near, cy / near, radius / near
    if square <= 0.0:
        # Below the source: the larger circle holds the smaller; without end if it has none.
        planes[0, 2] = -1.0 if near > 0.0 else 0.0
        return DISC_ROWS
    planes[4, 0], planes[4, 1], planes[4, 2] = cx / far, cy / far, radius / far
    # The lines that touch it are directed along c turned by the angle with sine radius / |c|.
    length = math.sqrt(square)
    rx, ry = cx * length + cy * radius, cy * length - cx * radius
    lx, ly = cx * length - cy * radius, cy * length + cx * radius
    planes[0, 0], planes[0, 1] = -ry, rx
    planes[1, 0], planes[1, 1] = ly, -lx
    planes[2, 0], planes[2, 1], planes[2, 2] = far * cx, far * cy, -square
    planes[3, 0], planes[3, 1], planes[3, 2] = -near * cx, -near * cy, square
    return DISC_ROWS


@part
def shadow_of(light: Array, parts: Parts, row: int, planes: Array) -> int:
    """Write a part's shadow on the floor into `planes`; how many rows, 0 where it has none.

    It has none where it carries the source, or is nowhere below it.
    """
    if light[2] <= 0.0:
        return 0
    near, far = shares_of_way(light, parts, row)
    if parts.rows[row, 2] == int(light[7]) or far <= near:
        return 0
    if parts.rows[row, 1] == 0:
        return disc_shadow(light, parts.discs, parts.rows[row, 0], near, far, planes)
    return polygon_shadow(light, parts, row, near, far, planes)


@inlined
def between(planes: Array, first: int, last: int, dy: float) -> tuple[float, float]:
    """From which to which dx all half-planes hold."""
    low, high = -math.inf, math.inf
    for k in range(first, last):
        value = planes[k, 1] * dy + planes[k, 2]
        if planes[k, 0] > 0.0:
            low = max(low, -value / planes[k, 0])
        elif planes[k, 0] < 0.0:
            high = min(high, -value / planes[k, 0])
        elif value < 0.0:
            return NOWHERE
        if low > high:
            return NOWHERE
    return low, high


@inlined
def shaded(planes: Array, first: int, count: int, edges: int, dy: float, grid: Grid) -> Columns:
    """The columns of a row that lie in the shadow of a part with so many edges; 0: a circle."""
    if count == 0:
        return 0, 0
    start, pitch, columns = grid
    low, high = between(planes, first, first + (count if edges else 4), dy)
    if edges == 0:
        for k in range(first + 4, first + DISC_ROWS):
            away, radius = dy - planes[k, 1], planes[k, 2]
            square = radius * radius - away * away
            if radius >= 0.0 and square >= 0.0:
                root = math.sqrt(square)
                low, high = min(low, planes[k, 0] - root), max(high, planes[k, 0] + root)
    if low > high:
        return 0, 0
    begin = math.ceil(min(max((low - start) / pitch, 0.0), float(columns)))
    end = math.floor(min(max((high - start) / pitch, -1.0), columns - 1.0)) + 1
    return begin, end


@part
def widen(
    light: Array,
    parts: Parts,
    changed: Booleans,
    ys: Array,
    grid: Grid,
    limits: Integers,
    planes: Array,
) -> None:
    """Widen `limits` (2, ny), the columns of each row, by the shadows of changed parts."""
    for row in range(len(changed)):
        if changed[row]:
            count = shadow_of(light, parts, row, planes)
            for i in range(len(ys)):
                dy = ys[i] - light[1]
                first, last = shaded(planes, 0, count, parts.rows[row, 1], dy, grid)
                if first < last:
                    limits[0, i] = min(limits[0, i], first)
                    limits[1, i] = max(limits[1, i], last)


@part
def shadows_of(light: Array, parts: Parts) -> tuple[Array, Integers]:
    """The rows of all parts' shadows, and where those of each part begin and end (p + 1,)."""
    total = len(parts.rows)
    first = np.zeros(total + 1, dtype=np.int64)
    planes = np.empty((parts.rows[:, 1].sum() + DISC_ROWS * total, 3))
    for row in range(total):
        count = shadow_of(light, parts, row, planes[first[row] :])
        first[row + 1] = first[row] + count
    return planes, first


@part
def shade_row(
    share: Array,
    covered: Booleans,
    limits: Columns,
    dy: float,
    grid: Grid,
    parts: Parts,
    planes: Array,
    first: Integers,
) -> None:
    """Fill columns of a row with the share of light that reaches the floor."""
    begin, end = limits
    share[begin:end] = 1.0
    total = len(parts.rows)
    for row in range(total):
        owner, count = parts.rows[row, 2], first[row + 1] - first[row]
        is_last = row + 1 == total or parts.rows[row + 1, 2] != owner
        is_only = is_last and (row == 0 or parts.rows[row - 1, 2] != owner)
        low, high = shaded(planes, first[row], count, parts.rows[row, 1], dy, grid)
        low, high = max(low, begin), min(high, end)
        if is_only:
            for j in range(low, high):
                share[j] *= parts.transmittance[row]
            continue
        # Of several parts of one owner only the first in the way counts.
        for j in range(low, high):
            covered[j] = True
        if is_last:
            for j in range(begin, end):
                if covered[j]:
                    share[j] *= parts.transmittance[row]
                    covered[j] = False


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

    xs: at least 2, evenly spaced. anew: (l,) sources of which all is worked out. changed: (p,)
    parts that stood in `was` where they no longer stand in `parts`: of the other sources only
    what lies in a shadow of theirs, old or new, is worked out. Returns how many cells of how many
    sources were.
    """
    worked, columns = 0, len(xs)
    limits = np.empty((2, len(ys)), dtype=np.int64)
    share, covered = np.empty(columns), np.zeros(columns, dtype=np.bool_)
    room = np.empty((parts.rows[:, 1].max() + DISC_ROWS, 3))
    for index in range(len(sources)):
        light = sources[index]
        grid = (xs[0] - light[0], xs[1] - xs[0], columns)
        limits[0], limits[1] = (0, columns) if anew[index] else (columns, 0)
        if not anew[index]:
            widen(light, was, changed, ys, grid, limits, room)
            widen(light, parts, changed, ys, grid, limits, room)
            if limits[1].max() == 0:
                continue
        planes, first = shadows_of(light, parts)
        for i in range(len(ys)):
            begin, end, dy = limits[0, i], limits[1, i], ys[i] - light[1]
            if begin >= end:
                continue
            shade_row(share, covered, (begin, end), dy, grid, parts, planes, first)
            for j in range(begin, end):
                lux = arrives(light, xs[j] - light[0], dy, light[2])
                by_source[index, i, j] = lux * share[j]
            worked += end - begin
    return worked

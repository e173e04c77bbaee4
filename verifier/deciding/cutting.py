"""Convex pieces of a plane, cut along straight lines; lines between mesh points follow curves.

All pieces are cut by all lines that cross them, and each cut of an edge is worked out from the same
end of it, so that neighbours share their corners exactly.
"""

from collections.abc import Sequence
from typing import Final, TypeAlias

import numpy as np

from runtime.arrays import Array

Point: TypeAlias = tuple[float, float]
Polygon: TypeAlias = list[Point]

NEAR: Final = 1e-12
"""A corner so near to a line, as a share of the greatest value there, lies on it."""


def cut(pieces: Sequence[Polygon], line: Array) -> list[Polygon]:
    """The pieces, cut where line[0] + line[1] x + line[2] y is zero."""
    found: list[Polygon] = []
    c, a, b = line.tolist()
    for piece in pieces:
        values = [c + a * x + b * y for x, y in piece]
        found += halves(piece, values)
    return found


def halves(piece: Polygon, values: Sequence[float]) -> list[Polygon]:
    """A convex piece in two where an affine function, with `values` at its corners, is zero."""
    size = max(abs(value) for value in values)
    signs = [0 if abs(v) <= NEAR * size else (1 if v > 0.0 else -1) for v in values]
    if min(signs) >= 0 or max(signs) <= 0:
        return [piece]
    return [_side(piece, values, signs, way) for way in (1, -1)]


def _side(piece: Polygon, values: Sequence[float], signs: Sequence[int], way: int) -> Polygon:
    found: Polygon = []
    for k, point in enumerate(piece):
        after = (k + 1) % len(piece)
        if signs[k] * way >= 0:
            found.append(point)
        if signs[k] * signs[after] < 0:
            found.append(_crossing(point, values[k], piece[after], values[after]))
    return found


def _crossing(p: Point, at_p: float, q: Point, at_q: float) -> Point:
    """Where an affine function is zero on an edge, from whichever end, to the last bit."""
    if q < p:
        p, at_p, q, at_q = q, at_q, p, at_p
    share = at_p / (at_p - at_q)
    return p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])


def area(piece: Polygon) -> float:
    """The area of a polygon, above 0 where its corners run counter-clockwise."""
    x, y = np.array(piece).T
    return float(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def centre(piece: Polygon) -> Point:
    """A point inside a convex piece: the mean of its corners."""
    return (
        sum(x for x, _ in piece) / len(piece),
        sum(y for _, y in piece) / len(piece),
    )

"""The portrait of an arbiter: which rule decides where, over one or two of what it reads.

Where conditions compare sums of what is drawn with numbers, boundaries are lines, and the areas are
exact. Others are followed on a mesh, straight from point to point of it.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Final, final

import numpy as np

from runtime.arbiter import Arbiter, Read
from runtime.arrays import Array
from runtime.machine import evaluate
from runtime.program import Control, Kind, Unit
from verifier.deciding.conditions import Values
from verifier.deciding.cutting import Polygon, centre, cut, halves
from verifier.deciding.features import Feature
from verifier.deciding.outlines import Joined, Line, put_together
from verifier.deciding.rulings import Ruling, boundaries, register_at, rulings_at

MESH: Final = 96
"""Squares along each axis, where boundaries are no lines."""
BAND: Final = 0.46
"""How far the band of a discrete value reaches to either side."""


@final
@dataclass(frozen=True, slots=True)
class Axis:
    """What is drawn along an axis; a discrete one has values, and is their index."""

    name: str
    unit: Unit
    low: float
    high: float
    values: tuple[str, ...]

    @property
    def ends(self) -> tuple[float, float]:
        """Of what is drawn, SI."""
        if self.values:
            return -0.5, len(self.values) - 0.5
        return self.low, self.high

    @property
    def stretches(self) -> tuple[tuple[float, float], ...]:
        """The pieces in which it is drawn: a band for each value, or all of it."""
        if self.values:
            return tuple((k - BAND, k + BAND) for k in range(len(self.values)))
        return ((self.low, self.high),)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Area:
    """Neighbouring points with one ruling. rings: outlines (n, 2), SI. share: of what is drawn."""

    ruling: int
    rings: tuple[Array, ...]
    share: float


@final
@dataclass(frozen=True, eq=False, slots=True)
class Border:
    """Where two rulings meet: points (n, 2), SI."""

    points: Array
    rulings: tuple[int, int]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Plane:
    """What decides where, over `axes` (one or two), everything else held.

    held: SI, by name. rulings: all that there are; areas and borders name them by place. Over one
    axis the second coordinate is 0 to 1 and means nothing. is_exact: whether all boundaries are
    lines; otherwise they are followed on a mesh.
    """

    axes: tuple[Axis, ...]
    held: Mapping[str, float]
    rulings: tuple[Ruling, ...]
    areas: tuple[Area, ...]
    borders: tuple[Border, ...]
    is_exact: bool

    def share_of(self, ruling: int) -> float:
        """The share of what is drawn that has this ruling."""
        return sum(area.share for area in self.areas if area.ruling == ruling)


def axis_of(part: Read | Control) -> Axis:
    """A read or a control as an axis."""
    values = part.values if isinstance(part, Read) and part.kind is Kind.DISCRETE else ()
    return Axis(part.name, part.unit, part.low, part.high, values)


def plane_of(arbiter: Arbiter, axes: Sequence[Axis], held: Values) -> Plane:
    """The portrait over one or two axes; the arbiter decides by rules, layers or weights.

    held: SI, of reads (else the middle of their domains) and controls (else their defaults).
    """
    names = [axis.name for axis in axes]
    base = register_at(arbiter, held)
    drawing = _Drawing(arbiter, tuple(axes), base, boundaries(arbiter, names))
    pieces = list(drawing.pieces())
    found = rulings_at(arbiter, drawing.register(np.array([centre(each) for each in pieces])))
    rulings = tuple(sorted(set(found), key=lambda each: each.places[::-1] or each.choices))
    place = {ruling: k for k, ruling in enumerate(rulings)}
    low, high = drawing.corners
    areas, lines = put_together(pieces, [place[each] for each in found], low, high)
    whole = sum(area.size for area in areas)
    return Plane(
        axes=tuple(axes),
        held=_held(arbiter, names, base),
        rulings=rulings,
        areas=tuple(_area(each, whole) for each in areas),
        borders=tuple(_border(each) for each in lines),
        is_exact=drawing.is_exact,
    )


def _held(arbiter: Arbiter, names: Sequence[str], base: Array) -> dict[str, float]:
    parts = arbiter.register[: len(arbiter.reads) + len(arbiter.controls)]
    where = {name: float(base[arbiter.register.index(name)]) for name in parts}
    return {name: value for name, value in where.items() if name not in names}


def _area(joined: Joined, whole: float) -> Area:
    return Area(joined.sort, joined.rings, joined.size / whole)


def _border(line: Line) -> Border:
    return Border(line.points, (line.left, line.right))


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Drawing:
    """What is drawn: `features` over `axes`, all else at `base` (r,)."""

    arbiter: Arbiter
    axes: tuple[Axis, ...]
    base: Array
    features: tuple[Feature, ...]

    @property
    def is_exact(self) -> bool:
        """Whether all boundaries are lines: what is discrete stands still in its band."""
        moving = {axis.name for axis in self.axes if not axis.values}
        fixed = boundaries(self.arbiter, moving)
        return all(feature.is_affine for feature in fixed)

    @property
    def corners(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The lower left and the upper right one."""
        ends = [*(axis.ends for axis in self.axes), (0.0, 1.0)][:2]
        (x, u), (y, v) = ends
        return (x, y), (u, v)

    def register(self, points: Array) -> Array:
        """The register (..., r) at points (..., 2) of the drawing."""
        found = np.empty((*points.shape[:-1], self.base.size))
        found[...] = self.base
        for k, axis in enumerate(self.axes):
            column = points[..., k]
            value = np.clip(np.rint(column), 0, len(axis.values) - 1) if axis.values else column
            found[..., self.arbiter.register.index(axis.name)] = value
        return found

    def pieces(self) -> Iterator[Polygon]:
        """Convex pieces in each of which one ruling holds."""
        stretches = [*(axis.stretches for axis in self.axes), ((0.0, 1.0),)][:2]
        for (x, u), (y, v) in product(*stretches):
            if self.is_exact:
                yield from self._by_lines([(x, y), (u, y), (u, v), (x, v)])
            else:
                yield from self._by_mesh((x, y), (u, v))

    def _values(self, points: Array) -> Array:
        """The features (..., k) at points (..., 2)."""
        codes = [feature.code for feature in self.features]
        found: Array = evaluate(codes, self.arbiter.register, self.register(points))
        return found

    def _by_lines(self, whole: Polygon) -> list[Polygon]:
        pieces = [whole]
        if not self.features:
            return pieces
        (x, y), (u, _), (_, v) = whole[0], whole[1], whole[3]
        at, across, up = self._values(np.array([whole[0], whole[1], whole[3]]))
        slope, rise = (across - at) / (u - x), (up - at) / (v - y)
        for line in np.column_stack([at - slope * x - rise * y, slope, rise]):
            if np.isfinite(line).all():
                pieces = cut(pieces, line)
        return pieces

    def _by_mesh(self, low: tuple[float, float], high: tuple[float, float]) -> Iterator[Polygon]:
        x, y = (np.linspace(a, b, MESH + 1) for a, b in zip(low, high, strict=True))
        points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
        values = np.nan_to_num(self._values(points), nan=1.0)
        corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        for i, j in product(range(MESH), range(MESH)):
            square = [(i + a, j + b) for a, b in corners]
            for three in ((0, 1, 2), (0, 2, 3)):
                places = [square[k] for k in three]
                triangle = [(float(x[a]), float(y[b])) for a, b in places]
                yield from _crossed(triangle, np.array([values[a, b] for a, b in places]))


def _crossed(triangle: Polygon, values: Array) -> list[Polygon]:
    """A triangle cut by what changes its sign within; values (3, k) at its corners."""
    crossing = np.flatnonzero((values.min(axis=0) < 0.0) & (values.max(axis=0) > 0.0))
    pieces = [triangle]
    for k in crossing.tolist():
        edges = np.array([[1.0, *point] for point in triangle])
        line = np.linalg.solve(edges, values[:, k])
        is_whole = len(pieces) == 1
        pieces = halves(triangle, values[:, k].tolist()) if is_whole else cut(pieces, line)
    return pieces

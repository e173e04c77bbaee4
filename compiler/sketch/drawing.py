"""A sketch as it was read: its numbers as expressions of controls and constants, in SI."""

from dataclasses import dataclass
from typing import Literal, TypeAlias, final

from spec_schema.expressions.rewrite import names_in
from spec_schema.expressions.tree import Expr
from spec_schema.places import Path

Pair: TypeAlias = tuple[Expr, Expr]
"""A place or a vector in the plane of the sketch."""

PointKind: TypeAlias = Literal["attractor", "repeller", "saddle"]


@final
@dataclass(frozen=True, slots=True)
class Orbit:
    """A closed curve.

    times: from each vertex to the next, s; empty where the `period` or the `speed` is given.
    why: empty for what was drawn; else why index theory requires it.
    """

    name: str
    through: tuple[Pair, ...]
    is_polygon: bool
    rounding: float
    attracts: bool
    strength: Expr
    period: Expr | None
    times: tuple[Expr, ...]
    speed: Expr | None
    path: Path
    why: str = ""


@final
@dataclass(frozen=True, slots=True)
class Point:
    """A fixed point. rates: positive, 1/s; of a saddle the way in and the way out.

    directions: vectors of the two rates; None where they are left open.
    why: empty for what was drawn; else why index theory requires it.
    """

    name: str
    kind: PointKind
    at: Pair
    rates: Pair
    directions: tuple[Pair, Pair] | None
    turns: Expr | None
    path: Path
    why: str = ""


@final
@dataclass(frozen=True, slots=True)
class Line:
    """A separatrix through points, with its saddle. rates: along the line to it, and away."""

    name: str
    through: tuple[Pair, ...]
    saddle: Pair | None
    rates: Pair
    path: Path


@final
@dataclass(frozen=True, slots=True)
class Arrow:
    """A vector `go` (per second) at a place."""

    at: Pair
    go: Pair
    path: Path


@final
@dataclass(frozen=True, slots=True)
class Drawing:
    """Everything that a sketch shows over two states."""

    over: tuple[str, str]
    orbits: tuple[Orbit, ...]
    points: tuple[Point, ...]
    lines: tuple[Line, ...]
    arrows: tuple[Arrow, ...]

    @property
    def names(self) -> frozenset[str]:
        """The controls and constants that it reads."""
        exprs: list[Expr | None] = []
        for orbit in self.orbits:
            exprs += [e for pair in orbit.through for e in pair]
            exprs += [orbit.strength, orbit.period, orbit.speed, *orbit.times]
        for point in self.points:
            exprs += [*point.at, *point.rates, point.turns]
            exprs += [e for pair in point.directions or () for e in pair]
        for line in self.lines:
            exprs += [e for pair in line.through for e in pair]
            exprs += [*line.rates, *(line.saddle or ())]
        for arrow in self.arrows:
            exprs += [*arrow.at, *arrow.go]
        return frozenset(name for expr in exprs if expr is not None for name in names_in(expr))

    @property
    def spots(self) -> tuple[tuple[Path, Pair], ...]:
        """Every place that a feature is drawn through, and the path to it."""
        found: list[tuple[Path, Pair]] = []
        for orbit in self.orbits:
            found += [((*orbit.path, "through", i), s) for i, s in enumerate(orbit.through)]
        found += [((*point.path, "at"), point.at) for point in self.points]
        for line in self.lines:
            found += [((*line.path, "through", i), s) for i, s in enumerate(line.through)]
        return tuple(found)

"""Local models: the field that each feature of a sketch wants around it, in the frame.

A model is a sum of parts, each a coefficient of controls (1/s) times a vector of the frame that
depends on the place q alone. N: places; B: parts of a model. `settings` holds the values (N,) of
the controls that places move with.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, Protocol, TypeAlias, final

import numpy as np

from compiler.lower_parts import code_of
from compiler.sketch.frame import Spot
from compiler.sketch.graphs import quarter_turn
from runtime.arrays import Array
from runtime.machine import evaluate
from spec_schema.expressions.tree import Expr

REACH: Final = 1.0
"""Half widths of the frame beyond which a linear field grows no further."""

Settings: TypeAlias = Mapping[str, Array]


class Model(Protocol):
    """The field around one feature."""

    @property
    def coefficients(self) -> tuple[Expr, ...]:
        """What each part is multiplied by, 1/s."""
        ...

    def distance(self, q: Array, settings: Settings) -> Array:
        """How far (N,) places are from the feature; 0 where the model alone holds."""
        ...

    def parts(self, q: Array, settings: Settings) -> Array:
        """The vectors (N, B, 2) of the parts at places (N, 2)."""
        ...


def spot_at(spot: Spot, settings: Settings) -> Array:
    """Where a spot is: (N, 2), or (1, 2) where it stands still."""
    if not spot.controls:
        return spot.at[np.newaxis]
    register = np.stack([settings[name] for name in spot.controls], axis=-1)
    return evaluate([code_of(expr) for expr in spot.exprs], spot.controls, register)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Heading:
    """A direction: that of the vector `to`, or from one spot to another, or square to that."""

    to: Spot
    start: Spot | None = None
    square: bool = False

    @property
    def controls(self) -> tuple[str, ...]:
        """The controls that it turns with."""
        return (*self.to.controls, *(self.start.controls if self.start else ()))

    def at(self, settings: Settings) -> Array:
        """The unit vector (N, 2) or (1, 2)."""
        vector = spot_at(self.to, settings)
        if self.start is not None:
            vector = vector - spot_at(self.start, settings)
        if self.square:
            vector = quarter_turn(vector)
        length: Array = np.linalg.norm(vector, axis=-1, keepdims=True)
        unit: Array = vector / np.where(length > 0.0, length, 1.0)
        return unit


@final
@dataclass(frozen=True, eq=False, slots=True)
class NodeModel:
    """A fixed point with its own linear field, which saturates far away.

    signs: -1 where the direction shrinks, 1 where it grows. headings: of the two rates; None for
    a field that is the same in all directions, with one rate, and turning where `turns` says so.
    """

    spot: Spot
    signs: tuple[float, float]
    rates: tuple[Expr, Expr]
    headings: tuple[Heading, Heading] | None
    turns: Expr | None = None

    @property
    def coefficients(self) -> tuple[Expr, ...]:
        """The rates, or the one rate and the turning."""
        if self.headings is not None:
            return self.rates
        return self.rates[:1] if self.turns is None else (self.rates[0], self.turns)

    def distance(self, q: Array, settings: Settings) -> Array:
        """The distance in the frame."""
        apart: Array = np.linalg.norm(q - spot_at(self.spot, settings), axis=-1)
        return apart

    def parts(self, q: Array, settings: Settings) -> Array:
        """Linear near the point: exactly its rates and directions."""
        y = q - spot_at(self.spot, settings)
        if self.headings is None:
            level = y / np.sqrt(1.0 + np.sum(y * y, axis=-1, keepdims=True) / REACH**2)
            found = [self.signs[0] * level]
            if self.turns is not None:
                found.append(quarter_turn(level))
            return np.stack(found, axis=1)
        first, second = (heading.at(settings) for heading in self.headings)
        square = cross(first, second)
        along = (cross(y, second) / square, cross(first, y) / square)
        vectors = [
            sign * saturated(a)[:, np.newaxis] * direction
            for sign, a, direction in zip(self.signs, along, (first, second), strict=True)
        ]
        return np.stack(vectors, axis=1)


@final
@dataclass(frozen=True, eq=False, slots=True)
class FarModel:
    """The field far from all features: inward (sign -1) or outward, along each axis by itself."""

    rate: Expr
    sign: float
    away: float

    @property
    def coefficients(self) -> tuple[Expr, ...]:
        """The rate."""
        return (self.rate,)

    def distance(self, q: Array, settings: Settings) -> Array:
        """The same everywhere: it holds where everything else is further."""
        del settings
        return np.full(len(q), self.away)

    def parts(self, q: Array, settings: Settings) -> Array:
        """Towards the middle of the frame, or away from it."""
        del settings
        return (self.sign * saturated(q))[:, np.newaxis]


@final
@dataclass(frozen=True, eq=False, slots=True)
class ArrowModel:
    """A vector that holds where its arrow stands. go: (2,) axis by axis, per second."""

    spot: Spot
    go: tuple[Expr, Expr]

    @property
    def coefficients(self) -> tuple[Expr, ...]:
        """The two components."""
        return self.go

    def distance(self, q: Array, settings: Settings) -> Array:
        """The distance in the frame."""
        apart: Array = np.linalg.norm(q - spot_at(self.spot, settings), axis=-1)
        return apart

    def parts(self, q: Array, settings: Settings) -> Array:
        """The same vector everywhere."""
        del settings
        return np.broadcast_to(np.eye(2), (len(q), 2, 2))


def saturated(x: Array) -> Array:
    """`x` near 0, and never more than `REACH`."""
    return x / np.sqrt(1.0 + (x / REACH) ** 2)


def cross(a: Array, b: Array) -> Array:
    """The signed area (...) that two vectors (..., 2) span."""
    area: Array = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return area

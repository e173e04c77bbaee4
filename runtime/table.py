"""Tables: interpolation coefficients over regular grids; a field is made of them."""

from dataclasses import dataclass
from enum import StrEnum
from typing import final

from runtime.arrays import Array


@final
class Method(StrEnum):
    """How a table is interpolated between its nodes."""

    LINEAR = "linear"
    CUBIC = "cubic"


@final
@dataclass(frozen=True, slots=True)
class Axis:
    """One axis of a table: `count` evenly spaced nodes over [low, high].

    A periodic axis has its nodes at `low + i * (high - low) / count`, i = 0 .. count - 1; the
    value at `high` is that at `low`.
    """

    name: str
    low: float
    high: float
    count: int
    periodic: bool

    @property
    def step(self) -> float:
        """The distance between two nodes."""
        return (self.high - self.low) / (self.count if self.periodic else self.count - 1)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Table:
    """Interpolation coefficients over a regular grid, vector-valued.

    coefficients: (k1, ..., kd, m), m columns that share index and weights. What k is per axis
    (n nodes): linear n, or n + 1 where periodic; cubic (uniform B-spline) n + 2, or n + 3 where
    periodic, the first ones repeated at the end. `runtime.interpolation` makes and reads them.
    """

    axes: tuple[Axis, ...]
    method: Method
    coefficients: Array

"""What a phase portrait consists of, as numbers.

All in SI. m is the number of axes of the portrait (1 or 2); points are (..., m) in their order.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import final

from runtime.arrays import Array
from runtime.program import Unit


@final
class PointKind(StrEnum):
    """The types of fixed points: of flows by the signs of Re(λ), of maps by |λ| against 1."""

    STABLE_NODE = "stable node"
    UNSTABLE_NODE = "unstable node"
    STABLE_FOCUS = "stable focus"
    UNSTABLE_FOCUS = "unstable focus"
    SADDLE = "saddle"
    CENTER = "center"
    DEGENERATE = "degenerate"


@final
@dataclass(frozen=True, slots=True)
class AxisRange:
    """One axis of a portrait: the whole domain of a state variable."""

    name: str
    unit: Unit
    low: float
    high: float
    periodic: bool

    @property
    def width(self) -> float:
        """The length of the domain."""
        return self.high - self.low


@final
@dataclass(frozen=True, slots=True)
class Held:
    """A variable that the portrait holds still; `label` is the name of a discrete value."""

    name: str
    unit: Unit
    value: float
    label: str


@final
@dataclass(frozen=True, eq=False, slots=True)
class FixedPoint:
    """A point where nothing on the axes moves.

    eigenvalues, vectors: (m,) and (m, m), columns, of the slice's Jacobian there: rates in 1/s,
    multipliers per step for a map. Empty where the field has no derivative.
    formula_eigenvalues: the same of the spec's own formula, None where the field has none.
    drifts: names of driven variables that are held although they would move here: the point is
    fixed in this slice only.
    """

    at: Array
    kind: PointKind
    eigenvalues: tuple[complex, ...]
    vectors: tuple[tuple[complex, ...], ...]
    formula_eigenvalues: tuple[complex, ...] | None
    drifts: tuple[str, ...]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Nullcline:
    """Where the rate of the variable `of` is zero: polylines, each (k, 2)."""

    of: str
    lines: tuple[Array, ...]


@final
class Course(StrEnum):
    """Why a trajectory is in the portrait."""

    SEED = "seed"
    STABLE_MANIFOLD = "stable manifold"
    UNSTABLE_MANIFOLD = "unstable manifold"


@final
@dataclass(frozen=True, eq=False, slots=True)
class Trajectory:
    """A path `points` (T, m) at `times` (T,), in the direction of time.

    A periodic axis is unwrapped: values may leave the domain by whole periods. `start` is the
    index of the point from which it was followed, forward and backward.
    """

    course: Course
    times: Array
    points: Array
    start: int


@final
@dataclass(frozen=True, eq=False, slots=True)
class Grid:
    """The field on a regular grid: `nodes` one array an axis, `rates` (n1, ..., nm, m).

    For a map `rates` are the displacements `next - x` of one step. NaN outside the domain.
    """

    nodes: tuple[Array, ...]
    rates: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class Portrait:
    """The phase portrait of one slice of a behavior.

    every: the seconds of a map's step, 0 for a flow. notes: sentences on what the numbers do
    not show.
    """

    name: str
    about: str
    axes: tuple[AxisRange, ...]
    held: tuple[Held, ...]
    every: float
    field: Grid
    nullclines: tuple[Nullcline, ...]
    fixed_points: tuple[FixedPoint, ...]
    trajectories: tuple[Trajectory, ...]
    notes: tuple[str, ...]

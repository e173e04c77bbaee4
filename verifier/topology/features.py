"""What a phase portrait consists of, as numbers.

All in SI. m is the number of axes of the portrait (1 or 2); points are (..., m) in their order.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias, final

from runtime.arrays import Array, Integers
from runtime.program import Unit

Settings: TypeAlias = tuple[tuple[str, float], ...]
"""Controls and held states at values, SI; what is not named has its default."""


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

    def shortest(self, difference: float) -> float:
        """A difference of two values, the short way round where the axis is periodic."""
        turns = round(difference / self.width) if self.periodic else 0
        return difference - self.width * turns


@final
@dataclass(frozen=True, slots=True)
class Held:
    """A variable that the portrait holds still; `label` is the name of a discrete value."""

    name: str
    unit: Unit
    value: float
    label: str


@final
class Standing(StrEnum):
    """What a fixed point of the tables is to the field that they were made from."""

    SHARED = "shared"
    INVENTED = "invented by the interpolation"
    UNCOMPARED = "not compared"


@final
@dataclass(frozen=True, eq=False, slots=True)
class FixedPoint:
    """A point where nothing on the axes moves.

    eigenvalues, vectors: (m,) and (m, m), columns, of the slice's Jacobian there: rates in 1/s,
    multipliers per step for a map. Empty where the field has no derivative.
    formula_eigenvalues: the same of the spec's own formula, None where the field has none.
    drifts: names of driven variables that are held although they would move here: the point is
    fixed in this slice only.
    proved: by interval arithmetic, exactly one zero lies within `radius` (m,) of `at`.
    kind_proved: and no eigenvalue of it can be on the other side of the stability boundary.
    standing: whether the formula has a zero there, too; UNCOMPARED where there is none to compare
    with, or where the field runs on its formula.
    """

    at: Array
    kind: PointKind
    eigenvalues: tuple[complex, ...]
    vectors: tuple[tuple[complex, ...], ...]
    formula_eigenvalues: tuple[complex, ...] | None
    drifts: tuple[str, ...]
    proved: bool
    kind_proved: bool
    radius: Array
    standing: Standing


@final
@dataclass(frozen=True, eq=False, slots=True)
class UndecidedBox:
    """A box (low and high corner, (m,)) in which zeros could neither be proved nor excluded."""

    low: Array
    high: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class Completeness:
    """What the proof says of the whole slice.

    complete: every zero is in the list, and nothing is undecided. undecided: boxes that may hold
    zeros (degenerate ones, curves of them); they cover every zero that is not proved.
    lost: zeros (k, m) of the formula that the tables lack. about: what the proof speaks of, "the
    tables" or "the formula"; empty where nothing was proved. still: names of axes along which
    nothing moves, so that the undecided boxes are filled with fixed points.
    """

    complete: bool
    undecided: tuple[UndecidedBox, ...]
    lost: Array
    about: str
    still: tuple[str, ...] = ()


@final
class Stability(StrEnum):
    """Of a cycle, by its multipliers; of a planar one that attracts from one side only, too."""

    STABLE = "stable"
    UNSTABLE = "unstable"
    SADDLE = "saddle"
    SEMI_STABLE = "semi-stable"
    NEUTRAL = "neutral"


@final
@dataclass(frozen=True, eq=False, slots=True)
class Cycle:
    """A closed trajectory: limit cycle of a flow, periodic orbit of a map or of a hybrid flow.

    times, points: (T,), (T, m) over one period, the last point is the first one again (on a
    periodic axis: turned by `turns` whole periods). Of a map: one point a step.
    period: s. multipliers: of Floquet, without the trivial 1; cross_checked: those of a second
    method, in the same order. doubtful: the two disagree by more than their tolerance.
    turns: (m,) how often it goes round each periodic axis. modes: (T,) the index of the mode at
    each point, empty without modes.
    """

    times: Array
    points: Array
    period: float
    stability: Stability
    multipliers: tuple[complex, ...]
    cross_checked: tuple[complex, ...]
    doubtful: bool
    turns: tuple[int, ...]
    modes: tuple[int, ...]

    @property
    def is_attracting(self) -> bool:
        """Whether everything near it comes closer."""
        return self.stability is Stability.STABLE


@final
class Reaches(StrEnum):
    """Where a branch of a manifold goes to or comes from."""

    EDGE = "the edge of the domain"
    POINT = "a fixed point"
    ITSELF = "its own saddle"
    CYCLE = "a cycle"
    NOWHERE_SEEN = "not followed to its end"


@final
@dataclass(frozen=True, eq=False, slots=True)
class Separatrix:
    """A branch of the stable or unstable manifold of a saddle, in the direction of time.

    saddle: index into the portrait's fixed points. reaches, to: what its other end is (its
    beginning, for a stable manifold), and which: an index into the fixed points or cycles, -1 for
    the edge. A branch from saddle to saddle is heteroclinic, back to its own homoclinic.
    """

    saddle: int
    stable: bool
    reaches: Reaches
    to: int
    times: Array
    points: Array


@final
@dataclass(frozen=True, slots=True)
class Attractor:
    """An attractor of the portrait: `is_cycle` and `index` say which; `share` of its basin.

    within: how far the share may be off, as a share: half of the cells along the basin's border.
    """

    is_cycle: bool
    index: int
    share: float
    within: float = 0.0


@final
@dataclass(frozen=True, eq=False, slots=True)
class Basins:
    """Which attractor each place goes to.

    centres: per axis, of the cells. labels: (n1, ..., nm) index into `attractors`, -1 where the
    domain is left, -2 where it was not followed to an end. leaves, open: shares of those two, and
    how far these may be off.
    """

    centres: tuple[Array, ...]
    labels: Integers
    attractors: tuple[Attractor, ...]
    leaves: float
    open: float
    leaves_within: float = 0.0
    open_within: float = 0.0


@final
@dataclass(frozen=True, eq=False, slots=True)
class Switching:
    """Where a mode is left, and for which: polylines (k, 2) of a guard's zero.

    On one axis points, each (1, 1).
    """

    mode: str
    target: str
    lines: tuple[Array, ...]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Nullcline:
    """Where the rate of the variable `of` is zero: polylines, each (k, 2)."""

    of: str
    lines: tuple[Array, ...]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Trajectory:
    """A path `points` (T, m) at `times` (T,), in the direction of time.

    A periodic axis is unwrapped: values may leave the domain by whole periods. `start` is the
    index of the point from which it was followed, forward and backward.
    """

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

    every: the seconds of a map's step, 0 for a flow. basins: None where nothing attracts, or where
    nobody asked. switching: the guards of the mode that is shown. notes: sentences on what the
    numbers do not show. rests: places (m,) that trajectories come to that switch without end.
    """

    name: str
    about: str
    axes: tuple[AxisRange, ...]
    held: tuple[Held, ...]
    every: float
    field: Grid
    nullclines: tuple[Nullcline, ...]
    fixed_points: tuple[FixedPoint, ...]
    completeness: Completeness
    cycles: tuple[Cycle, ...]
    separatrices: tuple[Separatrix, ...]
    basins: Basins | None
    switching: tuple[Switching, ...]
    trajectories: tuple[Trajectory, ...]
    notes: tuple[str, ...]
    rests: tuple[Array, ...] = ()

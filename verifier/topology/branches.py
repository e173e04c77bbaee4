"""Fixed points and cycles against one control: what a bifurcation diagram shows, as numbers.

All in SI. k: samples along a branch; m: axes of the slice. `continuation` makes them.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import final

from runtime.arrays import Array
from verifier.topology.features import AxisRange, Held, PointKind, Stability


@final
@dataclass(frozen=True, eq=False, slots=True)
class PointBranch:
    """A fixed point along the control: `values` (k,), monotone or folded, `points` (k, m)."""

    values: Array
    points: Array
    kinds: tuple[PointKind, ...]


@final
@dataclass(frozen=True, eq=False, slots=True)
class CycleBranch:
    """A cycle along the control: its lowest and highest coordinates (k, m), its period (k,), s."""

    values: Array
    low: Array
    high: Array
    periods: Array
    stabilities: tuple[Stability, ...]


@final
class BifurcationKind(StrEnum):
    """What happens where the portrait changes its topology."""

    SADDLE_NODE = "saddle-node"
    HOPF = "Hopf"
    PERIOD_DOUBLING = "period doubling"
    CYCLE_FOLD = "fold of cycles"
    OTHER = "change of type"


@final
@dataclass(frozen=True, eq=False, slots=True)
class Bifurcation:
    """A change of topology at `value` of the control, to within `within`.

    at: (m,) where it happens; empty where it is not one point. sentence: what changes into what.
    """

    value: float
    within: float
    kind: BifurcationKind
    at: Array
    sentence: str


@final
@dataclass(frozen=True, eq=False, slots=True)
class Branches:
    """One slice of a behavior, all along one control.

    control: the stretch of the control that was looked at. held: everything else that stands
    still. every: the seconds of a map's step, 0 for a flow.
    """

    name: str
    about: str
    control: AxisRange
    axes: tuple[AxisRange, ...]
    held: tuple[Held, ...]
    every: float
    points: tuple[PointBranch, ...]
    cycles: tuple[CycleBranch, ...]
    bifurcations: tuple[Bifurcation, ...]
    notes: tuple[str, ...]

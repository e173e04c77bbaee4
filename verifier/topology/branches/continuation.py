"""Fixed points and cycles against one control: branches, and the bifurcations between them.

All in SI. K: samples of a branch, in the order of the control; m: number of axes.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import final

from runtime.arrays import Array
from runtime.program import Unit
from verifier.topology.features import AxisRange, Held, PointKind, Stability


@final
class Change(StrEnum):
    """What happens at a bifurcation (Strogatz 2015, chapters 3, 8 and 10)."""

    SADDLE_NODE = "saddle-node"
    PITCHFORK = "pitchfork"
    TRANSCRITICAL = "transcritical"
    HOPF = "Hopf"
    PERIOD_DOUBLING = "period-doubling"
    CYCLES_MEET = "saddle-node of cycles"
    CYCLE_ENDS = "end of a cycle"
    LEAVES = "crossing of the domain's edge"
    OTHER = "change"
    TYPE = "change of type"


@final
@dataclass(frozen=True, eq=False, slots=True)
class PointBranch:
    """A branch of fixed points: (K,) values of the control, (K, m) places, K types."""

    values: Array
    points: Array
    kinds: tuple[PointKind, ...]


@final
@dataclass(frozen=True, eq=False, slots=True)
class CycleBranch:
    """A branch of cycles: how far each swings on every axis, (K, m), its period (K,) in s."""

    values: Array
    lows: Array
    highs: Array
    periods: Array
    stabilities: tuple[Stability, ...]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Bifurcation:
    """Where the portrait changes: at `value`, known to `within`, near `at` (m,).

    about: a sentence, as `a saddle and a stable node meet`.
    """

    change: Change
    value: float
    within: float
    at: Array
    about: str


@final
@dataclass(frozen=True, eq=False, slots=True)
class Branches:
    """The bifurcation diagram of a behavior against one control, everything else held.

    control, unit, low, high: the abscissa. values: (S,) where portraits were made; branches have
    further samples where something changes. retypings: no bifurcations, but a focus becomes a node
    or the other way round. notes: what the numbers do not show.
    """

    name: str
    about: str
    control: str
    unit: Unit
    low: float
    high: float
    axes: tuple[AxisRange, ...]
    held: tuple[Held, ...]
    values: Array
    points: tuple[PointBranch, ...]
    cycles: tuple[CycleBranch, ...]
    bifurcations: tuple[Bifurcation, ...]
    notes: tuple[str, ...]
    retypings: tuple[Bifurcation, ...] = ()

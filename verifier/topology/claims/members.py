"""Which features of a portrait a claim speaks of: type, place, reach and period."""

from dataclasses import dataclass
from enum import IntEnum
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arrays import Array
from runtime.claim import Claim
from runtime.code import Code
from runtime.machine import evaluate
from runtime.program import Program
from verifier.topology.features import (
    AxisRange,
    Cycle,
    FixedPoint,
    PointKind,
    Portrait,
    Settings,
    Stability,
)
from verifier.topology.words import shown

STABLE_POINTS: Final = frozenset({PointKind.STABLE_NODE, PointKind.STABLE_FOCUS})
UNSTABLE_POINTS: Final = frozenset({PointKind.UNSTABLE_NODE, PointKind.UNSTABLE_FOCUS})

POINTS: Final[dict[str, frozenset[PointKind]]] = {
    "fixed point": frozenset(PointKind),
    "stable fixed point": STABLE_POINTS,
    "unstable fixed point": UNSTABLE_POINTS | {PointKind.SADDLE},
    "node": frozenset({PointKind.STABLE_NODE, PointKind.UNSTABLE_NODE}),
    "stable node": frozenset({PointKind.STABLE_NODE}),
    "unstable node": frozenset({PointKind.UNSTABLE_NODE}),
    "focus": frozenset({PointKind.STABLE_FOCUS, PointKind.UNSTABLE_FOCUS}),
    "stable focus": frozenset({PointKind.STABLE_FOCUS}),
    "unstable focus": frozenset({PointKind.UNSTABLE_FOCUS}),
    "saddle": frozenset({PointKind.SADDLE}),
    "center": frozenset({PointKind.CENTER}),
    "attractor": STABLE_POINTS,
    "repeller": UNSTABLE_POINTS,
}
"""The types of fixed points that each feature takes in."""

CYCLES: Final[dict[str, frozenset[Stability]]] = {
    "cycle": frozenset(Stability),
    "stable cycle": frozenset({Stability.STABLE}),
    "unstable cycle": frozenset({Stability.UNSTABLE}),
    "semi-stable cycle": frozenset({Stability.SEMI_STABLE}),
    "saddle cycle": frozenset({Stability.SADDLE}),
    "attractor": frozenset({Stability.STABLE}),
    "repeller": frozenset({Stability.UNSTABLE}),
}
"""The stabilities of cycles that each feature takes in."""


Wrong: TypeAlias = tuple[str, float]
"""What is wrong, in words, and by how many times what is allowed."""

FINE: Final[Wrong] = ("", 0.0)


@final
class Fit(IntEnum):
    """Whether a feature is one of those that a claim counts."""

    NO = 0
    MAYBE = 1
    YES = 2


@final
@dataclass(frozen=True, slots=True)
class Member:
    """A feature of a portrait beside a claim.

    index: into the portrait's fixed points or cycles. of_type: whether its type fits; fit: whether
    everything fits. why: in words what does not, where only a condition fails; off: by how many
    times what is allowed.
    """

    is_cycle: bool
    index: int
    of_type: Fit
    fit: Fit
    why: str
    off: float

    @property
    def key(self) -> tuple[bool, int]:
        """What tells it from the other features of its portrait."""
        return self.is_cycle, self.index


def members(
    program: Program, claim: Claim, portrait: Portrait, settings: Settings
) -> tuple[Member, ...]:
    """Every feature of the portrait beside the claim, at the settings of the portrait."""
    conditions = _Conditions(program, claim, portrait.axes, settings)
    return (
        *(_point(claim, conditions, i, p) for i, p in enumerate(portrait.fixed_points)),
        *(_cycle(claim, conditions, i, c) for i, c in enumerate(portrait.cycles)),
    )


def named(program: Program, claim: Claim, portrait: Portrait, settings: Settings) -> set[object]:
    """The features that a claim names for the `other` of later ones: by type, place and reach."""
    conditions = _Conditions(program, claim, portrait.axes, settings)
    points = {
        (False, i)
        for i, point in enumerate(portrait.fixed_points)
        if _point(claim, conditions, i, point).fit is not Fit.NO
    }
    cycles = {
        (True, i)
        for i, cycle in enumerate(portrait.cycles)
        if _type_of_cycle(claim.feature, cycle) is not Fit.NO
        and not conditions.wrong_reach(cycle)[0]
        and not claim.places
    }
    return {*points, *cycles}


def values_at(program: Program, codes: tuple[Code, ...], settings: Settings) -> Array:
    """The values (k,) of code of controls and constants at `settings`."""
    given = dict(settings)
    register = [
        *(given.get(state.name, state.hold) for state in program.states),
        *(given.get(control.name, control.default) for control in program.controls),
        *(constant.value for constant in program.constants),
    ]
    return evaluate(codes, program.register, np.array(register))


def _point(claim: Claim, conditions: "_Conditions", index: int, point: FixedPoint) -> Member:
    of_type = _type_of_point(claim.feature, point)
    why, off = conditions.wrong_place(point) if of_type is not Fit.NO else FINE
    return Member(
        is_cycle=False,
        index=index,
        of_type=of_type,
        fit=Fit.NO if why else of_type,
        why=why,
        off=off,
    )


def _cycle(claim: Claim, conditions: "_Conditions", index: int, cycle: Cycle) -> Member:
    of_type = _type_of_cycle(claim.feature, cycle)
    why, off = FINE
    if of_type is not Fit.NO:
        why, off = max(conditions.wrong_reach(cycle), conditions.wrong_period(cycle), key=_off)
    fit = Fit.NO if why or claim.places else of_type
    return Member(is_cycle=True, index=index, of_type=of_type, fit=fit, why=why, off=off)


def _off(wrong: Wrong) -> float:
    return wrong[1]


def _type_of_point(feature: str, point: FixedPoint) -> Fit:
    kinds = POINTS.get(feature, frozenset())
    if point.kind is PointKind.DEGENERATE and kinds and feature not in {"fixed point", "center"}:
        return Fit.MAYBE
    return Fit.YES if point.kind in kinds else Fit.NO


def _type_of_cycle(feature: str, cycle: Cycle) -> Fit:
    stabilities = CYCLES.get(feature, frozenset())
    unsure = cycle.doubtful or cycle.stability is Stability.NEUTRAL
    if unsure and stabilities and feature != "cycle":
        return Fit.MAYBE
    return Fit.YES if cycle.stability in stabilities else Fit.NO


@final
class _Conditions:
    """The conditions of a claim as numbers, at one setting of the controls."""

    def __init__(
        self, program: Program, claim: Claim, axes: tuple[AxisRange, ...], settings: Settings
    ) -> None:
        self._claim = claim
        self._axes = {axis.name: (j, axis) for j, axis in enumerate(axes)}
        reaches = [code for reach in claim.reaches for code in (reach.low, reach.high)]
        period = [] if claim.period is None else [claim.period]
        codes = (*(place.at for place in claim.places), *reaches, *period)
        values = values_at(program, codes, settings) if codes else np.empty(0)
        count = len(claim.places)
        self._places = values[:count]
        self._reaches = values[count : count + len(reaches)].reshape(-1, 2)
        self._period = float(values[-1]) if period else 0.0

    def wrong_place(self, point: FixedPoint) -> Wrong:
        """What is wrong with where a point is."""
        for place, wanted in zip(self._claim.places, self._places, strict=True):
            j, axis = self._axes[place.state]
            off = abs(axis.shortest(float(point.at[j]) - float(wanted)))
            if not off <= place.within:
                return f"not at {axis.name} = {shown(axis, float(wanted))}", off / place.within
        return FINE

    def wrong_reach(self, cycle: Cycle) -> Wrong:
        """What is wrong with how far a cycle swings."""
        for reach, (low, high) in zip(self._claim.reaches, self._reaches, strict=True):
            j, axis = self._axes[reach.state]
            seen = cycle.points[:, j]
            off = max(abs(float(seen.min()) - float(low)), abs(float(seen.max()) - float(high)))
            if not off <= reach.within:
                wanted = f"{shown(axis, float(low))} to {shown(axis, float(high))}"
                got = f"{shown(axis, float(seen.min()))} to {shown(axis, float(seen.max()))}"
                return f"{axis.name} swings from {got}, not from {wanted}", off / reach.within
        return FINE

    def wrong_period(self, cycle: Cycle) -> Wrong:
        """What is wrong with how long a cycle takes."""
        if self._claim.period is None:
            return FINE
        off = abs(cycle.period - self._period)
        room = self._claim.period_within * abs(self._period)
        if off <= room:
            return FINE
        share = f", {100.0 * off / abs(self._period):.3g} % off" if self._period else ""
        why = f"its period is {cycle.period:.6g} s, not {self._period:.6g} s{share}"
        return why, off / room if room > 0.0 else np.inf

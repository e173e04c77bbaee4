"""Which claim of the spec speaks of a feature, and how far the robot may be off.

What is allowed is the wider of two: what the claim allows (`within`), and what the tolerance of
`fidelity` allows. A claim is about the spec's own field, where a cycle's period can be known to
0.01 %; a robot that keeps the tolerance may be off by more and is still a faithful one.

Of a cycle's period: a lap that is late by a share p of its time lets the state run behind by
p times the horizon after one horizon, at the mean speed of each variable.
"""

from typing import Final

import numpy as np

from runtime.claim import Claim
from verifier.fidelity.stretches.needs import parts_of
from verifier.robot_topology.laps import on_cycle
from verifier.robot_topology.scene import Scene, shortest
from verifier.topology.claims.members import Fit, members, values_at
from verifier.topology.features import Cycle

ALIKE: Final = 1e-3
"""Settings that differ by less than this share of a domain are the same."""
STEPS: Final = 400
TOLERANCE: Final = "the tolerance"
CLAIM: Final = "the claim"


def claim_on(scene: Scene, *, is_cycle: bool, index: int) -> Claim | None:
    """The claim that says most of a feature of the portrait; None where none counts it."""
    found = [
        claim
        for claim in scene.program.claims
        if claim.most != 0 and claim.share is None and _speaks_here(scene, claim)
        for member in members(scene.program, claim, scene.portrait, scene.setting.values)
        if member.fit is not Fit.NO and member.key == (is_cycle, index)
    ]
    return max(found, key=_said, default=None)


def place_allowed(scene: Scene, claim: Claim | None, j: int) -> tuple[float, str]:
    """How far a point may be off on axis j, and what says so."""
    name = scene.axes[j].name
    within = (
        0.0
        if claim is None
        else max((place.within for place in claim.places if place.state == name), default=0.0)
    )
    return _wider(within, float(scene.tolerance[j]))


def reach_allowed(scene: Scene, claim: Claim | None, j: int) -> tuple[float, str]:
    """How far the end of a swing on axis j may be off, and what says so."""
    name = scene.axes[j].name
    within = (
        0.0
        if claim is None
        else max((reach.within for reach in claim.reaches if reach.state == name), default=0.0)
    )
    return _wider(within, float(scene.tolerance[j]))


def period_allowed(scene: Scene, claim: Claim | None, cycle: Cycle) -> tuple[float, str]:
    """By how much a lap may be longer or shorter, s, and what says so."""
    points = on_cycle(cycle, np.arange(STEPS + 1) / STEPS)
    way = np.sum(np.abs(shortest(np.diff(points, axis=0), scene.turns)), axis=0)
    speed = way / cycle.period
    late = np.min(np.where(speed > 0.0, scene.tolerance / np.maximum(speed, 1e-300), np.inf))
    by_claim = 0.0
    if claim is not None and claim.period is not None:
        [value] = values_at(scene.program, (claim.period,), scene.setting.values)
        by_claim = claim.period_within * abs(float(value))
    return _wider(by_claim, float(late) / scene.horizon * cycle.period)


def numbers_judged(scene: Scene) -> int:
    """How many statements are made on features: numbers with a tolerance, and types of points."""
    count = 0
    axes = range(len(scene.axes))
    for i, point in enumerate(scene.portrait.fixed_points):
        if not point.drifts:
            claim = claim_on(scene, is_cycle=False, index=i)
            count += 1 + sum(np.isfinite(place_allowed(scene, claim, j)[0]) for j in axes)
    for i, cycle in enumerate(() if scene.program.field.is_map else scene.portrait.cycles):
        claim = claim_on(scene, is_cycle=True, index=i)
        count += int(np.isfinite(period_allowed(scene, claim, cycle)[0]))
        for j in axes:
            if not cycle.turns[j] and np.isfinite(reach_allowed(scene, claim, j)[0]):
                count += len(reach_names(scene, claim, j))
    return count


def reach_names(scene: Scene, claim: Claim | None, j: int) -> tuple[str, ...]:
    """The numbers of a swing on axis j: its ends, too, where a claim speaks of them."""
    name = scene.axes[j].name
    claimed = claim is not None and any(reach.state == name for reach in claim.reaches)
    names = (f"amplitude of {name}", f"lowest {name}", f"highest {name}")
    return names if claimed else names[:1]


def _wider(by_claim: float, by_tolerance: float) -> tuple[float, str]:
    if np.isfinite(by_tolerance):
        wider = by_claim > by_tolerance
        return (by_claim, CLAIM) if wider else (by_tolerance, TOLERANCE)
    return (by_claim, CLAIM) if by_claim > 0.0 else (np.inf, "nothing")


def _said(claim: Claim) -> int:
    """How many conditions a claim makes."""
    return len(claim.places) + len(claim.reaches) + (claim.period is not None)


def _speaks_here(scene: Scene, claim: Claim) -> bool:
    """Whether the claim holds for the setting of the scene, and for its axes."""
    here = dict(scene.setting.values)
    parts = parts_of(scene.program)
    spans = {span.control: (span.low, span.high) for span in claim.over}
    names = {axis.name for axis in scene.axes}
    spoken = {place.state for place in claim.places} | {reach.state for reach in claim.reaches}
    if not spoken <= names:
        return False
    for name, value in here.items():
        room = ALIKE * (parts[name].high - parts[name].low)
        low, high = spans.get(name, (-np.inf, np.inf))
        at = dict(claim.settings).get(name, value)
        if not (low - room <= value <= high + room and abs(at - value) <= room):
            return False
    return True

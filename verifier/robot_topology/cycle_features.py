"""Cycles of the spec beside those of the robot."""

from dataclasses import replace

import numpy as np

from runtime.arrays import Array
from runtime.claim import Claim
from runtime.program import Unit
from verifier.report.features import ComparedFeature, Estimate, FeatureNumber, FeatureStanding
from verifier.robot_topology.declared import claim_on, period_allowed, reach_allowed, reach_names
from verifier.robot_topology.laps import Laps, laps_of, nearest_cycle, period_of_laps
from verifier.robot_topology.loops import MeanLap, mean_lap, spec_swing
from verifier.robot_topology.mode_laps import laps_by_modes, round_of
from verifier.robot_topology.refitted_cycles import RefittedCycle, refitted_cycle
from verifier.robot_topology.refitted_points import RefitView
from verifier.robot_topology.scene import Scene
from verifier.robot_topology.standing import standing_of, together
from verifier.robot_topology.wording import sentence_on
from verifier.topology.features import Cycle
from verifier.topology.names import cycle_names

SECOND = Unit("s", 1.0)


def cycle_features(
    scene: Scene, view: RefitView | None, confidence: float, rng: np.random.Generator
) -> tuple[ComparedFeature, ...]:
    """Every cycle of the spec; those of a step map are left out."""
    if scene.program.field.is_map:
        return ()
    return tuple(
        _feature(scene, i, None if view is None else refitted_cycle(view, cycle), confidence, rng)
        for i, cycle in enumerate(scene.portrait.cycles)
    )


def _feature(
    scene: Scene,
    index: int,
    refit: RefittedCycle | None,
    confidence: float,
    rng: np.random.Generator,
) -> ComparedFeature:
    cycle = scene.portrait.cycles[index]
    claim = claim_on(scene, is_cycle=True, index=index)
    laps = tuple(each for each in _laps(scene, cycle) if nearest_cycle(scene, each) == index)
    count = sum(each.count for each in laps)
    period = period_of_laps(laps, confidence)
    lap = None if period is None else mean_lap(laps, cycle, confidence, rng)
    numbers = _numbers(scene, cycle, claim, (period, lap), refit)
    robot = lap.points if lap is not None else refit.loop if refit is not None else None
    plain = ComparedFeature(
        kind=f"{cycle.stability} cycle",
        name=f"{cycle.stability} {cycle_names(scene.portrait)[index]}",
        claim="" if claim is None else claim.text,
        origin=scene.program.field.origin if claim is None else claim.origin,
        in_spec=True,
        is_cycle=True,
        numbers=numbers,
        standing=together(numbers),
        visits=count,
        spec_path=cycle.points,
        robot_path=np.empty((0, len(scene.axes))) if robot is None else _closed(robot),
        sentence="",
    )
    return replace(plain, sentence=sentence_on(plain, _manner(plain, is_seen=lap is not None)))


def _closed(loop: Array) -> Array:
    """The loop, with its first point at its end."""
    return np.concatenate([loop, loop[:1]])


def _laps(scene: Scene, cycle: Cycle) -> tuple[Laps, ...]:
    """By the changes of mode where the cycle has them, else by the phase of the state."""
    way = round_of(cycle)
    if way is None or not len(scene.changes):
        return laps_of(scene, cycle)
    return laps_by_modes(scene.stretches, scene.changes, way)


def _numbers(
    scene: Scene,
    cycle: Cycle,
    claim: Claim | None,
    seen: tuple[Estimate | None, MeanLap | None],
    refit: RefittedCycle | None,
) -> tuple[FeatureNumber, ...]:
    """The period, the amplitude on each axis, and the ends where a claim speaks of them."""
    period, lap = seen
    low, high, amplitude = spec_swing(cycle)
    allowed = period_allowed(scene, claim, cycle)
    by_refit = None if refit is None else refit.period
    found = [_number("period", SECOND, cycle.period, (period, by_refit), allowed)]
    for j, axis in enumerate(scene.axes):
        if cycle.turns[j]:
            continue
        allowed = reach_allowed(scene, claim, j)
        values = (amplitude[j], low[j], high[j])
        both = [
            (None, None, None)
            if each is None
            else (each.amplitude[j], each.lowest[j], each.highest[j])
            for each in (lap, refit)
        ]
        found += [
            _number(name, axis.unit, float(values[k]), (both[0][k], both[1][k]), allowed)
            for k, name in enumerate(reach_names(scene, claim, j))
        ]
    return tuple(found)


def _number(
    name: str,
    unit: Unit,
    spec: float,
    robot: tuple[Estimate | None, Estimate | None],
    allowed: tuple[float, str],
) -> FeatureNumber:
    tolerance, by = allowed
    standing = standing_of(spec, robot[0] or robot[1], tolerance, 0.0)
    return FeatureNumber(name, unit, spec, robot[0], robot[1], tolerance, by, standing)


def _manner(feature: ComparedFeature, *, is_seen: bool) -> str:
    """How the robot's cycle was found, as a clause that its numbers end."""
    if is_seen:
        return f"the robot makes {feature.visits} laps with a"
    if feature.standing is FeatureStanding.NOT_VISITED:
        return f"not visited: the robot makes {_few(feature.visits)}"
    return "the field refitted to the robot has one with a"


def _few(laps: int) -> str:
    if laps == 0:
        return "no settled lap of it in this trace"
    many = "lap" if laps == 1 else "laps"
    return f"only {laps} settled {many} of it in this trace (three are needed)"

"""Fixed points of the spec beside those of the robot."""

from dataclasses import replace

import numpy as np

from runtime.claim import Claim
from verifier.report.features import (
    ComparedFeature,
    Estimate,
    FeatureNumber,
    FeatureStanding,
)
from verifier.report.report import Interval
from verifier.robot_topology.declared import claim_on, place_allowed
from verifier.robot_topology.refitted_points import RefittedPoint, RefitView, refitted_point
from verifier.robot_topology.resting_places import RestingPlace
from verifier.robot_topology.scene import Scene
from verifier.robot_topology.standing import standing_of, together
from verifier.robot_topology.wording import sentence_on
from verifier.topology.features import FixedPoint
from verifier.topology.names import point_name


def point_features(
    scene: Scene, view: RefitView | None, places: tuple[RestingPlace, ...], confidence: float
) -> tuple[ComparedFeature, ...]:
    """Every fixed point of the spec that is one of the whole behavior."""
    rests = {place.attractor: place for place in places}
    return tuple(
        _feature(
            scene,
            i,
            None if view is None else refitted_point(view, point),
            rests.get(i),
            confidence,
        )
        for i, point in enumerate(scene.portrait.fixed_points)
        if not point.drifts
    )


def _feature(
    scene: Scene,
    index: int,
    refit: RefittedPoint | None,
    rest: RestingPlace | None,
    confidence: float,
) -> ComparedFeature:
    point = scene.portrait.fixed_points[index]
    claim = claim_on(scene, is_cycle=False, index=index)
    near = refit if refit is not None and refit.is_visited else None
    if rest is not None and not rest.is_long and near is not None and near.at is not None:
        rest = None  # The refitted field knows it better.
    likeness = _likeness(near, confidence, is_seen=rest is not None)
    numbers = tuple(
        _number(scene, point, claim, j, _seen(scene, point, rest, j), _refitted(near, j))
        for j in range(len(scene.axes))
    )
    standing = together(numbers) if likeness is FeatureStanding.WITHIN else likeness
    is_open = likeness is FeatureStanding.UNDECIDED
    robot = [n.robot.value for n in numbers if n.robot is not None]
    plain = ComparedFeature(
        kind=str(point.kind),
        name=point_name(scene.portrait, index),
        claim="" if claim is None else claim.text,
        origin=scene.program.field.origin if claim is None else claim.origin,
        in_spec=True,
        is_cycle=False,
        numbers=tuple(_told(number, standing, is_open=is_open) for number in numbers),
        standing=standing,
        visits=rest.visits if rest is not None else 0 if refit is None else refit.passes,
        spec_path=point.at[None, :],
        robot_path=np.array([robot]) if robot else np.empty((0, len(scene.axes))),
        sentence="",
    )
    manner = _manner(point, near, rest, likeness)
    return replace(plain, sentence=sentence_on(plain, manner, with_numbers=not is_open))


def _likeness(near: RefittedPoint | None, confidence: float, *, is_seen: bool) -> FeatureStanding:
    """Whether the robot has a point of this type there; a point too far away is another one."""
    if is_seen:
        return FeatureStanding.WITHIN
    if near is None:
        return FeatureStanding.NOT_VISITED
    if near.alike <= 1.0 - confidence:
        return FeatureStanding.EXCEEDED
    is_sure = near.at is not None and near.alike >= confidence
    return FeatureStanding.WITHIN if is_sure else FeatureStanding.UNDECIDED


def _seen(scene: Scene, point: FixedPoint, rest: RestingPlace | None, j: int) -> Estimate | None:
    """Where the robot rests on axis j, on the turn of the spec's point."""
    if rest is None:
        return None
    turn, at = float(scene.turns[j]), rest.at[j]
    off = turn * np.rint((at.value - point.at[j]) / turn) if turn > 0.0 else 0.0
    moved = Interval(float(at.interval.low - off), float(at.interval.high - off))
    return Estimate(float(at.value - off), moved)


def _refitted(refit: RefittedPoint | None, j: int) -> Estimate | None:
    return refit.at[j] if refit is not None and refit.at is not None else None


def _number(
    scene: Scene,
    point: FixedPoint,
    claim: Claim | None,
    j: int,
    seen: Estimate | None,
    refit: Estimate | None,
) -> FeatureNumber:
    axis = scene.axes[j]
    tolerance, by = place_allowed(scene, claim, j)
    spec = float(point.at[j])
    standing = standing_of(spec, seen or refit, tolerance, float(scene.turns[j]))
    return FeatureNumber(axis.name, axis.unit, spec, seen, refit, tolerance, by, standing)


def _told(number: FeatureNumber, standing: FeatureStanding, *, is_open: bool) -> FeatureNumber:
    """One that was not found, or that may be of another point, stands as its feature does."""
    return replace(number, standing=standing) if is_open or number.robot is None else number


def _manner(
    point: FixedPoint,
    near: RefittedPoint | None,
    rest: RestingPlace | None,
    likeness: FeatureStanding,
) -> str:
    """How the robot's place was found, as a clause that its coordinates end."""
    if rest is not None:
        return f"the robot rests {'once' if rest.visits == 1 else f'{rest.visits} times'} at"
    if near is None:
        return "not visited by the robot in this trace"
    if likeness is FeatureStanding.UNDECIDED:
        return (
            "not decided: the robot comes near, but this trace does not tell whether its field has"
            f" a {point.kind} there"
        )
    if near.at is None:
        return "the robot comes near, and the field refitted to it has none there"
    if likeness is FeatureStanding.EXCEEDED:
        return "the field refitted to the robot has a point of another type, at"
    return "the field refitted to the robot has it at"

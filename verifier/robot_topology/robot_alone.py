"""Where the robot rests although its spec would move on."""

import numpy as np

from runtime.arrays import Array
from runtime.flow import flow_of, next_states, rates
from verifier.report.features import ComparedFeature, FeatureNumber, FeatureStanding
from verifier.report.wording import listed, number
from verifier.robot_topology.refitted_points import controls_at, state_at
from verifier.robot_topology.resting_places import RestingPlace
from verifier.robot_topology.rests import allowance
from verifier.robot_topology.scene import Scene
from verifier.robot_topology.wording import estimate_words


def rests_of_robot_alone(
    scene: Scene, places: tuple[RestingPlace, ...]
) -> tuple[ComparedFeature, ...]:
    """Resting places that stand for no attractor, and that the spec would leave in a horizon.

    None for a behavior with modes, whose rates depend on the mode that it rests in.
    """
    if scene.program.field.mode:
        return ()
    alone = [place for place in places if place.attractor < 0]
    return tuple(
        _feature(scene, p, _moved(scene, p.place)) for p in alone if _would_leave(scene, p)
    )


def _would_leave(scene: Scene, place: RestingPlace) -> bool:
    """Whether all over the place's interval the field moves some axis too far, one way."""
    moved = np.array([_moved(scene, at) for at in _corners(place)])
    same_way = np.all(moved > 0.0, axis=0) | np.all(moved < 0.0, axis=0)
    return bool(np.any(same_way & (np.min(np.abs(moved), axis=0) > allowance(scene))))


def _corners(place: RestingPlace) -> list[Array]:
    """The place itself, and the ends of its interval along each axis."""
    found = [place.place]
    for j, at in enumerate(place.at):
        for end in (at.interval.low, at.interval.high):
            corner = place.place.copy()
            corner[j] += end - at.value
            found.append(corner)
    return found


def _moved(scene: Scene, place: Array) -> Array:
    """How far the spec's field moves each axis (m,) in one horizon, at the rate at the place."""
    flow = flow_of(scene.program)
    low = np.array([axis.low for axis in scene.axes])
    turned = low + np.mod(place - low, scene.width)
    inside = np.clip(place, low, low + scene.width)
    x = state_at(scene, np.where(scene.turns > 0.0, turned, inside))
    u = controls_at(scene)
    every = scene.program.field.every
    rate = (next_states(flow, x, u) - x) / every if every else rates(flow, x, u)
    return np.asarray(rate[list(scene.columns)] * scene.horizon)


def _feature(scene: Scene, place: RestingPlace, moved: Array) -> ComparedFeature:
    words = listed(
        [
            f"{axis.name} = {estimate_words(at, axis.unit)}"
            for axis, at in zip(scene.axes, place.at, strict=True)
        ]
    )
    j = int(np.argmax(np.abs(moved) / allowance(scene)))
    axis = scene.axes[j]
    rate = moved[j] / scene.horizon / axis.unit.scale
    unit = f" {axis.unit.text}/s" if axis.unit.text not in {"", "1"} else " 1/s"
    often = "once" if place.visits == 1 else f"{place.visits} times"
    return ComparedFeature(
        kind="resting place",
        name=f"resting place at {words}",
        claim="",
        origin=scene.program.field.origin,
        in_spec=False,
        is_cycle=False,
        numbers=tuple(
            FeatureNumber(
                name=each.name,
                unit=each.unit,
                spec=np.nan,
                seen=at,
                refitted=None,
                tolerance=np.inf,
                allowed_by="nothing",
                standing=FeatureStanding.EXCEEDED,
            )
            for each, at in zip(scene.axes, place.at, strict=True)
        ),
        standing=FeatureStanding.EXCEEDED,
        visits=place.visits,
        spec_path=np.empty((0, len(scene.axes))),
        robot_path=place.place[None, :],
        sentence=(
            f"The robot rests {often} at {words}, where the spec has no attractor:"
            f" there it would change {axis.name} by {number(rate)}{unit}."
        ),
    )

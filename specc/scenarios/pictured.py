"""A run as pictures draw it: the scene, everybody's trail, and what was required."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.architecture import Architecture, Way
from runtime.arrays import Array, Booleans, Integers
from runtime.recording.tracks import ActingTrack, LightFrames, SensorTrack, Touch
from runtime.run import Run
from runtime.scenario import Robot, Scenario
from runtime.world.audit import Jam
from runtime.world.model import Sensor, SensorKind, Thing
from specc.figures.quantities import quantity, seconds
from specc.figures.scene import (
    NOBODY,
    Eye,
    EyeKind,
    Glow,
    Item,
    Lamp,
    Mark,
    Outcome,
    Said,
    Scene,
    Trails,
)
from specc.scenarios.last_light import last_light
from verifier.report.requirement_results import Outcome as Judged
from verifier.report.requirement_results import RequirementResult

HELD: Final = {Judged.SATISFIED: True, Judged.VIOLATED: False, Judged.OPEN: None}
NEARER: Final = 0.995
"""The share of its reach below which a range says that something is there: it has noise."""
EYES: Final = {
    SensorKind.RANGE: EyeKind.RANGE,
    SensorKind.SIGHT: EyeKind.SIGHT,
    SensorKind.BUMP: EyeKind.BUMP,
}


def pictured(made: Run, requirements: Sequence[RequirementResult]) -> tuple[Scene, Trails]:
    """What posters and films show of a run; the light where the run kept it."""
    course = course_of(made)
    glow = glow_of(made.scenario, made.floor)
    scene = scene_at_end(made.scenario, made.layout.things, glow, course)
    return scene, trails_of(course, requirements)


def glow_of(scenario: Scenario, floor: LightFrames | None) -> Glow | None:
    """The light on the floor, where there are lights and it was kept."""
    if floor is None or not scenario.world.lights:
        return None
    return Glow(floor.xs, floor.ys, floor.times, floor.lux)


def scene_of(scenario: Scenario, things: Sequence[Thing], glow: Glow | None = None) -> Scene:
    """What stands in a scenario; things: all of them, with those that were laid at random."""
    names = [thing.name for thing in things]
    return Scene(
        title=scenario.name,
        about=scenario.about,
        arena=np.array(scenario.world.arena),
        things=tuple(Item(thing.name, thing.shape, thing.is_fixed) for thing in things),
        robots=tuple(
            Item(robot.name, robot.body.shape, eyes=tuple(map(_eye, drawn_sensors(robot))))
            for robot in scenario.robots
        ),
        lamps=tuple(
            Lamp(lamp.name, lamp.pose.x, lamp.pose.y, names.index(lamp.on) if lamp.on else NOBODY)
            for lamp in scenario.world.lights
        ),
        glow=glow,
        seed=scenario.seed,
        spoken=spoken_of(scenario),
    )


def spoken_of(scenario: Scenario) -> frozenset[str]:
    """Names of things that a requirement reads, or that a robot looks for by their own names."""
    read = {
        name.split(".", maxsplit=1)[0]
        for requirement in scenario.requirements
        for name in requirement.quantities
    }
    sought = {
        name for robot in scenario.robots for sensor in robot.body.sensors for name in sensor.of
    }
    return frozenset(read | sought)


def drawn_sensors(robot: Robot) -> list[Sensor]:
    """The sensors of a robot that films draw."""
    return [sensor for sensor in robot.body.sensors if sensor.kind in EYES]


def _eye(sensor: Sensor) -> Eye:
    at = sensor.pose
    return Eye(EYES[sensor.kind], at.x, at.y, at.heading, sensor.width, sensor.reach)


def said_of(sensor: Sensor, track: SensorTrack) -> Said:
    """What one of the drawn sensors said; its readings are in the order of `SensorKind`."""
    readings, still = track.readings, np.zeros(len(track.times))
    match sensor.kind:
        case SensorKind.SIGHT:
            seen, bearing, distance = readings.T
            return Said(track.times, seen > 0.0, distance, bearing)
        case SensorKind.RANGE:
            distance = readings[:, 0]
            return Said(track.times, distance < sensor.reach * NEARER, distance, still)
        case _:
            return Said(track.times, readings[:, 0] > 0.0, still, still)


def said_now(sensor: Sensor, readings: Array) -> Said:
    """What one of the drawn sensors says, at a time that is called zero."""
    return said_of(sensor, SensorTrack(np.zeros(1), readings[np.newaxis]))


@final
@dataclass(frozen=True, eq=False, slots=True)
class Course:
    """What a run was, or its recording tells of it, as far as it is drawn.

    poses: (T, things + robots, 3) at times (T,). acting, sensors: of each robot, in its order.
    """

    times: Array
    poses: Array
    robots: tuple[Robot, ...]
    acting: tuple[ActingTrack, ...]
    sensors: tuple[tuple[SensorTrack, ...], ...]
    touches: tuple[Touch, ...]
    jams: tuple[Jam, ...]


def course_of(made: Run) -> Course:
    """What is drawn of a run."""
    return Course(
        made.world.times,
        made.world.poses,
        made.scenario.robots,
        tuple(track.acting for track in made.robots),
        tuple(track.sensors for track in made.robots),
        made.touches,
        made.audit.jams,
    )


def scene_at_end(
    scenario: Scenario, things: Sequence[Thing], glow: Glow | None, course: Course
) -> Scene:
    """What stands in a scenario, and the light of its end, where light was kept at all."""
    scene = scene_of(scenario, things, glow)
    if glow is None:
        return scene
    last = last_light(scenario, things, course.poses[-1], float(course.times[-1]))
    return replace(scene, last_glow=last)


def trails_of(course: Course, requirements: Sequence[RequirementResult]) -> Trails:
    """Everybody's trail, with what happened on it, and what was required."""
    times, count = course.times, course.poses.shape[1] - len(course.robots)
    doing = [
        who_acts(robot.architecture, acting, times)
        for robot, acting in zip(course.robots, course.acting, strict=True)
    ]
    robots = [robot.name for robot in course.robots]
    poses = course.poses[:, count:]
    jams = []
    for jam in course.jams:
        robot = robots.index(jam.robot)
        x, y = _at(times, poses[:, robot], jam.begin)
        jams.append(Mark(robot, jam.begin, x, y, jam.end))
    return Trails(
        times=times,
        things=course.poses[:, :count],
        robots=poses,
        doers=tuple(names for names, _ in doing),
        acting=np.column_stack([acting for _, acting in doing]),
        contacts=tuple(Mark(robots.index(t.robot), t.time, t.x, t.y) for t in course.touches),
        jams=tuple(jams),
        outcomes=tuple(Outcome(one.text, HELD[one.outcome], _margin(one)) for one in requirements),
        said=tuple(
            tuple(
                said_of(sensor, said)
                for sensor, said in zip(robot.body.sensors, sensors, strict=True)
                if sensor.kind in EYES
            )
            for robot, sensors in zip(course.robots, course.sensors, strict=True)
        ),
    )


def who_acts(
    architecture: Architecture, track: ActingTrack, times: Array
) -> tuple[tuple[str, ...], Integers]:
    """Who has its way: names, and for each time an index of them, or NOBODY.

    Names stand in the order of nodes: who acts in like architectures gets like colours.
    """
    acting = np.full(len(times), NOBODY, dtype=np.int64)
    if not len(track.times):
        return (), acting
    rows = np.searchsorted(track.times, times + 1e-9, side="right") - 1
    told = [
        winner(architecture, acts, weights)
        for acts, weights in zip(track.acts, track.weights, strict=True)
    ]
    order = [node.name for node in architecture.nodes]
    first = {name: min(map(order.index, _nodes_in(name))) for name in dict.fromkeys(told) if name}
    names = sorted(first, key=lambda name: first[name])
    places = np.array([names.index(name) if name else NOBODY for name in told], dtype=np.int64)
    seen = rows >= 0
    acting[seen] = places[rows[seen]]
    return tuple(names), acting


def _nodes_in(name: str) -> list[str]:
    """The nodes in what `winner` says."""
    return name.removeprefix("mostly ").split(" + ")


def winner(architecture: Architecture, acts: Booleans, weights: Array) -> str:
    """Who has its way on the first channel that is reached, empty for nobody.

    Of a priority it is the highest that acts, of a blend the one with the greatest weight; of a
    sum it is all of them.
    """
    channel = next((c for c in architecture.channels if c.resolution.nodes), None)
    if channel is None:
        return ""
    who = [node for node in channel.resolution.nodes if acts[node]]
    replaced = {part for node in who for part in architecture.nodes[node].replaces}
    who = [node for node in who if node not in replaced]
    names = [architecture.nodes[node].name for node in who]
    match channel.resolution.way:
        case Way.PRIORITY:
            return names[0] if names else ""
        case Way.BLEND if len(who) > 1:
            return f"mostly {names[int(np.argmax(weights[who]))]}"
        case _:
            return " + ".join(names)


def _at(times: Array, poses: Array, time: float) -> tuple[float, float]:
    """Where something was at a time."""
    row = min(int(np.searchsorted(times, time - 1e-9)), len(times) - 1)
    return float(poses[row, 0]), float(poses[row, 1])


def _margin(one: RequirementResult) -> str:
    """By how much it holds or does not, and when that was decided.

    Nothing at the bound, and where that is no quantity: where several units are mixed, or choices
    compared.
    """
    is_number = np.isfinite(one.robustness) and one.unit.text not in {"", "1"}
    if not is_number or one.robustness == 0.0 or one.outcome is Judged.OPEN:
        return ""
    margin = quantity(abs(one.robustness), one.unit)
    return f"{margin} at {seconds(one.witness.time)}" if one.witness else margin

"""A run put together again from its recording, to be looked at: nothing is run again."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.container import ArtifactError
from runtime.recording.happened import SUFFIX, Happened, from_bytes
from runtime.recording.nodes import MEASURED, READINGS, THINGS, topic_of
from runtime.recording.tables import Field
from runtime.recording.tracks import ActingTrack, SensorTrack
from runtime.scenario import Robot, Scenario
from runtime.world.model_faults import faults_of_things
from spec_schema.diagnostics import SpecError
from specc.faults import fault
from specc.figures.scene import Scene, Trails
from specc.scenarios.pictured import Course, glow_of, scene_at_end, trails_of
from specc.verifying.requirements import judged_on
from specc.verifying.standard import Carried, carried_by
from verifier.architectures.document import ScenarioDocument
from verifier.architectures.floor import recorded_floor
from verifier.architectures.log import RunLog, open_run, together
from verifier.architectures.quantities import quantities_in, topics_of_quantities
from verifier.architectures.recorded import acting_in, topics_of_nodes
from verifier.report.requirement_results import RequirementResult
from verifier.traces.files.log import Progress
from verifier.traces.files.open_log import attachments

POSE: Final = [Field("x"), Field("y"), Field("heading")]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Replay:
    """A recorded run as it is drawn, and what it says of what its scenario requires."""

    scenario: Scenario
    scene: Scene
    trails: Trails
    requirements: tuple[RequirementResult, ...]


def replayed(trace: Path | str, reading: Progress | None = None) -> Replay:
    """Read the recording of a scenario.

    Raises:
        SpecError: it can't be read (V301), is none of a scenario (V393), is damaged (V332), or
            lacks a quantity that is required (V394).
    """
    trace = Path(trace)
    if not trace.exists():
        raise fault("V301", trace, "there is no such file")
    carried = carried_by(trace)
    if carried is None or carried.document is None:
        raise fault("V393", trace, "this is not the recording of a scenario", "record it by "
                    "`specc simulate SCENARIO -o run.mcap`")  # fmt: skip
    try:
        scenario, happened = _scenario(carried.document, carried.robots), _happened(trace, carried)
        glow = glow_of(scenario, recorded_floor(trace))
    except ArtifactError as error:
        raise _damaged(trace, f"what it carries can't be used: {error}") from error
    names = [thing.name for thing in happened.things]
    log = open_run(trace, _topics(scenario.robots, names), scenario.step, reading)
    requirements: tuple[RequirementResult, ...] = ()
    if scenario.requirements:
        quantities = quantities_in(log, scenario.robots, names)
        requirements, _ = judged_on(trace, scenario.requirements, quantities, carried, log)
    course = _course(log, scenario.robots, happened, names)
    if not course.times.size:
        raise _damaged(trace, "it does not tell where the robots were")
    scene = scene_at_end(scenario, happened.things, glow, course)
    return Replay(scenario, scene, trails_of(course, requirements), requirements)


def _damaged(trace: Path, why: str) -> SpecError:
    return fault("V332", trace, why, "record it again")


def _scenario(document: ScenarioDocument, robots: tuple[Robot, ...]) -> Scenario:
    return Scenario(
        name=document.name,
        about=document.about,
        world=document.world,
        robots=robots,
        duration=document.duration,
        step=document.step,
        seed=document.seed,
        beginnings=document.beginnings,
        requirements=document.requirements,
        source=document.world.source,
    )


def _happened(trace: Path, carried: Carried) -> Happened:
    """What the recording says of things, touches and jams, which fits to the scenario.

    Raises:
        ArtifactError: it does not say it, or it does not fit.
    """
    found = attachments(trace, SUFFIX)
    if not found:
        raise ArtifactError("it does not say where things were laid")
    happened = from_bytes(found[0][1])
    for problem in faults_of_things(happened.things):
        raise ArtifactError(problem)
    assert carried.document is not None
    robots = {robot.name for robot in carried.robots}
    told = {touch.robot for touch in happened.touches} | {jam.robot for jam in happened.jams}
    if told - robots:
        raise ArtifactError(
            f"it tells of a robot '{min(told - robots)}', which has no architecture"
        )
    carriers = {light.on for light in carried.document.world.lights if light.on}
    missing = carriers - {thing.name for thing in happened.things}
    if missing:
        raise ArtifactError(f"a light stands on '{min(missing)}', which was not laid")
    return happened


def _topics(robots: Sequence[Robot], things: Sequence[str]) -> dict[str, list[Field]]:
    """All that is read: of nodes, and of quantities."""
    nodes = topics_of_nodes({robot.name: robot.architecture for robot in robots})
    return together([nodes, topics_of_quantities(robots, things)])


def _course(
    log: RunLog, robots: Sequence[Robot], happened: Happened, things: Sequence[str]
) -> Course:
    times, _ = log.columns(f"/{robots[0].name}/{MEASURED}", POSE)
    poses = [_poses(log, f"{THINGS}/{name}", times) for name in things]
    poses += [_poses(log, f"/{robot.name}/{MEASURED}", times) for robot in robots]
    return Course(
        times=times,
        poses=np.stack(poses, axis=1),
        robots=tuple(robots),
        acting=tuple(
            ActingTrack(*acting_in(log, robot.name, robot.architecture)) for robot in robots
        ),
        sensors=tuple(_sensors(log, robot) for robot in robots),
        touches=happened.touches,
        jams=happened.jams,
    )


def _poses(log: RunLog, topic: str, times: Array) -> Array:
    """Poses (T, 3) at `times`: the last that was told before each."""
    told, columns = log.columns(topic, POSE)
    if not told.size:
        return np.full((times.size, 3), np.nan)
    last = np.maximum(np.searchsorted(told, times + 1e-9, "right") - 1, 0)
    found: Array = np.column_stack(list(columns.values()))[last]
    return found


def _sensors(log: RunLog, robot: Robot) -> tuple[SensorTrack, ...]:
    tracks = []
    for sensor in robot.body.sensors:
        fields = [Field(reading.name, reading.unit) for reading in sensor.readings]
        times, columns = log.columns(topic_of(robot.name, sensor.name, READINGS), fields)
        tracks.append(SensorTrack(times, np.column_stack(list(columns.values()))))
    return tuple(tracks)

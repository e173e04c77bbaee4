"""A run put together again from its recording, to be looked at: nothing is run again."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, final

import numpy as np
from mcap.reader import make_reader

from runtime.arrays import Array
from runtime.container import ArtifactError
from runtime.program_json import from_plain
from runtime.recording.foxglove import classes
from runtime.recording.happened import SUFFIX, Happened, from_bytes
from runtime.recording.nodes import MEASURED, READINGS, THINGS, topic_of
from runtime.recording.tables import Field
from runtime.recording.tracks import ActingTrack, LightFrames, SensorTrack
from runtime.scenario import Robot, Scenario
from runtime.world.model import World
from specc.faults import fault
from specc.figures.scene import Scene, Trails
from specc.pictured import Course, glow_of, scene_of, trails_of
from specc.run_standard import Carried, carried_by
from verifier.architectures.document import SUFFIX as SCENARIO
from verifier.architectures.log import RunLog, open_run
from verifier.architectures.quantities import quantities_in, topics_of_quantities
from verifier.architectures.recorded import acting_in, topics_of_nodes
from verifier.architectures.required import results_on
from verifier.report.requirement_results import RequirementResult
from verifier.traces.files.log import Progress
from verifier.traces.files.open_log import attachments

NANOSECONDS: Final = 1e9
LIGHT: Final = "/world/light"
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
        SpecError: it can't be read (V301), is none of a scenario (V393), or is damaged (V332).
    """
    trace = Path(trace)
    carried = carried_by(trace)
    if carried is None or carried.document is None:
        raise fault("V393", trace, "this is not the recording of a scenario", "record it by "
                    "`specc simulate SCENARIO -o run.mcap`")  # fmt: skip
    try:
        scenario, happened = _scenario(trace, carried), _happened(trace)
    except (ArtifactError, KeyError, ValueError) as error:
        raise fault("V332", trace, f"what it carries can't be used: {error}", "record it again") \
            from error  # fmt: skip
    names = [thing.name for thing in happened.things]
    log = open_run(trace, _topics(scenario.robots, names), scenario.step, reading)
    requirements: tuple[RequirementResult, ...] = ()
    if scenario.requirements:
        quantities = quantities_in(log, scenario.robots, names)
        requirements = results_on(scenario.requirements, quantities, scenario.duration)
    course = _course(log, scenario.robots, happened, names)
    if not course.times.size:
        raise fault("V332", trace, "it does not tell where the robots were", "record it again")
    glow = glow_of(scenario, _floor(trace))
    scene = scene_of(scenario, happened.things, glow)
    return Replay(scenario, scene, trails_of(course, requirements), requirements)


def _scenario(trace: Path, carried: Carried) -> Scenario:
    document = json.loads(attachments(trace, SCENARIO)[0][1])
    world = from_plain(World, document["world"], "world", _no_table)
    assert carried.document is not None
    return Scenario(
        name=carried.document.name,
        about=document["about"],
        world=world,
        robots=carried.robots,
        duration=carried.document.duration,
        step=carried.document.step,
        seed=carried.document.seed,
        beginnings=document["beginnings"],
        requirements=carried.document.requirements,
        source=world.source,
    )


def _happened(trace: Path) -> Happened:
    found = attachments(trace, SUFFIX)
    if not found:
        raise ArtifactError("it does not say where things were laid")
    return from_bytes(found[0][1])


def _topics(robots: Sequence[Robot], things: Sequence[str]) -> dict[str, list[Field]]:
    """All that is read: of nodes, and of quantities."""
    topics = dict(topics_of_nodes({robot.name: robot.architecture for robot in robots}))
    for topic, fields in topics_of_quantities(robots, things).items():
        known = {field.name for field in topics.get(topic, [])}
        topics[topic] = [*topics.get(topic, []), *(f for f in fields if f.name not in known)]
    return topics


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


def _floor(trace: Path) -> LightFrames | None:
    """The light on the floor, where it was recorded."""
    times, frames, grid = [], [], None
    with trace.open("rb") as file:
        for _, _, message in make_reader(file).iter_messages(topics=[LIGHT]):
            grid = classes()["Grid"].FromString(message.data)
            lux = np.frombuffer(grid.data, dtype="<f4").reshape(-1, grid.column_count)
            times.append(message.log_time / NANOSECONDS)
            frames.append(lux.astype(np.float64))
    if grid is None:
        return None
    rows, columns = frames[0].shape
    corner, cell = grid.pose.position, grid.cell_size
    xs = corner.x + cell.x * (np.arange(columns) + 0.5)
    ys = corner.y + cell.y * (np.arange(rows) + 0.5)
    return LightFrames(xs, ys, np.array(times), np.array(frames))


def _no_table(name: str, shape: tuple[int, ...]) -> Array:
    raise ArtifactError(f"a world has no table ({name}, {shape})")

"""The named quantities of a recorded run: the arrays of the run put together again, and named."""

from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np

from runtime.architecture import Architecture, Node
from runtime.arrays import Array
from runtime.recording.nodes import (
    CHOICE,
    CLOSE,
    MEASURED,
    OUTPUT,
    READINGS,
    STATE,
    THINGS,
    told_by,
    topic_of,
)
from runtime.recording.quantities import quantities_of
from runtime.recording.tables import Field
from runtime.recording.tracks import (
    ActingTrack,
    ChannelTrack,
    NodeTrack,
    Quantity,
    RobotTrack,
    SensorTrack,
    WorldTrack,
)
from runtime.scenario import Robot
from verifier.architectures.log import RunLog

POSE: Final = ("x", "y", "heading")
MOTION: Final = ("speed", "turn")
NEAR: Final = ("clearance", "contacts")
LIGHT: Final = "light"


def topics_of_quantities(robots: Sequence[Robot], things: Iterable[str]) -> dict[str, list[Field]]:
    """What is read of a recording for its quantities, by topic."""
    found: dict[str, list[Field]] = {}
    for robot in robots:
        found[f"/{robot.name}/{MEASURED}"] = _bare(*POSE, *MOTION, LIGHT)
        found[f"/{robot.name}/{CLOSE}"] = _bare(*NEAR)
        for sensor in robot.body.sensors:
            fields = [Field(reading.name, reading.unit) for reading in sensor.readings]
            found[topic_of(robot.name, sensor.name, READINGS)] = fields
        for node in robot.architecture.nodes:
            for what, fields in _of_node(robot.architecture, node).items():
                found[topic_of(robot.name, node.name, what)] = fields
    for thing in things:
        found[f"{THINGS}/{thing}"] = _bare(*POSE)
    return found


def quantities_in(
    log: RunLog, robots: Sequence[Robot], things: Sequence[str]
) -> dict[str, Quantity]:
    """Every named quantity of the run that the recording holds, as the run itself has it.

    things: those that are asked for; one that the recording has not is left out.
    """
    things = [name for name in things if log.columns(f"{THINGS}/{name}", _bare(*POSE))[0].size]
    tracks = [_track(log, robot) for robot in robots]
    return quantities_of(robots, tracks, _world(log, [robot.name for robot in robots], things))


def _bare(*names: str) -> list[Field]:
    return [Field(name) for name in names]


def _of_node(architecture: Architecture, node: Node) -> dict[str, list[Field]]:
    if node.behavior < 0:
        return {CHOICE if node.arbiter >= 0 else OUTPUT: told_by(architecture, node)}
    program = architecture.programs[node.behavior]
    return {
        STATE: [Field(s.name, s.unit, s.values) for s in program.states],
        OUTPUT: [Field(o.name, o.unit) for o in program.outputs],
    }


def _track(log: RunLog, robot: Robot) -> RobotTrack:
    """What of a robot is a quantity; channels and who acts are none."""
    none = np.zeros((0, 0))
    return RobotTrack(
        nodes=tuple(_node(log, robot, node) for node in robot.architecture.nodes),
        sensors=tuple(
            SensorTrack(
                *_table(
                    log,
                    topic_of(robot.name, sensor.name, READINGS),
                    [Field(reading.name, reading.unit) for reading in sensor.readings],
                )
            )
            for sensor in robot.body.sensors
        ),
        acting=ActingTrack(np.zeros(0), none > 0.0, none),
        channels=ChannelTrack(np.zeros(0), none, none > 0.0),
        resolutions=(),
    )


def _node(log: RunLog, robot: Robot, node: Node) -> NodeTrack:
    """Ticks, of which all topics have a message."""
    tables = {
        what: _table(log, topic_of(robot.name, node.name, what), fields)
        for what, fields in _of_node(robot.architecture, node).items()
        if fields
    }
    times = np.zeros(0)
    for place, (at, _) in enumerate(tables.values()):
        times = at if place == 0 else np.intersect1d(times, at)
    rows = {what: values[np.isin(at, times)] for what, (at, values) in tables.items()}
    none = np.zeros((times.size, 0))
    outputs = rows.get(CHOICE, rows.get(OUTPUT, none))
    flags = np.zeros(times.size, dtype=np.bool_)
    # A choice that is none is -1.
    told = np.where(np.isfinite(outputs), outputs, -1.0) if CHOICE in rows else outputs
    return NodeTrack(times, rows.get(STATE, none), told, none, flags, flags)


def _world(log: RunLog, robots: Sequence[str], things: Sequence[str]) -> WorldTrack:
    measured = [_table(log, f"/{name}/{MEASURED}", _bare(*POSE, *MOTION, LIGHT)) for name in robots]
    close = [_table(log, f"/{name}/{CLOSE}", _bare(*NEAR)) for name in robots]
    times, close_times = _common(measured), _common(close)
    looked = [values[np.isin(at, times)] for at, values in measured]
    near = [values[np.isin(at, close_times)] for at, values in close]
    still = [_between(times, *_table(log, f"{THINGS}/{name}", _bare(*POSE))) for name in things]
    moving = [values[:, : len(POSE)] for values in looked]
    return WorldTrack(
        names=(*things, *robots),
        times=times,
        poses=np.stack([*still, *moving], axis=1),
        motions=np.stack([values[:, 3:5] for values in looked], axis=1),
        light=np.stack([values[:, 5] for values in looked], axis=1),
        close_times=close_times,
        clearance=np.stack([values[:, 0] for values in near], axis=1),
        contacts=np.stack([values[:, 1] for values in near], axis=1),
    )


def _common(tables: Sequence[tuple[Array, Array]]) -> Array:
    """The times that all of them have."""
    times = tables[0][0]
    for at, _ in tables[1:]:
        times = np.intersect1d(times, at)
    return times


def _between(times: Array, told: Array, rows: Array) -> Array:
    """Poses (T, 3) at `times`, of which those are told around which something changes."""
    last = np.maximum(np.searchsorted(told, times, "right") - 1, 0)
    found: Array = rows[last]
    return found


def _table(log: RunLog, topic: str, fields: Sequence[Field]) -> tuple[Array, Array]:
    times, columns = log.columns(topic, fields)
    return times, np.column_stack([*columns.values(), *([] if columns else [np.zeros((0, 0))])])

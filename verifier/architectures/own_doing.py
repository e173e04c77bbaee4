"""What is not a behavior's own doing though it acts alone: what went on before, what was unseen.

When another hands a channel over, the body goes on as it was told before until its drive has
changed its speed. A reading of what is not seen is the last one: a bearing that stays although the
robot turns is no bearing.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from runtime.architecture import Architecture, Node
from runtime.arrays import Array, Booleans
from runtime.program import Kind
from runtime.recording.nodes import CHANNELS, CLOSE, READINGS, topic_of
from runtime.recording.tables import Field
from runtime.scenario import Robot
from runtime.world.model import Body, Sensor, SensorKind
from verifier.architectures.log import RunLog
from verifier.architectures.nodes import NodeRecord

HANDED_OVER: Final = "the body still did what it was told before"
UNSEEN: Final = "was not seen (the last reading stands)"
SEEN: Final = "seen"
CONTACTS: Final = (Field("contacts"),)


def topics_of_doing(robot: Robot) -> dict[str, list[Field]]:
    """What is read of a recording for that, by topic."""
    channels = [Field(each.name, each.unit) for each in robot.architecture.channels]
    found = {f"/{robot.name}/{CHANNELS}": channels} if channels else {}
    found[f"/{robot.name}/{CLOSE}"] = list(CONTACTS)
    for sensor in robot.body.sensors:
        if sensor.kind is SensorKind.SIGHT:
            found[topic_of(robot.name, sensor.name, READINGS)] = _readings(sensor)
    return found


def with_own_doing(
    log: RunLog, robot: Robot, records: tuple[NodeRecord, ...]
) -> tuple[NodeRecord, ...]:
    """The records of a robot's nodes, what is not a behavior's own doing held back as well."""
    return tuple(
        _marked(log, robot, node, record) if node.behavior >= 0 and record.times.size else record
        for node, record in zip(robot.architecture.nodes, records, strict=True)
    )


def _marked(log: RunLog, robot: Robot, node: Node, record: NodeRecord) -> NodeRecord:
    back = dict(record.held_back)
    taken = ~record.free
    for cause, flags in _found(log, robot, node, record):
        back[cause] = back.get(cause, False) | (flags & ~taken)
        taken = taken | flags
    return replace(record, held_back=back, touches=_touches(log, robot, record.times))


def _touches(log: RunLog, robot: Robot, at: Array) -> Booleans | None:
    """Whether the body touches something at these times; None where that was not recorded."""
    times, columns = log.columns(f"/{robot.name}/{CLOSE}", CONTACTS)
    if not times.size:
        return None
    last = np.maximum(np.searchsorted(times, at, "right") - 1, 0)
    found: Booleans = columns["contacts"][last] > 0.0
    return found


def _found(
    log: RunLog, robot: Robot, node: Node, record: NodeRecord
) -> Iterator[tuple[str, Booleans]]:
    yield HANDED_OVER, _going_on(log, robot, node, record)
    for state, sensor in _judged_by_sight(robot.body, robot.architecture, node):
        times, columns = log.columns(topic_of(robot.name, sensor.name, READINGS), _readings(sensor))
        if times.size:
            last = np.searchsorted(times, record.times, "right") - 1
            seen = np.where(last >= 0, columns[SEEN][np.maximum(last, 0)], 0.0)
            yield f"{state}: {sensor.name} {UNSEEN}", seen < 0.5


def _readings(sensor: Sensor) -> list[Field]:
    return [Field(reading.name, reading.unit) for reading in sensor.readings]


def _judged_by_sight(
    body: Body, architecture: Architecture, node: Node
) -> Iterator[tuple[str, Sensor]]:
    """The states that are judged by what a sensor says of what it may not see."""
    sights = {each.name: each for each in body.sensors if each.kind is SensorKind.SIGHT}
    program = architecture.programs[node.behavior]
    judged = {s.name for s in program.states if s.is_driven and s.kind is not Kind.DISCRETE}
    for wire in node.inputs:
        if wire.entry in judged and wire.signal >= 0:
            sensor, _, reading = architecture.board[wire.signal].name.partition(".")
            if sensor in sights and reading != SEEN:
                yield wire.entry, sights[sensor]


def _going_on(log: RunLog, robot: Robot, node: Node, record: NodeRecord) -> Booleans:
    """(T,) where the body may still change to what this node tells it, having been told else."""
    times, free = record.times, record.free
    begun = np.flatnonzero(free & ~np.append(False, free[:-1]))
    before = np.append(times[:1], times)[begun]
    lasts = np.zeros(begun.size)
    for place in {command.channel for command in node.commands}:
        channel = robot.architecture.channels[place].name
        change = _told(log, robot, channel, times[begun]) - _told(log, robot, channel, before)
        lasts = np.maximum(lasts, np.abs(change) / _fastest(robot.body, channel))
    lasts = np.where(lasts > 0.0, lasts + _latency(robot.body, robot.architecture, node), 0.0)
    flags = np.zeros(times.size, dtype=np.bool_)
    for start, last in zip(times[begun], lasts, strict=True):
        flags |= (times >= start) & (times < start + last - 1e-9)
    return flags & free


def _told(log: RunLog, robot: Robot, channel: str, at: Array) -> Array:
    """The set-point of a channel in effect at each instant, 0 before the first."""
    fields = [Field(each.name, each.unit) for each in robot.architecture.channels]
    times, columns = log.columns(f"/{robot.name}/{CHANNELS}", fields)
    if not times.size:
        return np.zeros(at.size)
    last = np.searchsorted(times, at, "right") - 1
    found: Array = np.where(last >= 0, columns[channel][np.maximum(last, 0)], 0.0)
    return found


def _fastest(body: Body, channel: str) -> float:
    """The largest rate of change of what a channel sets."""
    return body.drive.spin if channel.endswith(".turn") else body.drive.acceleration


def _latency(body: Body, architecture: Architecture, node: Node) -> float:
    """How late the latest of the sensors is that the node reads."""
    late = {sensor.name: sensor.latency for sensor in body.sensors}
    read = [architecture.board[wire.signal].name for wire in node.inputs if wire.signal >= 0]
    return max((late.get(name.partition(".")[0], 0.0) for name in read), default=0.0)

"""What the nodes, sensors and channels of a robot said, as topics of a recording.

`/ROBOT/NODE/state`, `control`, `output` at a behavior's ticks; `reads` and `choice` at those of an
arbiter; `acting` where that changes; `/ROBOT/SENSOR/readings`; `/ROBOT/base/channels`, `driven`;
`/ROBOT/base/turn/resolved`.
What a node says stands at its tick: it takes effect its response time later.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from runtime.arbiter import Arbiter
from runtime.architecture import Architecture, Node
from runtime.arrays import Array
from runtime.program import Control, Kind, Output, State
from runtime.recording.messages import Messages
from runtime.recording.resolutions import tell_resolutions
from runtime.recording.tables import Field, tell_rows
from runtime.recording.tracks import NodeTrack, RobotTrack
from runtime.scenario import Robot

ACTING: Final = "acting"
STATE: Final = "state"
CONTROL: Final = "control"
OUTPUT: Final = "output"
READS: Final = "reads"
CHOICE: Final = "choice"
READINGS: Final = "readings"
CHANNELS: Final = "base/channels"
DRIVEN: Final = "base/driven"
MEASURED: Final = "base/measured"
CLOSE: Final = "base/close"
THINGS: Final = "/world/things"


def topic_of(robot: str, node: str, what: str) -> str:
    """The topic of what a node, or a sensor, of a robot says."""
    return f"/{robot}/{node}/{what}"


def tell_robot(messages: Messages, robot: Robot, track: RobotTrack) -> None:
    """Everything that went on in one robot."""
    _tell_sensors(messages, robot, track)
    for place, (node, ticks) in enumerate(zip(robot.architecture.nodes, track.nodes, strict=True)):
        _tell_node(messages, robot, node, ticks)
        _tell_acting(messages, robot.name, node, track, place)
    _tell_channels(messages, robot, track)
    tell_resolutions(messages, robot, track)


def _tell_sensors(messages: Messages, robot: Robot, track: RobotTrack) -> None:
    for sensor, said in zip(robot.body.sensors, track.sensors, strict=True):
        fields = [Field(reading.name, reading.unit) for reading in sensor.readings]
        topic = topic_of(robot.name, sensor.name, READINGS)
        tell_rows(messages, topic, fields, said.times, said.readings)


def _tell_node(messages: Messages, robot: Robot, node: Node, ticks: NodeTrack) -> None:
    if not ticks.times.size:
        return
    architecture = robot.architecture

    def tell(what: str, fields: Sequence[Field], rows: Array) -> None:
        tell_rows(messages, topic_of(robot.name, node.name, what), fields, ticks.times, rows)

    if node.behavior >= 0:
        program = architecture.programs[node.behavior]
        states, controls = len(program.states), len(program.controls)
        tell(STATE, [_field(s) for s in program.states], ticks.register[:, :states])
        controlled = ticks.register[:, states : states + controls]
        tell(CONTROL, [_field(c) for c in program.controls], controlled)
        tell(OUTPUT, [_field(o) for o in program.outputs], ticks.outputs)
    elif node.arbiter >= 0:
        tell(READS, fields_of_reads(architecture.arbiters[node.arbiter]), ticks.register)
        tell(CHOICE, told_by(architecture, node), ticks.outputs)
    else:
        tell(READS, [Field(wire.entry) for wire in node.inputs], ticks.register)
        tell(OUTPUT, told_by(architecture, node), ticks.outputs)


def fields_of_reads(arbiter: Arbiter) -> list[Field]:
    """What an arbiter samples: its reads, then its controls."""
    reads = [Field(read.name, read.unit, read.values, read.about) for read in arbiter.reads]
    return [*reads, *(_field(control) for control in arbiter.controls)]


def _tell_acting(messages: Messages, robot: str, node: Node, track: RobotTrack, place: int) -> None:
    acting = track.acting
    topic = topic_of(robot, node.name, ACTING)
    rows = np.column_stack([acting.acts[:, place], acting.weights[:, place]])
    flag = Field("acts", is_flag=True, about="nothing keeps it from acting")
    weight = Field("weight", about="how strongly choices in effect name it")
    tell_rows(messages, topic, [flag, weight], acting.times, rows)


def _tell_channels(messages: Messages, robot: Robot, track: RobotTrack) -> None:
    channels, set_points = robot.architecture.channels, track.channels
    values = [Field(channel.name, channel.unit) for channel in channels]
    flags = [Field(channel.name, is_flag=True, about="driven, or coasting") for channel in channels]
    times = set_points.times
    tell_rows(messages, f"/{robot.name}/{CHANNELS}", values, times, set_points.set_points)
    tell_rows(messages, f"/{robot.name}/{DRIVEN}", flags, times, set_points.driven)


def told_by(architecture: Architecture, node: Node) -> list[Field]:
    """What a node writes on the board, under the names that it has there."""
    signals = [architecture.board[place] for place in node.outputs]
    return [
        Field(
            signal.name.partition(".")[2],
            signal.unit,
            signal.values if signal.kind is Kind.DISCRETE else (),
        )
        for signal in signals
    ]


def _field(variable: State | Control | Output) -> Field:
    labels = variable.values if isinstance(variable, State) else ()
    return Field(variable.name, variable.unit, labels, variable.about)

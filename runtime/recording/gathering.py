"""What a run tells, kept: an observer that copies, and passes on to another."""

from collections.abc import Sequence
from typing import final

import numpy as np

from runtime.arrays import Array, Booleans, frozen
from runtime.recording.tracks import (
    ActingTrack,
    ChannelTrack,
    Happening,
    NodeTrack,
    ResolutionTrack,
    RobotTrack,
    SensorTrack,
)
from runtime.scenario import Robot, Scenario
from runtime.scheduler.environment import Delivery
from runtime.scheduler.observer import Event, Observer, Resolved, Tick


@final
class Gathering:
    """Keeps all that the scheduler tells; an `Observer`."""

    def __init__(self, scenario: Scenario, also: Observer) -> None:
        """also: who is told everything too."""
        self._robots, self._step, self._also = scenario.robots, scenario.step, also
        self._notes = tuple(_Notes(robot) for robot in scenario.robots)
        self._happenings: list[Happening] = []

    def sensed(self, instant: int, delivery: Delivery) -> None:
        """Keep readings."""
        said = self._notes[delivery.robot].sensors[delivery.sensor]
        said.append((instant, delivery.readings.copy()))
        self._also.sensed(instant, delivery)

    def ticked(self, instant: int, tick: Tick) -> None:
        """Keep a tick."""
        robot, node, register, outputs, commands, allowed, acts = tick
        copied = Tick(robot, node, register.copy(), outputs.copy(), commands.copy(), allowed, acts)
        self._notes[tick.robot].nodes[tick.node].append((instant, copied))
        self._also.ticked(instant, tick)

    def acting(self, instant: int, robot: int, acts: Booleans, weights: Array) -> None:
        """Keep who acts; of several at one instant the last counts."""
        self._notes[robot].acting[instant] = (acts.copy(), weights.copy())
        self._also.acting(instant, robot, acts, weights)

    def commanded(self, instant: int, robot: int, channels: Array, driven: Booleans) -> None:
        """Keep what the channels are."""
        self._notes[robot].channels[instant] = (channels.copy(), driven.copy())
        self._also.commanded(instant, robot, channels, driven)

    def resolved(self, instant: int, robot: int, channel: int, how: Resolved) -> None:
        """Keep who has their way on a channel."""
        self._notes[robot].resolutions[channel].append((instant, how))
        self._also.resolved(instant, robot, channel, how)

    def happened(self, instant: int, event: Event) -> None:
        """Keep what happened, by name."""
        robot = self._robots[event.robot]
        nodes, channels = robot.architecture.nodes, robot.architecture.channels
        where = nodes[event.node].name if event.node >= 0 else ""
        where = channels[event.channel].name if event.channel >= 0 else where
        time = instant * self._step
        self._happenings.append(Happening(time, robot.name, str(event.what), where))
        self._also.happened(instant, event)

    def happenings(self) -> tuple[Happening, ...]:
        """What happened, in the order of time."""
        return tuple(self._happenings)

    def tracks(self) -> tuple[RobotTrack, ...]:
        """What each robot did, up to now."""
        return tuple(note.track(self._step) for note in self._notes)


@final
class _Notes:
    """What is kept of one robot."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self.nodes: list[list[tuple[int, Tick]]] = [[] for _ in robot.architecture.nodes]
        self.sensors: list[list[tuple[int, Array]]] = [[] for _ in robot.body.sensors]
        self.acting: dict[int, tuple[Booleans, Array]] = {}
        self.channels: dict[int, tuple[Array, Booleans]] = {}
        self.resolutions: list[list[tuple[int, Resolved]]] = [
            [] for _ in robot.architecture.channels
        ]

    def track(self, step: float) -> RobotTrack:
        """As arrays."""
        count = len(self._robot.architecture.nodes)
        channels = len(self._robot.architecture.channels)
        return RobotTrack(
            nodes=tuple(_node_track(ticks, step) for ticks in self.nodes),
            sensors=tuple(
                SensorTrack(
                    _times([instant for instant, _ in said], step),
                    _rows([readings for _, readings in said], len(sensor.readings)),
                )
                for sensor, said in zip(self._robot.body.sensors, self.sensors, strict=True)
            ),
            acting=ActingTrack(
                _times(list(self.acting), step),
                _flags([acts for acts, _ in self.acting.values()], count),
                _rows([weights for _, weights in self.acting.values()], count),
            ),
            channels=ChannelTrack(
                _times(list(self.channels), step),
                _rows([values for values, _ in self.channels.values()], channels),
                _flags([driven for _, driven in self.channels.values()], channels),
            ),
            resolutions=tuple(
                ResolutionTrack(
                    _times([instant for instant, _ in told], step),
                    _rows([np.array(how.weights) for _, how in told], count),
                    np.array([how.is_limited for _, how in told], dtype=np.bool_),
                    np.array([how.is_in_conflict for _, how in told], dtype=np.bool_),
                )
                for told in self.resolutions
            ),
        )


def _node_track(ticks: Sequence[tuple[int, Tick]], step: float) -> NodeTrack:
    first = ticks[0][1] if ticks else None
    return NodeTrack(
        times=_times([instant for instant, _ in ticks], step),
        register=_rows([tick.register for _, tick in ticks], first.register.size if first else 0),
        outputs=_rows([tick.outputs for _, tick in ticks], first.outputs.size if first else 0),
        commands=_rows([tick.commands for _, tick in ticks], first.commands.size if first else 0),
        allowed=np.array([tick.allowed for _, tick in ticks], dtype=np.bool_),
        acts=np.array([tick.acts for _, tick in ticks], dtype=np.bool_),
    )


def _times(instants: Sequence[int], step: float) -> Array:
    return frozen(np.array(instants, dtype=np.float64) * step)


def _rows(rows: Sequence[Array], width: int) -> Array:
    return frozen(np.array(rows, dtype=np.float64).reshape(len(rows), width))


def _flags(rows: Sequence[Booleans], width: int) -> Booleans:
    flags = np.array(rows, dtype=np.bool_).reshape(len(rows), width)
    flags.flags.writeable = False
    return flags

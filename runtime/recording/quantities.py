"""The named quantities of a run: what requirements and figures read."""

import math
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from runtime.architecture import Node, Signal
from runtime.arrays import Array
from runtime.program import Kind, State, Unit
from runtime.recording.tracks import NodeTrack, Quantity, RobotTrack, WorldTrack
from runtime.scenario import Robot

METRES: Final = Unit("m", 1.0)
RADIANS: Final = Unit("rad", 1.0)
BEFORE: Final = 1.0 - 1e-9
"""Of the end: what takes effect later than that takes none, for the last instant is not lived."""


def quantities_of(
    robots: Sequence[Robot], tracks: Sequence[RobotTrack], world: WorldTrack
) -> dict[str, Quantity]:
    """Every named quantity: of the world, then of each robot's sensors and nodes."""
    end = _end(tracks, world)
    found = [*_of_world(world, [robot.name for robot in robots])]
    for robot, track in zip(robots, tracks, strict=True):
        found += [*_of_sensors(robot, track), *_of_nodes(robot, track, end)]
    return {quantity.name: quantity for quantity in found}


def _end(tracks: Sequence[RobotTrack], world: WorldTrack) -> float:
    """When the run ended, at which the world is looked at; of a torn recording what is told last.

    What a node says takes no effect from there on.
    """
    told = [world.close_times, world.times]
    told += [sensor.times for track in tracks for sensor in track.sensors]
    told += [node.times for track in tracks for node in track.nodes]
    return max((float(times[-1]) for times in told if times.size), default=0.0)


def _of_world(world: WorldTrack, robots: Sequence[str]) -> Iterator[Quantity]:
    times = world.times
    for place, name in enumerate(world.names):
        x, y, heading = world.poses[:, place].T
        yield measured(f"{name}.x", METRES, times, x)
        yield measured(f"{name}.y", METRES, times, y)
        yield measured(f"{name}.heading", RADIANS, times, wrapped(heading), Kind.PERIODIC)
    for place, name in enumerate(robots):
        speed, turn = world.motions[:, place].T
        yield measured(f"{name}.speed", Unit("m/s", 1.0), times, speed)
        yield measured(f"{name}.turn", Unit("rad/s", 1.0), times, turn)
        yield measured(f"{name}.light", Unit("lx", 1.0), times, world.light[:, place])
        close = world.close_times
        yield measured(f"{name}.clearance", METRES, close, world.clearance[:, place])
        contacts = world.contacts[:, place]
        yield measured(f"{name}.contacts", Unit("1", 1.0), close, contacts, Kind.DISCRETE)


def _of_sensors(robot: Robot, track: RobotTrack) -> Iterator[Quantity]:
    place = 0
    for sensor, said in zip(robot.body.sensors, track.sensors, strict=True):
        for column in range(len(sensor.readings)):
            signal = robot.architecture.board[place]
            yield of_board(robot.name, signal, said.times, said.readings[:, column])
            place += 1


def _of_nodes(robot: Robot, track: RobotTrack, end: float) -> Iterator[Quantity]:
    board, programs = robot.architecture.board, robot.architecture.programs
    for node, ticks in zip(robot.architecture.nodes, track.nodes, strict=True):
        for column, place in enumerate(node.outputs):
            times, values = _in_effect(ticks, column, node, board[place], end)
            yield of_board(robot.name, board[place], times, values)
        for column, state in enumerate(
            programs[node.behavior].states if node.behavior >= 0 else ()
        ):
            name = f"{robot.name}.{node.name}.{state.name}"
            yield of_state(name, state, ticks.times, _column(ticks, ticks.register, column))


def _in_effect(
    ticks: NodeTrack, column: int, node: Node, signal: Signal, end: float
) -> tuple[Array, Array]:
    """What the board says of an output: from when on, and what; first that nothing was said yet."""
    later = ticks.times + node.response_time
    reached = later < end * BEFORE
    times, values = later[reached], _column(ticks, ticks.outputs, column)[reached]
    if node.response_time == 0.0 or not ticks.times.size or ticks.times[0] > 0.0:
        return times, values
    return np.append(0.0, times), np.append(signal.unsaid, values)


def of_board(robot: str, signal: Signal, times: Array, values: Array) -> Quantity:
    """A signal of a robot's board."""
    return _held(f"{robot}.{signal.name}", signal, times, values)


def of_state(name: str, state: State, times: Array, values: Array) -> Quantity:
    """A state of a node."""
    turns = state.kind is Kind.PERIODIC
    return _held(name, state, times, wrapped(values, state.low, state.high) if turns else values)


def _held(name: str, what: Signal | State, times: Array, values: Array) -> Quantity:
    """What stays until something else is said."""
    return Quantity(
        name=name,
        unit=what.unit,
        kind=what.kind,
        labels=what.values,
        low=what.low,
        high=what.high,
        is_held=True,
        times=times,
        values=values,
    )


def _column(ticks: NodeTrack, values: Array, column: int) -> Array:
    return values[:, column] if ticks.times.size else np.zeros(0)


def measured(
    name: str, unit: Unit, times: Array, values: Array, kind: Kind = Kind.CONTINUOUS
) -> Quantity:
    """A quantity of the world, known at some times."""
    turns = kind is Kind.PERIODIC
    low, high = (-math.pi, math.pi) if turns else (-math.inf, math.inf)
    return Quantity(name, unit, kind, (), low, high, kind is Kind.DISCRETE, times, values)


def wrapped(values: Array, low: float = -math.pi, high: float = math.pi) -> Array:
    """The same angles within [low, high); those that are there already are not touched."""
    turned = low + np.mod(values - low, high - low)
    inside: Array = np.where((values >= low) & (values < high), values, turned)
    return inside

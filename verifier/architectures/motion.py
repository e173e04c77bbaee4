"""States that a robot drives and does not sense, judged by how its body moved.

Such a state is the robot's own reckoning: held against the spec it departs by nothing, whatever
the body does. Where its rate is what the behavior commands, the body's motion measures it: the
way that it went, or the angle that it turned by. Any other is not measured, and not judged.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from runtime.architecture import Command, Node
from runtime.arrays import Array
from runtime.flow import flow_of, rates, registers
from runtime.machine import evaluate
from runtime.program import Kind, Program, Role, State
from runtime.recording.nodes import MEASURED
from runtime.recording.tables import Field
from runtime.scenario import Robot
from verifier.architectures.log import RunLog
from verifier.architectures.nodes import NodeRecord

HEADING: Final = "heading"
SPEED: Final = "speed"
MOTION: Final = {"base.turn": HEADING, "base.speed": SPEED}
"""What of the body's motion says how far a channel moved it."""
SAME: Final = 1e-6
"""Rates that differ by this share of the largest are one."""


def topics_of_motion(robot: Robot) -> dict[str, list[Field]]:
    """What is read of a recording for that, by topic."""
    return {f"/{robot.name}/{MEASURED}": _fields()}


def with_motion(
    log: RunLog, robot: Robot, records: tuple[NodeRecord, ...]
) -> tuple[NodeRecord, ...]:
    """The records of a robot's nodes, with the body's motion where a behavior only reckons."""
    return tuple(
        _measured(log, robot, node, record) if node.behavior >= 0 and record.times.size else record
        for node, record in zip(robot.architecture.nodes, records, strict=True)
    )


def _measured(log: RunLog, robot: Robot, node: Node, record: NodeRecord) -> NodeRecord:
    program = robot.architecture.programs[node.behavior]
    columns, unmeasured = dict(record.columns), []
    for state in _reckoned(program):
        way = _way_of(log, robot, node, program, state, record)
        if way is None:
            unmeasured.append(state.name)
        else:
            columns[state.name] = _moved(state, record, way)
    return replace(record, columns=columns, unmeasured=tuple(unmeasured))


def _reckoned(program: Program) -> Iterator[State]:
    for state in program.states:
        if state.role is Role.DRIVEN and state.kind is not Kind.DISCRETE:
            yield state


def _way_of(
    log: RunLog, robot: Robot, node: Node, program: Program, state: State, record: NodeRecord
) -> Array | None:
    """(T,) how far the body's motion moved the state by each tick; None where nothing says."""
    for command in node.commands:
        channel = robot.architecture.channels[command.channel].name
        sign = command.sign * _factor(program, state, command, record)
        if sign == 0.0 or channel not in MOTION:
            continue
        times, columns = log.columns(f"/{robot.name}/{MEASURED}", _fields())
        if times.size < 2:
            return None
        return sign * np.interp(record.times, times, _gone(channel, times, columns))
    return None


def _gone(channel: str, times: Array, columns: dict[str, Array]) -> Array:
    """How far a channel had moved the body."""
    if MOTION[channel] == HEADING:
        return np.asarray(np.unwrap(columns[HEADING]))
    speed = columns[SPEED]
    steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(times)
    return np.append(0.0, np.cumsum(steps))


def _factor(program: Program, state: State, command: Command, record: NodeRecord) -> float:
    """1 or -1 where the state's rate is that times what the command says; else 0."""
    if command.entry == state.name:
        return 1.0 if command.mode == "rate" else 0.0
    if command.mode != "set-point":
        return 0.0
    flow = flow_of(program)
    if flow.is_map:
        return 0.0
    x = np.column_stack([record.columns[each.name] for each in program.states])
    u = np.column_stack(
        [np.zeros((len(x), 0)), *(record.columns[c.name] for c in program.controls)]
    )
    rate = rates(flow, x, u)[:, [s.name for s in program.states].index(state.name)]
    said = _said(program, command.entry, registers(flow, x, u))
    known = np.isfinite(rate) & np.isfinite(said)
    if not known.any() or not np.any(said[known]):
        return 0.0
    largest = np.abs(said[known]).max()
    for factor in (1.0, -1.0):
        if np.abs(rate[known] - factor * said[known]).max() <= SAME * largest:
            return factor
    return 0.0


def _said(program: Program, entry: str, register: Array) -> Array:
    """(T,) what is commanded: an output, or a control."""
    names = program.register
    for output in program.outputs:
        if output.name == entry:
            return evaluate([output.code], names, register)[..., 0]
    if entry in names:
        return np.asarray(register[..., names.index(entry)])
    return np.full(register.shape[:-1], np.nan)


def _moved(state: State, record: NodeRecord, way: Array) -> Array:
    """What the state would be, had it gone on in each stretch of its doing as the body moved."""
    own = record.columns[state.name]
    free = record.free
    begun = free & ~np.append(False, free[:-1])
    first = np.maximum.accumulate(np.where(begun, np.arange(free.size), 0))
    moved = own[first] + way - way[first]
    if state.kind is Kind.PERIODIC:
        moved = state.low + np.mod(moved - state.low, state.high - state.low)
    return np.where(free, moved, own)


def _fields() -> list[Field]:
    return [Field(HEADING), Field(SPEED)]

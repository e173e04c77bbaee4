"""What is found out of how each module of a book is tested: the robot, and its rehearsal."""

from collections.abc import Iterator

from runtime.architecture import Architecture, Node
from runtime.user_code import UserCodeError
from runtime.world.model import Body, Reading
from spec_schema.diagnostics import SpecError
from specc.book.settings import settings_of
from specc.book.trials import NO_TRIAL, Trial
from verifier.fidelity.stretches.needs import names_read
from verifier.procedure.behavior import procedure_of
from verifier.procedure.bench import bench_test
from verifier.procedure.robot import Robot


def trial_of(architecture: Architecture, body: Body, node: Node) -> Trial:
    """How a node is tested, rehearsed."""
    if node.behavior >= 0:
        robot = robot_of(architecture, body, node)
        try:
            return Trial(procedure_of(architecture.programs[node.behavior], robot), None, "")
        except SpecError as error:
            return Trial(None, None, error.diagnostics[0].message)
    if node.arbiter < 0:
        return NO_TRIAL
    try:
        test = bench_test(architecture.arbiters[node.arbiter], node.period)
    except UserCodeError as error:
        return Trial(None, None, str(error))
    return NO_TRIAL if test is None else Trial(None, test, "")


def robot_of(architecture: Architecture, body: Body, node: Node) -> Robot:
    """The robot that a behavior is rehearsed with: as timed, set and fed as the architecture says.

    What it senses by a sensor of the body is known within its range, and by its noise.
    """
    settings, moving = settings_of(architecture, node)
    levels = {
        control.name: tuple(sorted({one.controls[control.name] for one in settings}))
        for control in architecture.programs[node.behavior].controls
        if control.name not in moving
    }
    sensed = list(_sensed(architecture, body, node))
    return Robot(
        node.period,
        node.response_time,
        levels,
        {entry: _ends(scale, reading) for entry, scale, reading in sensed},
        {entry: abs(scale) * reading.noise for entry, scale, reading in sensed if reading.noise},
        _own(architecture, node),
    )


def _own(architecture: Architecture, node: Node) -> frozenset[str]:
    """The states that a behavior reads and that only it itself tells: its own account."""
    program = architecture.programs[node.behavior]
    told = {
        wire.entry
        for wire in node.inputs
        if wire.signal >= 0 and not architecture.board[wire.signal].name.startswith(f"{node.name}.")
    }
    return frozenset(names_read(program) & set(program.field.driven) - told)


def _ends(scale: float, reading: Reading) -> tuple[float, float]:
    """The range of a reading, scaled."""
    low, high = sorted((scale * reading.low, scale * reading.high))
    return low, high


def _sensed(
    architecture: Architecture, body: Body, node: Node
) -> Iterator[tuple[str, float, Reading]]:
    """What a node reads of a sensor: the entry, the scale of its wire, the reading."""
    readings = {f"{s.name}.{each.name}": each for s in body.sensors for each in s.readings}
    for wire in node.inputs:
        name = architecture.board[wire.signal].name if wire.signal >= 0 else ""
        if name in readings:
            yield wire.entry, wire.scale, readings[name]

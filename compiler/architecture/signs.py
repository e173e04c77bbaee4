"""Signs: what a sight tells falls as the body turns, or drives ahead; do commands know that?"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, final

from compiler.architecture.bodies import BodyPart
from compiler.architecture.parts import Part, Parts
from compiler.findings import Findings
from runtime.architecture import Command, Input, Signal
from runtime.world.model import Sensor, SensorKind


@final
@dataclass(frozen=True, slots=True)
class _Fall:
    """What falls, by which motion, and what that leads to where the sign is left out."""

    text: str
    motion: str
    error: str


TURNS: Final = _Fall("a bearing falls as the body turns", "turn", "it would turn the wrong way")
DRIVES: Final = _Fall(
    "a distance falls as the body drives ahead", "go", "it would drive the wrong way"
)


def check_signs(
    inputs: Mapping[str, tuple[Input, ...]],
    commands: Mapping[str, tuple[Command, ...]],
    board: tuple[Signal, ...],
    parts: Parts,
    findings: Findings,
) -> None:
    """A warning for each state of a sight whose rate is commanded as if it rose with the motion."""
    if parts.body is None:
        return
    for part in parts.nodes.values():
        wires = {wire.entry: wire for wire in inputs[part.name] if wire.signal >= 0}
        for command in commands[part.name]:
            wire = wires.get(command.entry)
            if command.mode != "rate" or wire is None or command.sign * wire.scale <= 0.0:
                continue
            channel = parts.body.ports[command.channel].name
            fall = _fall(board[wire.signal].name, channel, parts.body)
            if fall is not None:
                _warn(fall, part, wire, board[wire.signal].name, f"{channel} as rate", findings)


def _fall(signal: str, channel: str, body: BodyPart) -> _Fall | None:
    """Why a signal falls where a channel is above 0, if it is of a sight and does."""
    owner, _, reading = signal.rpartition(".")
    sensor = next((one for one in body.body.sensors if one.name == owner), None)
    if sensor is None or sensor.kind is not SensorKind.SIGHT:
        return None
    if (reading, channel) == ("bearing", "base.turn"):
        return TURNS
    is_ahead = channel in {"base.speed", "base.forward"} and _looks_ahead(sensor)
    return DRIVES if reading == "distance" and is_ahead else None


def _looks_ahead(sensor: Sensor) -> bool:
    return abs(math.remainder(sensor.pose.heading, math.tau)) < math.pi / 2


def _warn(
    fall: _Fall, part: Part, wire: Input, signal: str, command: str, findings: Findings
) -> None:
    sign, other = ("", "-") if wire.scale > 0.0 else ("-", "")
    scaled = f"{wire.scale:g} * " if wire.scale != 1.0 else ""
    message = (
        f"{fall.text}, and {part.name} acts by '{wire.entry}: {sign}{command}', where "
        f"'{wire.entry}' is {scaled}{signal}: {fall.error}"
    )
    remedy = (
        f"write '{wire.entry}: {other}{command}' in the behavior; or give it an output, "
        f"such as '{fall.motion}: {{is: {other}(RATE)}}', and command that as set-point"
    )
    findings.warning("S364", (*part.path, "sense", wire.entry), message, remedy)

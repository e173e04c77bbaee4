"""The board: every signal that a wire may come from, with its unit and its domain."""

from collections.abc import Iterator, Mapping
from typing import Final

from compiler.architecture.codes import range_of_code
from compiler.architecture.parts import Part, Parts
from compiler.findings import Findings
from runtime.architecture import Signal
from runtime.program import Program, Unit
from runtime.world.model import Sensor
from spec_schema.suggest import did_you_mean

NUMBER: Final = Unit("1", 1.0)


def board_of(parts: Parts, findings: Findings) -> tuple[Signal, ...]:
    """Sensors' readings first, then what nodes tell, in the order of the spec."""
    sensors = () if parts.body is None else parts.body.body.sensors
    for sensor in sensors:
        if sensor.name in parts.nodes:
            message = f"'{sensor.name}' is a sensor of the body, too"
            findings.error("S201", ("nodes", sensor.name), message, "rename the node", key=True)
    readings = [signal for sensor in sensors for signal in _readings(sensor)]
    told = [signal for part in parts.nodes.values() for signal in _told(part, parts, findings)]
    return (*readings, *told)


def _readings(sensor: Sensor) -> Iterator[Signal]:
    for reading in sensor.readings:
        name = f"{sensor.name}.{reading.name}"
        low, high = reading.low, reading.high
        yield Signal(name, reading.unit, low, high, reading.kind, (), sensor.origin)


def _told(part: Part, parts: Parts, findings: Findings) -> Iterator[Signal]:
    origin = parts.loaded.origin(part.path)
    ranges = _ranges(part)
    seen: set[str] = set()
    for entry in part.tells:
        name = f"{part.name}.{entry.name}"
        if name in seen:
            message = f"'{name}' is told twice: as an output and as a choice"
            findings.error("S201", part.path, message, "rename the output", key=True)
        seen.add(name)
        low, high = ranges.get(entry.name, (entry.low, entry.high))
        unit = entry.unit or NUMBER
        yield Signal(name, unit, low, high, entry.kind, entry.values, origin)


def _ranges(part: Part) -> Mapping[str, tuple[float, float]]:
    """Where outputs lie, from the domains of what they read."""
    if part.program is not None:
        box = box_of(part.program)
        return {output.name: range_of_code(output.code, box) for output in part.program.outputs}
    if part.arbiter is not None:
        arbiter = part.arbiter
        box = {one.name: (one.low, one.high) for one in arbiter.reads}
        box |= {one.name: (one.low, one.high) for one in arbiter.controls}
        box |= {one.name: (one.value, one.value) for one in arbiter.constants}
        return {output.name: range_of_code(output.code, box) for output in arbiter.outputs}
    return {}


def box_of(program: Program) -> dict[str, tuple[float, float]]:
    """The domain of everything that a program's code reads."""
    box = {one.name: (one.low, one.high) for one in program.states}
    box |= {one.name: (one.low, one.high) for one in program.controls}
    return box | {one.name: (one.value, one.value) for one in program.constants}


def why_unknown(name: str, board: Mapping[str, int], parts: Parts) -> str:
    """What to write in the place of a signal that there is not."""
    meant = did_you_mean(name, sorted(board))
    if meant:
        return meant
    owner, _, what = name.partition(".")
    part = parts.nodes.get(owner)
    if part is not None and part.program is not None:
        states = [state.name for state in part.program.states]
        if what in states:
            return f"tell it as an output of {owner}: `{what}_now: {{is: {what}, unit: ...}}`"
    for node in parts.nodes.values():
        named = node.program or node.arbiter
        if named is not None and named.name == owner and f"{node.name}.{what}" in board:
            return f"{owner} is what node '{node.name}' runs: write '{node.name}.{what}'"
    own = sorted(signal for signal in board if signal.startswith(f"{owner}."))
    if own:
        return f"'{owner}' tells {', '.join(own)}"
    owners = dict.fromkeys(signal.partition(".")[0] for signal in board)
    return f"signals come from {', '.join(owners)}" if owners else "there are none"

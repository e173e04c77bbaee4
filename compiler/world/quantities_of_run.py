"""The quantities that a run has by name: what requirements may speak of."""

from collections.abc import Sequence
from typing import Final

from compiler.requirement import Measured
from runtime.program import Kind
from runtime.scenario import Robot
from runtime.world.model import World
from spec_schema.units import parse_unit

OF_ROBOT: Final = {
    "clearance": "m",
    "contacts": "1",
    "x": "m",
    "y": "m",
    "heading": "rad",
    "speed": "m/s",
    "turn": "rad/s",
    "light": "lx",
}
OF_THING: Final = {"x": "m", "y": "m", "heading": "rad"}


def quantities_of(world: World, robots: Sequence[Robot]) -> dict[str, Measured]:
    """Every quantity of a run: of the world, then of each robot's sensors and nodes."""
    copies = [f"{s.name}_{i + 1}" for s in world.scattered for i in range(s.count)]
    things = [*(thing.name for thing in world.things), *copies]
    found = {f"{n}.{key}": _at(key, unit) for n in things for key, unit in OF_THING.items()}
    for robot in robots:
        found |= {f"{robot.name}.{key}": _at(key, unit) for key, unit in OF_ROBOT.items()}
        found[f"{robot.name}.contacts"] = _in("1", kind=Kind.DISCRETE)
        for signal in robot.architecture.board:
            found[f"{robot.name}.{signal.name}"] = _in(signal.unit.text, signal.values, signal.kind)
        for node in robot.architecture.nodes:
            states = robot.architecture.programs[node.behavior].states if node.behavior >= 0 else ()
            for state in states:
                name = f"{robot.name}.{node.name}.{state.name}"
                found[name] = _in(state.unit.text, state.values, state.kind)
    return found


def _at(key: str, unit: str) -> Measured:
    """Where something is, or how it moves: its direction wraps."""
    return _in(unit, kind=Kind.PERIODIC if key == "heading" else Kind.CONTINUOUS)


def _in(unit: str, values: tuple[str, ...] = (), kind: Kind = Kind.CONTINUOUS) -> Measured:
    dimension = parse_unit(unit).dimension
    return Measured(dimension, values, kind is Kind.DISCRETE, unit, kind is Kind.PERIODIC)

"""What the internal states of a robot's nodes start from."""

from compiler.architecture.parts import is_read
from compiler.findings import Findings
from compiler.quantities import si_within
from runtime.program import State
from runtime.scenario import Robot
from spec_schema.places import Path
from spec_schema.scenario import RobotSpec
from spec_schema.suggest import did_you_mean, there_are
from spec_schema.units import parse_unit


def beginnings_of(robot: Robot, spec: RobotSpec, findings: Findings) -> dict[str, float]:
    """By `robot.node.state` the values in SI, with a finding for each that can't be set."""
    states = {
        f"{node.name}.{state.name}": (state, is_read(state, program))
        for node in robot.architecture.nodes
        if node.behavior >= 0
        for program in [robot.architecture.programs[node.behavior]]
        for state in program.states
    }
    internal = [name for name, (_, sensed) in states.items() if not sensed]
    found: dict[str, float] = {}
    for name, value in spec.start.items():
        path: Path = ("robots", robot.name, "start", name)
        if name not in states:
            remedy = did_you_mean(name, internal) or there_are(internal)
            message = f"{robot.name} has no state '{name}'"
            findings.error("S328", path, message, remedy, key=True)
        elif states[name][1]:
            message = f"'{name}' is sensed: it starts from what its wire says"
            remedy = f"states of their own: {', '.join(internal)}" if internal else "remove it"
            findings.error("S328", path, message, remedy, key=True)
        else:
            start = _value(states[name][0], value, path, findings)
            if start is not None:
                found[f"{robot.name}.{name}"] = start
    return found


def _value(state: State, value: float | str, path: Path, findings: Findings) -> float | None:
    if state.values:
        if value in state.values:
            return float(state.values.index(str(value)))
        remedy = did_you_mean(str(value), state.values) or there_are(state.values)
        findings.error("S328", path, f"'{state.name}' has no value '{value}'", remedy)
        return None
    domain, unit = (state.low, state.high), parse_unit(state.unit.text)
    return si_within(value, state.name, domain, unit, "S328", path, findings)

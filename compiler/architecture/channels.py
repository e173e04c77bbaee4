"""What acts on the channels of a body, and as what."""

from typing import Final

from compiler.architecture.bodies import Port
from compiler.architecture.parts import Part, Parts
from compiler.findings import Findings
from compiler.quantities import per_second
from runtime.architecture import Command
from runtime.program import Control, Output, Program, Realization, State
from spec_schema.dimension import Dimension, describe, quotient
from spec_schema.places import Path
from spec_schema.suggest import did_you_mean, there_are
from spec_schema.units import parse_unit

SECOND: Final = parse_unit("s")


def commands_of(part: Part, parts: Parts, findings: Findings) -> tuple[Command, ...]:
    """How a behavior acts on the channels of the body."""
    if part.program is None or parts.body is None:
        return ()
    ports = {port.name: i for i, port in enumerate(parts.body.ports)}
    found: list[Command] = []
    for one in part.program.realizes:
        at: Path = (*part.path, "behavior")
        if one.channel not in ports:
            message = (
                f"{part.program.name} acts on '{one.channel}', and the body has no such channel"
            )
            remedy = did_you_mean(one.channel, ports) or there_are(list(ports))
            findings.error("S340", at, message, remedy)
            continue
        place = ports[one.channel]
        if any(known.channel == place for known in found):
            message = f"{part.program.name} acts on '{one.channel}' in two ways"
            findings.error("S348", at, message, "realize the channel by one variable")
            continue
        _check_dimension(part.program, one, parts.body.ports[place], at, findings)
        found.append(Command(place, one.mode, one.variable, one.sign, one.origin))
    return tuple(found)


def _check_dimension(
    program: Program, one: Realization, port: Port, at: Path, findings: Findings
) -> None:
    wanted = parse_unit(port.unit.text).dimension
    parts: tuple[State | Control | Output, ...] = (
        *program.states,
        *program.controls,
        *program.outputs,
    )
    variable = next(part for part in parts if part.name == one.variable)
    unit = parse_unit(variable.unit.text)
    if one.mode != "set-point":
        unit = per_second(unit)
    if one.mode == "acceleration":
        wanted = quotient(wanted, SECOND.dimension)
    if unit.dimension != wanted:
        message = (
            f"'{one.variable} as {one.mode}' is in {describe(unit.dimension)}, and "
            f"'{port.name}' takes {describe(wanted)}"
        )
        remedy = _other_mode(variable.unit.text, port) or "realize it by another variable"
        findings.error("S341", at, message, remedy)


def _other_mode(text: str, port: Port) -> str:
    """The mode that would fit, if there is one."""
    own: Dimension = parse_unit(text).dimension
    wanted = parse_unit(port.unit.text).dimension
    if own == wanted:
        return f"write '{port.name} as set-point', or 'as acceleration'"
    return f"write '{port.name} as rate'" if quotient(own, SECOND.dimension) == wanted else ""

"""The passes of an architecture in one screen: files, wires, channels, time, levels, program.

gather        what is named: a body, behaviors, arbiters       library, parts, bodies, arbiters
board         every signal, its unit and its domain            signals
inputs        each wire from end to end                        wires
commands      what acts on which channel, as what              channels
choices       what each choice of an arbiter means             lower
channels      how conflicts are resolved                       resolutions, exclusion
order         circles without a delay                          graph
timing        steps and delays against the field               timing
levels        what controls what                               levels
signs         what falls as the body moves                     signs
standing      imitations, what is hypothetical, what is idle   standing
"""

from dataclasses import dataclass
from typing import final

from compiler.architecture.channels import commands_of
from compiler.architecture.exclusion.wiring import Wiring
from compiler.architecture.graph import order_of
from compiler.architecture.levels import check_levels
from compiler.architecture.library import Library
from compiler.architecture.lower import (
    check_replaces,
    lower,
    lower_acts_when,
    lower_choices,
    lower_nodes,
)
from compiler.architecture.parts import Parts, gather
from compiler.architecture.resolutions import channels_of
from compiler.architecture.signals import board_of
from compiler.architecture.signs import check_signs
from compiler.architecture.standing import check_standing
from compiler.architecture.timing import check_timing
from compiler.architecture.wires import Board, inputs_of
from compiler.findings import Findings
from runtime.architecture import Architecture
from runtime.world.model import Body
from spec_schema.architecture import ArchitectureSpec
from spec_schema.diagnostics import Diagnostic
from spec_schema.load import Loaded


@final
@dataclass(frozen=True, eq=False, slots=True)
class CompiledArchitecture:
    """An architecture with its body, and the warnings and choices on the way to it."""

    architecture: Architecture
    body: Body
    warnings: tuple[Diagnostic, ...]
    notes: tuple[str, ...] = ()


def compile_parts(
    spec: ArchitectureSpec, loaded: Loaded, library: Library, findings: Findings
) -> CompiledArchitecture | None:
    """The passes, in order; None where something can't be run, which the findings tell."""
    parts = gather(spec, loaded, library, findings)
    signals = board_of(parts, findings)
    board = Board(signals, {signal.name: i for i, signal in enumerate(signals)})
    nodes = parts.nodes
    inputs = {name: inputs_of(part, board, parts, findings) for name, part in nodes.items()}
    commands = {name: commands_of(part, parts, findings) for name, part in nodes.items()}
    choices = {name: lower_choices(part, parts, findings) for name, part in nodes.items()}
    acts_when = {name: lower_acts_when(part, findings) for name, part in nodes.items()}
    for part in nodes.values():
        check_replaces(part, parts, findings)
    levels = check_levels(inputs, signals, parts, findings)
    lowered = wiring = None
    if parts.body is not None and _is_whole(parts) and not findings.has_errors:
        lowered = lower_nodes(parts, signals, inputs, commands, choices, acts_when, levels)
        sensors = parts.body.body.sensors
        wiring = Wiring(lowered.nodes, signals, lowered.programs, lowered.arbiters, sensors)
    channels = channels_of(commands, parts, wiring, findings)
    order = order_of(inputs, signals, parts, findings)
    check_timing(inputs, signals, choices, parts, findings)
    check_signs(inputs, commands, signals, parts, findings)
    if lowered is None or parts.body is None or findings.has_errors:
        return None
    check_standing(inputs, commands, signals, parts, findings)
    architecture = lower(parts, signals, lowered, channels, order)
    return CompiledArchitecture(architecture, parts.body.body, findings.diagnostics, findings.notes)


def _is_whole(parts: Parts) -> bool:
    return parts.body is not None and all(part.is_known for part in parts.nodes.values())

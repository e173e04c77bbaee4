"""Whether a node surely acts where its conditions hold.

A node that has no number to give does not act in the runtime, whatever the conditions say: one
whose command or rate is not finite, or which samples what is no number. A combined behavior that
may not act proves nothing, since its parts both act then; and a state in which two nodes act is
one only if they can.
"""

from collections.abc import Iterator

from compiler.architecture.exclusion.ahead import within_a_period
from compiler.architecture.exclusion.question import Outcome
from compiler.architecture.exclusion.ranges import Box, ends_of, rates_over
from compiler.architecture.exclusion.wiring import WHAT, Wiring
from compiler.architecture.signals import box_of
from runtime.arbiter import Paradigm
from runtime.architecture import Node
from runtime.program import Program, Role


def doubt_of(wiring: Wiring, needs: tuple[tuple[Outcome, ...], ...], given: set[int]) -> str:
    """Why a node may not act where its needs hold; empty where it surely does.

    given: the nodes that are known to have decided, since others act by them.
    """
    for place in dict.fromkeys(place for need in needs for place, _ in need):
        node = wiring.nodes[place]
        if node.arbiter >= 0 and wiring.arbiters[node.arbiter].paradigm in WHAT:
            what = WHAT[wiring.arbiters[node.arbiter].paradigm]
            return f"whether it does is up to {node.name}, {what}"
        if place in given:
            continue
        for doubt in (*_of_wires(wiring, place), *_of_numbers(wiring, node)):
            return doubt
    return ""


def is_number(wiring: Wiring, signal: int) -> bool:
    """Whether a signal is shown to be finite at all times."""
    writer = next((node for node in wiring.nodes if signal in node.outputs), None)
    if writer is None or (writer.behavior < 0 and writer.arbiter < 0):
        return True  # sensors, and user code, whose answers are checked
    column = writer.outputs.index(signal)
    if writer.behavior >= 0:
        program = wiring.programs[writer.behavior]
        return ends_of(program.outputs[column].code, box_of(program)) is not None
    arbiter = wiring.arbiters[writer.arbiter]
    box = {one.name: (one.low, one.high) for one in arbiter.reads}
    box |= {one.name: (one.low, one.high) for one in arbiter.controls}
    box |= {one.name: (one.value, one.value) for one in arbiter.constants}
    if column < len(arbiter.outputs):
        return ends_of(arbiter.outputs[column].code, box) is not None
    choice = column - len(arbiter.outputs)
    if arbiter.paradigm is Paradigm.WEIGHTS and choice < len(arbiter.weights):
        return ends_of(arbiter.weights[choice], box) is not None
    return True


def _of_wires(wiring: Wiring, place: int) -> Iterator[str]:
    """What of the readings may keep a node from acting, and stands in no condition."""
    node = wiring.nodes[place]
    for wire in node.inputs:
        if wire.signal >= 0 and not is_number(wiring, wire.signal):
            name = wiring.board[wire.signal].name
            yield f"{node.name} reads {name}, which may be no number"


def _of_numbers(wiring: Wiring, node: Node) -> Iterator[str]:
    """What a behavior gives that is not shown to be finite."""
    if node.behavior < 0:
        return
    program = wiring.programs[node.behavior]
    box: Box = box_of(program)
    commanded = {command.entry for command in node.commands}
    for output in program.outputs:
        if output.name in commanded and ends_of(output.code, box) is None:
            yield f"'{output.name}' of {node.name} may be no number"
    for noise in program.noise:
        if ends_of(noise.size, box) is None:
            yield f"the noise of '{noise.state}' of {node.name} may be no number"
    if _looks_ahead(node, program):
        within = within_a_period(program, box, node.period)
        if within is None:
            yield f"a period ahead of {node.name} there may be no number"
            return
        box = within
    for state, rates in rates_over(program, box).items():
        if rates is None:
            yield f"the rate of '{state}' of {node.name} may be no number"


def _looks_ahead(node: Node, program: Program) -> bool:
    """Whether its states are taken from where they are a period on (`runtime.scheduler.ticker`)."""
    takes = {c.entry for c in node.commands if c.mode == "set-point"} & set(program.field.driven)
    own = [s for s in program.states if s.role is Role.DRIVEN or s.name == program.field.mode]
    return not program.field.is_map and bool(takes or own)

"""Whether a combined behavior surely acts where its conditions hold: else it proves nothing.

A node that has no number to give does not act in the runtime, whatever the conditions say: one
whose command or rate is not finite, or which samples what is no number. Then its parts both act.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Final, TypeAlias

from compiler.architecture.codes import tree_of
from compiler.architecture.exclusion.question import Outcome
from compiler.architecture.exclusion.wiring import WHAT, Wiring
from compiler.architecture.signals import box_of
from runtime.arbiter import Paradigm
from runtime.architecture import Node, Outside
from runtime.code import Code
from runtime.flow import Source, rate_of
from runtime.program import Program, Role
from runtime.tape import Sum
from spec_schema.expressions.bounds import interval_of

Box: TypeAlias = dict[str, tuple[float, float]]

ROUNDS: Final = 8
"""Tries to find a box that is not left within a period."""
OVERSHOOT: Final = 8.0
"""Of a table's largest coefficient, which bounds it between its nodes; a little outside it may
give somewhat more."""


def doubt_of(wiring: Wiring, needs: tuple[tuple[Outcome, ...], ...], given: set[int]) -> str:
    """Why a combined node may not act where its needs hold; empty where it surely does.

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


def _of_wires(wiring: Wiring, place: int) -> Iterator[str]:
    """What of the readings may keep a node from acting, and stands in no condition."""
    node = wiring.nodes[place]
    is_set = {(s.node, s.entry) for n in wiring.nodes for c in n.choices for s in c.sets}
    for wire in node.inputs:
        if wire.signal < 0:
            continue
        name = wiring.board[wire.signal].name
        if wire.outside is Outside.INHIBIT and (place, wire.entry) in is_set:
            yield f"{node.name}'s '{wire.entry}' keeps it from acting where {name} is outside"
        if not _is_number(wiring, wire.signal):
            yield f"{node.name} reads {name}, which may be no number"


def _is_number(wiring: Wiring, signal: int) -> bool:
    """Whether a signal is shown to be finite at all times."""
    writer = next((node for node in wiring.nodes if signal in node.outputs), None)
    if writer is None or (writer.behavior < 0 and writer.arbiter < 0):
        return True  # sensors, and user code, whose answers are checked
    column = writer.outputs.index(signal)
    if writer.behavior >= 0:
        program = wiring.programs[writer.behavior]
        return _is_finite(program.outputs[column].code, box_of(program))
    arbiter = wiring.arbiters[writer.arbiter]
    box = {one.name: (one.low, one.high) for one in arbiter.reads}
    box |= {one.name: (one.low, one.high) for one in arbiter.controls}
    box |= {one.name: (one.value, one.value) for one in arbiter.constants}
    if column < len(arbiter.outputs):
        return _is_finite(arbiter.outputs[column].code, box)
    choice = column - len(arbiter.outputs)
    if arbiter.paradigm is Paradigm.WEIGHTS and choice < len(arbiter.weights):
        return _is_finite(arbiter.weights[choice], box)
    return True


def _of_numbers(wiring: Wiring, node: Node) -> Iterator[str]:
    """What a behavior gives that is not shown to be finite."""
    if node.behavior < 0:
        return
    program = wiring.programs[node.behavior]
    box = box_of(program)
    commanded = {command.entry for command in node.commands}
    for output in program.outputs:
        if output.name in commanded and not _is_finite(output.code, box):
            yield f"'{output.name}' of {node.name} may be no number"
    for noise in program.noise:
        if not _is_finite(noise.size, box):
            yield f"the noise of '{noise.state}' of {node.name} may be no number"
    if _looks_ahead(node, program):
        within = _within_a_period(program, box, node.period)
        if within is None:
            yield f"a period ahead of {node.name} there may be no number"
            return
        box = within
    for state, rates in _rates(program, box).items():
        if rates is None:
            yield f"the rate of '{state}' of {node.name} may be no number"


def _looks_ahead(node: Node, program: Program) -> bool:
    """Whether its states are taken from where they are a period on (`runtime.scheduler.ticker`)."""
    takes = {c.entry for c in node.commands if c.mode == "set-point"} & set(program.field.driven)
    own = [s for s in program.states if s.role is Role.DRIVEN or s.name == program.field.mode]
    return not program.field.is_map and bool(takes or own)


def _within_a_period(program: Program, start: Box, period: float) -> Box | None:
    """A box that no state leaves within a period from `start`; None where none was found."""
    box = start
    for _ in range(ROUNDS):
        rates, jumps = _rates(program, box), _jumps(program, box)
        if any(value is None for value in (*rates.values(), *jumps.values())):
            return None
        wider = dict(start)
        for name, ends in jumps.items():
            wider[name] = _hull(wider[name], ends or wider[name])
        for name, ends in rates.items():
            size = period * max(map(abs, ends or (0.0, 0.0)))
            wider[name] = (wider[name][0] - size, wider[name][1] + size)
        if all(box[n][0] <= low and high <= box[n][1] for n, (low, high) in wider.items()):
            return box
        box = {name: _wider(ends) if ends != start[name] else ends for name, ends in wider.items()}
    return None


def _wider(ends: tuple[float, float]) -> tuple[float, float]:
    """Some more room, so that the next try may do."""
    room = 0.1 * (ends[1] - ends[0])
    return ends[0] - room, ends[1] + room


def _hull(one: tuple[float, float], other: tuple[float, float]) -> tuple[float, float]:
    return min(one[0], other[0]), max(one[1], other[1])


def _jumps(program: Program, box: Box) -> dict[str, tuple[float, float] | None]:
    """Where the states may jump to, at a change of the mode."""
    found: dict[str, tuple[float, float] | None] = {}
    for guard in program.field.guards:
        for name, code in guard.resets:
            ends, before = _ends(code, box), found.get(name, (math.inf, -math.inf))
            found[name] = None if ends is None or before is None else _hull(before, ends)
    return found


def _rates(program: Program, box: Box) -> dict[str, tuple[float, float] | None]:
    """The rate of each state that the field moves (of a map: its next value) over a box."""
    return {
        state.name: _of_rate(rate_of(program, i, Source.TABLES), program, box)
        for i, state in enumerate(program.states)
        if state.name in program.field.driven
    }


def _of_rate(rate: Code | Sum, program: Program, box: Box) -> tuple[float, float] | None:
    if isinstance(rate, Code):
        return _ends(rate, box)
    if not all(_is_finite(one.code, box) for one in program.field.coordinates):
        return None
    size = 0.0
    for code, table, column in rate.parts:
        ends = _ends(code, box)
        if ends is None:
            return None
        largest = 1.0
        if table >= 0:
            values = program.field.tables[table].coefficients[..., column]
            largest = OVERSHOOT * float(abs(values).max())
        size += max(map(abs, ends)) * largest
    return -size, size


def _is_finite(code: Code, box: Mapping[str, tuple[float, float]]) -> bool:
    return _ends(code, box) is not None


def _ends(code: Code, box: Mapping[str, tuple[float, float]]) -> tuple[float, float] | None:
    """The least and the greatest value; None where it may be no finite number."""
    found = interval_of(tree_of(code), box)
    if found.nan or found.is_empty or not all(map(math.isfinite, (found.low, found.high))):
        return None
    return found.low, found.high

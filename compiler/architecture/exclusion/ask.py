"""From the nodes of an architecture to the question whether two of them ever act at once."""

import itertools
from dataclasses import replace
from typing import Final, TypeAlias

from compiler.architecture.exclusion.firmness import doubt_of, is_number
from compiler.architecture.exclusion.question import (
    Actor,
    Decider,
    Entry,
    How,
    Limit,
    Outcome,
    Question,
    Signal,
)
from compiler.architecture.exclusion.wiring import WHAT, Wiring
from runtime.arbiter import Paradigm, Read
from runtime.architecture import Input, Outside
from runtime.code import ONE
from runtime.program import Constant, Control, Kind, State

HOW: Final = {
    Paradigm.RULES: How.FIRST,
    Paradigm.SUBSUMPTION: How.ALL,
    Paradigm.WEIGHTS: How.NUMBERS,
    Paradigm.COMPETITION: How.ANY,
    Paradigm.PLAN: How.ONE,
    Paradigm.MODULE: How.ANY,
}
Need: TypeAlias = tuple[Outcome, ...]
Part: TypeAlias = Read | State | Control | Constant


def question_of(wiring: Wiring, first: int, second: int) -> Question:
    """Whether the nodes `first` and `second` ever act at once."""
    combined = [
        place for place, node in enumerate(wiring.nodes) if {first, second} & set(node.replaces)
    ]
    who = [first, second, *combined]
    needs = [_needs(wiring, place) for place in who]
    used = sorted({place for many in needs for need in many for place, _ in need})
    deciders = [_decider(wiring, place) for place in used]
    read = sorted({e.signal for one in deciders for e in one.entries if e.signal >= 0})
    signals = _signals(wiring)
    # Where both act, what they need holds, and who alone can fulfil a need has decided.
    shared = {need for many in needs[:2] for need in many}
    given = {need[0][0] for need in shared if len({d for d, _ in need}) == 1}
    doubts = [doubt_of(wiring, many, set()) for many in needs[:2]]
    doubts += [
        doubt_of(wiring, tuple(need for need in many if need not in shared), given)
        for many in needs[2:]
    ]
    actors = [
        Actor(
            wiring.nodes[place].name,
            tuple(tuple((used.index(d), o) for d, o in need) for need in many),
            doubt,
        )
        for place, many, doubt in zip(who, needs, doubts, strict=True)
    ]
    return Question(
        signals=tuple(signals[place] for place in read),
        deciders=tuple(_renumbered(one, read) for one in deciders),
        first=actors[0],
        second=actors[1],
        unless=tuple(actors[2:]),
    )


def _renumbered(decider: Decider, read: list[int]) -> Decider:
    """The decider, with signals by their place among those that are read."""
    entries = tuple(
        replace(entry, signal=read.index(entry.signal)) if entry.signal >= 0 else entry
        for entry in decider.entries
    )
    return replace(decider, entries=entries)


def _signals(wiring: Wiring) -> tuple[Signal, ...]:
    rates = {sensor.name: (sensor.every, sensor.latency) for sensor in wiring.sensors}
    writers = {place: node for node in wiring.nodes for place in node.outputs}
    found = []
    for place, signal in enumerate(wiring.board):
        node = writers.get(place)
        if node is not None:
            every, delay = node.period, node.response_time
        else:
            every, delay = rates.get(signal.name.rpartition(".")[0], (0.0, 0.0))
        values = signal.values
        if signal.kind is Kind.DISCRETE and not values:
            values = tuple(str(i) for i in range(round(signal.low), round(signal.high) + 1))
        ends = (signal.low, signal.high)
        found.append(
            Signal(signal.name, signal.unit, *ends, values, every, delay, told=node is not None)
        )
    return tuple(found)


def _needs(wiring: Wiring, place: int) -> tuple[Need, ...]:
    """What must hold for a node to act: one outcome of each need."""
    node = wiring.nodes[place]
    own: list[Need] = [((place, 0),)] if node.arbiter < 0 else []
    for part in node.replaces:
        own += _needs(wiring, part)
    ways = []
    for other, governor in enumerate(wiring.nodes):
        naming = tuple((other, i) for i, one in enumerate(governor.choices) if place in one.acts)
        if naming:
            ways.append((naming, *_needs(wiring, other)))
    # One of the governors has its way: the conjunctions that this disjunction of them is.
    for combination in itertools.product(*ways) if ways else ():
        own.append(tuple(dict.fromkeys(outcome for need in combination for outcome in need)))
    return tuple(dict.fromkeys(own))


def _decider(wiring: Wiring, place: int) -> Decider:
    node = wiring.nodes[place]
    if node.arbiter < 0:
        return _condition(wiring, place)
    arbiter = wiring.arbiters[node.arbiter]
    parts: list[Part] = [*arbiter.reads, *arbiter.controls, *arbiter.constants]
    return Decider(
        name=node.name,
        what=WHAT.get(arbiter.paradigm, "an arbiter"),
        how=HOW[arbiter.paradigm],
        period=node.period,
        response_time=node.response_time,
        entries=tuple(_entry(wiring, place, part) for part in parts),
        outcomes=arbiter.choices,
        rules=arbiter.rules,
        codes=arbiter.weights,
    )


def _condition(wiring: Wiring, place: int) -> Decider:
    node = wiring.nodes[place]
    entries: tuple[Entry, ...] = ()
    if node.behavior >= 0:
        program = wiring.programs[node.behavior]
        parts: list[Part] = [*program.states, *program.controls, *program.constants]
        entries = tuple(_entry(wiring, place, part) for part in parts)
    return Decider(
        name=node.name,
        what="a behavior",
        how=How.CONDITION,
        period=node.period,
        response_time=node.response_time,
        entries=entries,
        outcomes=("acts",),
        codes=(node.acts_when or ONE,),
    )


def _entry(wiring: Wiring, place: int, part: Part) -> Entry:
    """What a name of a node's register is at its ticks."""
    if isinstance(part, Constant):
        return Entry(part.name, part.unit, part.value, part.value, values=(part.value,))
    labels = part.values if isinstance(part, Read | State) else ()
    free = Entry(part.name, part.unit, part.low, part.high, labels=labels)
    wire = next((w for w in wiring.nodes[place].inputs if w.entry == part.name), None)
    if wire is None:
        return free
    sets = tuple(
        setting.value
        for node in wiring.nodes
        for choice in node.choices
        for setting in choice.sets
        if setting.node == place and setting.entry == part.name
    )
    if wire.signal < 0:
        values = tuple(min(max(v, part.low), part.high) for v in (wire.value, *sets))
        return Entry(part.name, part.unit, part.low, part.high, values=values, labels=labels)
    if _may_latch_nothing(wiring, place, wire):
        return free
    is_angle = not isinstance(part, Control) and part.kind is Kind.PERIODIC
    return Entry(
        part.name,
        part.unit,
        part.low,
        part.high,
        signal=wire.signal,
        scale=wire.scale,
        limit=_limit(wire, is_angle=is_angle),
        labels=labels,
        sets=tuple(dict.fromkeys(sets)),
    )


def _may_latch_nothing(wiring: Wiring, place: int, wire: Input) -> bool:
    """Whether rules may remember what was no number, of which the lowest value is read.

    The arbiter does not decide by that; but a rule that began to hold there may go on.
    """
    arbiter = wiring.nodes[place].arbiter
    if arbiter < 0 or is_number(wiring, wire.signal):
        return False
    rules = wiring.arbiters[arbiter].rules
    return any(rule.until is not None or rule.lasts > 0.0 for rule in rules)


def _limit(wire: Input, *, is_angle: bool) -> Limit:
    if is_angle:
        return Limit.WRAPS
    return Limit.INHIBITS if wire.outside is Outside.INHIBIT else Limit.CLIPS

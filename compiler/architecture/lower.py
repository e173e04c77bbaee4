"""From the checked parts to the architecture that the runtime runs."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar, final

from compiler.architecture.parts import Part, Parts
from compiler.findings import Findings
from compiler.lower_parts import code_of, origin_of
from compiler.quantities import si_within
from compiler.scope import Scope, checked
from runtime.arbiter import Arbiter
from runtime.architecture import (
    Architecture,
    Channel,
    Choice,
    Command,
    Input,
    Node,
    Setting,
    Signal,
)
from runtime.code import Code
from runtime.program import Program
from spec_schema.dimension import DIMENSIONLESS, Dimension
from spec_schema.places import Path
from spec_schema.suggest import did_you_mean, there_are
from spec_schema.units import Unit, parse_unit

T = TypeVar("T", Program, Arbiter)
TRUTH = Unit("1", 1.0, DIMENSIONLESS)


def lower_acts_when(part: Part, findings: Findings) -> Code | None:
    """When a behavior acts, as code over its own register."""
    text, program = part.spec.acts_when, part.program
    if text is None or program is None:
        return None
    path = (*part.path, "acts_when")
    expr = checked(text, path, _scope(program), TRUTH, "the condition", findings)
    return None if expr is None else code_of(expr)


def _scope(program: Program) -> Scope:
    dimensions: dict[str, Dimension | None] = {
        part.name: parse_unit(part.unit.text).dimension
        for many in (program.states, program.controls, program.constants)
        for part in many
    }
    return Scope(dimensions, {state.name: state.values for state in program.states if state.values})


def check_replaces(part: Part, parts: Parts, findings: Findings) -> None:
    """Findings for a combined behavior whose parts are none."""
    for i, name in enumerate(part.spec.replaces):
        path = (*part.path, "replaces", i)
        others = [other for other in parts.nodes if other != part.name]
        if name not in others:
            remedy = did_you_mean(name, others) or there_are(others)
            findings.error("S322", path, f"no other node is named '{name}'", remedy)
        elif parts.nodes[name].spec.behavior is None:
            message = f"'{name}' is no behavior, and can't be replaced by one"
            findings.error("S349", path, message, "name the behaviors that are combined")
        elif parts.nodes[name].spec.replaces:
            message = f"'{name}' is a combined behavior itself"
            findings.error("S349", path, message, "name the behaviors that it combines")
    _check_overlap(part, parts, findings)
    if len(part.spec.replaces) == 1:
        message = "a combined behavior stands for two or more"
        remedy = "name all that it combines"
        findings.error("S349", (*part.path, "replaces"), message, remedy)


def _check_overlap(part: Part, parts: Parts, findings: Findings) -> None:
    """A finding where another combined behavior, named before, could take away one of the parts."""
    mine = part.spec.replaces
    for name, other in parts.nodes.items():
        if name == part.name:
            return
        theirs = other.spec.replaces
        shared = next((one for one in mine if one in theirs), None)
        if shared is not None and not (set(mine) <= set(theirs) or set(theirs) <= set(mine)):
            findings.error(
                "S349",
                (*part.path, "replaces", mine.index(shared)),
                f"{name} and {part.name} both combine '{shared}', and either may take it away "
                "from the other",
                f"let one of them combine all that the other does, such as "
                f"[{', '.join(dict.fromkeys((*theirs, *mine)))}], or no node in common",
            )
            return


def lower_choices(part: Part, parts: Parts, findings: Findings) -> tuple[Choice, ...]:
    """What each choice of an arbiter means; findings for those that mean nothing."""
    if part.arbiter is None:
        return ()
    known = part.arbiter.choices
    for name in part.spec.choices:
        if name not in known:
            message = f"{part.arbiter.name} has no choice '{name}'"
            remedy = did_you_mean(name, known) or there_are(known)
            findings.error("S323", (*part.path, "choices", name), message, remedy, key=True)
    return tuple(_choice(name, part, parts, findings) for name in known)


def _choice(name: str, part: Part, parts: Parts, findings: Findings) -> Choice:
    path: Path = (*part.path, "choices", name)
    origin = findings.origin(path)
    acting = part.spec.choices.get(name)
    if acting is None:
        at = (*part.path, "choices") if part.spec.choices else part.path
        message = f"nothing says what the choice '{name}' of {part.name} means"
        remedy = f"add '{name}: [NODE]' under `choices`, or '{name}: []' where nothing acts"
        findings.error("S325", at, message, remedy, key=True)
        return Choice(name, (), (), origin)
    acts = [
        parts.index(node)
        for i, node in enumerate(acting.act)
        if _can_act(node, part, parts, _place(path, i, findings), findings)
    ]
    sets = [
        _setting(key, value, (*path, "set", key), part, parts, findings)
        for key, value in acting.set.items()
    ]
    return Choice(name, tuple(acts), tuple(one for one in sets if one is not None), origin)


def _place(path: Path, i: int, findings: Findings) -> Path:
    """Where the i-th node of a choice stands: under `act`, in a list, or as a bare name."""
    places = (path, (*path, i), (*path, "act", i))
    return max((findings.written(place) for place in places), key=len)


def _can_act(node: str, part: Part, parts: Parts, path: Path, findings: Findings) -> bool:
    if node not in parts.nodes:
        others = [name for name in parts.nodes if name != part.name]
        remedy = did_you_mean(node, others) or there_are(others)
        findings.error("S322", path, f"no node is named '{node}'", remedy)
        return False
    if node == part.name:
        findings.error("S322", path, f"{node} can't choose itself", "name another node")
        return False
    return True


def _setting(
    key: str, value: float | str, path: Path, part: Part, parts: Parts, findings: Findings
) -> Setting | None:
    name, _, control = key.partition(".")
    other = parts.nodes.get(name)
    if other is None or name == part.name or not control:
        known = [
            f"{node}.{entry.name}"
            for node, one in parts.nodes.items()
            if node != part.name
            for entry in one.controls
        ]
        remedy = did_you_mean(key, known) or f"write NODE.CONTROL: {there_are(known)}"
        findings.error("S322", path, f"there is no control '{key}'", remedy, key=True)
        return None
    if not other.is_known:
        return None
    entry = next((entry for entry in other.controls if entry.name == control), None)
    if entry is None or entry.unit is None:
        known = [one.name for one in other.controls]
        remedy = did_you_mean(control, known) or there_are(known)
        findings.error("S322", path, f"'{control}' is no control of {name}", remedy, key=True)
        return None
    domain, unit = (entry.low, entry.high), parse_unit(entry.unit.text)
    found = si_within(value, key, domain, unit, "S333", path, findings)
    if found is None:
        return None
    return Setting(parts.index(name), control, found, findings.origin(path))


@final
@dataclass(frozen=True, eq=False, slots=True)
class Lowered:
    """The nodes as they run, and what they run."""

    nodes: tuple[Node, ...]
    programs: tuple[Program, ...]
    arbiters: tuple[Arbiter, ...]


def lower_nodes(
    parts: Parts,
    board: tuple[Signal, ...],
    inputs: Mapping[str, tuple[Input, ...]],
    commands: Mapping[str, tuple[Command, ...]],
    choices: Mapping[str, tuple[Choice, ...]],
    acts_when: Mapping[str, Code | None],
    levels: Mapping[str, int],
) -> Lowered:
    """The nodes; every part of them was found sound."""
    programs: list[Program] = []
    arbiters: list[Arbiter] = []
    nodes = [
        Node(
            name=name,
            period=part.period,
            response_time=part.response_time,
            level=levels[name],
            inputs=inputs[name],
            outputs=tuple(i for i, s in enumerate(board) if _is_of(s, part)),
            behavior=-1 if part.program is None else _kept(part.program, programs),
            arbiter=-1 if part.arbiter is None else _kept(part.arbiter, arbiters),
            module=part.spec.module or "",
            commands=commands[name],
            acts_when=acts_when[name],
            choices=choices[name],
            replaces=tuple(parts.index(other) for other in part.spec.replaces),
            origin=parts.loaded.origin(part.path),
        )
        for name, part in parts.nodes.items()
    ]
    return Lowered(tuple(nodes), tuple(programs), tuple(arbiters))


def lower(
    parts: Parts,
    board: tuple[Signal, ...],
    lowered: Lowered,
    channels: tuple[Channel, ...],
    order: tuple[int, ...],
) -> Architecture:
    """The architecture; every part of it was found sound."""
    assert parts.body is not None, "without a body there is an error"
    return Architecture(
        name=parts.spec.name,
        about=parts.spec.about or "",
        body=parts.body.body.name,
        board=board,
        nodes=lowered.nodes,
        channels=channels,
        programs=lowered.programs,
        arbiters=lowered.arbiters,
        order=order,
        source=origin_of(parts.loaded),
    )


def _is_of(signal: Signal, part: Part) -> bool:
    return signal.name.partition(".")[0] == part.name


def _kept(one: T, kept: list[T]) -> int:
    """The place of what several nodes may run, kept once."""
    for place, known in enumerate(kept):
        if known is one:
            return place
    kept.append(one)
    return len(kept) - 1

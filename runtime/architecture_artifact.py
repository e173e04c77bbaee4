"""The artifact of an architecture: one file with its wiring, its body and its behaviors' artifacts.

`architecture.json` and for each behavior `behaviors/N.specc`, the very artifact that it has by
itself, in a container of which every byte is determined and checked (`runtime.container`). It loads
without the compiler.
"""

import dataclasses
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Final, final

from runtime import artifact
from runtime.arbiter import LEARNERS, Arbiter, Paradigm
from runtime.architecture import Architecture, Node
from runtime.code import Code
from runtime.container import ArtifactError, Member, join, split
from runtime.document import Document
from runtime.program import Program
from runtime.tape import check_code
from runtime.world.model import Body


@final
@dataclass(frozen=True, eq=False, slots=True)
class Wired:
    """What stands in the document: an architecture whose programs are members, and its body.

    plans: for each arbiter the member that holds its plan, -1 for none.
    """

    architecture: Architecture
    body: Body
    plans: tuple[int, ...]


DOCUMENT: Final = Document("architecture", "wired", 2, Wired)


def to_bytes(architecture: Architecture, body: Body) -> bytes:
    """The artifact of an architecture and the body that it drives.

    Raises:
        ArtifactError: they do not fit together, or are too large.
    """
    for fault in faults(architecture, body):
        raise ArtifactError(f"'{architecture.name}' does not fit together: {fault}")
    programs = list(architecture.programs)
    plans = []
    for arbiter in architecture.arbiters:
        plans.append(-1 if arbiter.plan is None else len(programs))
        programs += [] if arbiter.plan is None else [arbiter.plan]
    arbiters = tuple(dataclasses.replace(one, plan=None) for one in architecture.arbiters)
    bare = dataclasses.replace(architecture, programs=(), arbiters=arbiters)
    members = [Member(DOCUMENT.name, memoryview(DOCUMENT.written(Wired(bare, body, tuple(plans)))))]
    members += [
        Member(_name(i), memoryview(artifact.to_bytes(program)))
        for i, program in enumerate(programs)
    ]
    return join(members)


def from_bytes(data: bytes) -> tuple[Architecture, Body]:
    """The architecture of an artifact, and its body.

    Raises:
        ArtifactError: the data was cut or altered, or is no artifact of this version.
    """
    members = split(memoryview(data))
    names = [DOCUMENT.name, *(_name(i) for i in range(len(members) - 1))]
    if [name for name, _ in members] != names:
        raise ArtifactError("the artifact has other parts than an architecture and its behaviors")
    wired: Wired = DOCUMENT.read(bytes(members[0].content))
    programs = [artifact.from_bytes(bytes(member.content)) for member in members[1:]]
    arbiters = tuple(_planned(wired, programs))
    plans = [place for place in wired.plans if place >= 0]
    count = len(programs) - len(plans)
    if plans != list(range(count, len(programs))):
        raise ArtifactError("the artifact was not written by specc")
    architecture = dataclasses.replace(
        wired.architecture, programs=tuple(programs[:count]), arbiters=arbiters
    )
    # One architecture, one artifact: nothing may stand in it that would not be written.
    if to_bytes(architecture, wired.body) != data:
        raise ArtifactError("the artifact was not written by specc")
    return architecture, wired.body


def is_architecture(data: bytes) -> bool:
    """Whether a container holds an architecture rather than a behavior."""
    return DOCUMENT.name in [name for name, _ in split(memoryview(data))]


def faults(architecture: Architecture, body: Body) -> Iterator[str]:
    """What in an architecture points to what there is not, each in a sentence."""
    nodes = len(architecture.nodes)
    if architecture.body != body.name:
        yield f"it drives '{architecture.body}', not '{body.name}'"
    if sorted(architecture.order) != list(range(nodes)):
        yield "its order does not name each node once"
    for node in architecture.nodes:
        yield from _of_node(node, architecture)
    for arbiter in architecture.arbiters:
        yield from _unreadable(arbiter.name, _codes(arbiter), arbiter.register)
        yield from _unlearned(arbiter)
    for channel in architecture.channels:
        resolution = channel.resolution
        if any(not 0 <= place < nodes for place in resolution.nodes):
            yield f"the channel '{channel.name}' is resolved between nodes that there are not"
        if not -1 <= resolution.arbiter < nodes:
            yield f"the channel '{channel.name}' is resolved by a node that there is not"


def _unlearned(arbiter: Arbiter) -> Iterator[str]:
    """A learned arbiter has rules, the last of which always holds."""
    if arbiter.learner not in {"", *LEARNERS}:
        yield f"'{arbiter.name}' learned by '{arbiter.learner}', which is not known"
    if not arbiter.learner:
        return
    is_of_rules = arbiter.paradigm is Paradigm.RULES
    if not is_of_rules or not arbiter.rules or arbiter.rules[-1].when is not None:
        yield f"'{arbiter.name}' learned, and has no rule that holds where no other does"


def _of_node(node: Node, architecture: Architecture) -> Iterator[str]:
    signals, nodes = len(architecture.board), len(architecture.nodes)
    places = [(wire.signal, signals) for wire in node.inputs if wire.signal >= 0]
    places += [(place, signals) for place in node.outputs]
    places += [(command.channel, len(architecture.channels)) for command in node.commands]
    places += [(place, nodes) for choice in node.choices for place in choice.acts]
    places += [(one.node, nodes) for choice in node.choices for one in choice.sets]
    places += [(place, nodes) for place in node.replaces]
    places += [(node.behavior, len(architecture.programs))] if node.behavior >= 0 else []
    places += [(node.arbiter, len(architecture.arbiters))] if node.arbiter >= 0 else []
    if any(not 0 <= place < count for place, count in places):
        yield f"the node '{node.name}' points to what there is not"
    if node.acts_when is not None and 0 <= node.behavior < len(architecture.programs):
        register = architecture.programs[node.behavior].register
        yield from _unreadable(node.name, [node.acts_when], register)
    if not (node.period > 0.0 and node.response_time >= 0.0):
        yield f"the node '{node.name}' has no period"


def _codes(arbiter: Arbiter) -> Iterator[Code]:
    """All code of an arbiter that the runtime runs."""
    yield from (output.code for output in arbiter.outputs)
    yield from arbiter.weights
    for rule in arbiter.rules:
        yield from (code for code in (rule.when, rule.until) if code is not None)
    if arbiter.competition is not None:
        yield from arbiter.competition.advantage
        yield from (code for row in arbiter.competition.suppression for code in row)


def _unreadable(name: str, codes: Iterable[Code], register: tuple[str, ...]) -> Iterator[str]:
    for code in codes:
        try:
            check_code(code, register)
        except ValueError as problem:
            yield f"code of '{name}' can't be run: {problem}"


def _name(place: int) -> str:
    return f"behaviors/{place}.specc"


def _planned(wired: Wired, programs: list[Program]) -> Iterator[Arbiter]:
    if len(wired.plans) != len(wired.architecture.arbiters):
        raise ArtifactError("the artifact does not say which arbiters have plans")
    for arbiter, place in zip(wired.architecture.arbiters, wired.plans, strict=True):
        if place >= len(programs):
            raise ArtifactError(f"the artifact lacks the plan of '{arbiter.name}'")
        plan: Any = programs[place] if place >= 0 else None
        yield dataclasses.replace(arbiter, plan=plan)

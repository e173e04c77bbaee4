"""A recorded architecture: each of its nodes judged by its own spec, where it had its way."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import final

from runtime.arbiter import Arbiter, Paradigm
from runtime.architecture import Architecture
from runtime.program import Program
from runtime.user_code import UserCodeError, where_is
from spec_schema.diagnostics import SpecError
from specc.verifying.arbiter import running
from verifier.architectures.nodes import NodeRecord, examine_behavior, examine_decisions
from verifier.architectures.telling import controls_as_recorded
from verifier.fidelity.verify import Judgement
from verifier.report.examination import Depth, Examination


@final
@dataclass(frozen=True, eq=False, slots=True)
class NodeVerdict:
    """A node, what it was judged by, and what its record shows.

    name: `robot.node`. judgement: of a behavior, for judging several recordings together.
    remarks: what has to be known of how it was judged.
    """

    name: str
    spec: Program | Arbiter
    examination: Examination
    judgement: Judgement | None
    remarks: tuple[str, ...] = ()


@final
@dataclass(frozen=True, slots=True)
class NotJudged:
    """A node, or more, of a recording of which nothing can be said: `source` says which."""

    source: str
    why: str


@final
@dataclass(frozen=True, slots=True)
class How:
    """How nodes are judged.

    beside: the folder in which code of the user's own is looked for; None: that of the file of each
    architecture, for one that was compiled just now. seed: of the run, which the chance of its
    arbiters follows from. only: their names; None for all. allow_code: whether arbiters that are
    code of the user's own may be run. is_named: whether a spec was named, which may not be the one
    that ran.
    """

    beside: Path | None
    seed: int = 0
    only: Collection[str] | None = None
    allow_code: bool = False
    depth: Depth = "all"
    is_named: bool = False


def examine_nodes(
    architecture: Architecture, records: Sequence[NodeRecord], source: str, how: How
) -> tuple[NodeVerdict | NotJudged, ...]:
    """Every node of one robot judged by its own spec, in the order of nodes.

    Behaviors are judged where they had their way; arbiters at every tick.
    """
    return tuple(
        _examined(architecture, place, record, source, how)
        for place, record in enumerate(records)
        if how.only is None or record.name in how.only
    )


def _examined(
    architecture: Architecture, place: int, record: NodeRecord, source: str, how: How
) -> NodeVerdict | NotJudged:
    node = architecture.nodes[place]
    named = f"{source}: {record.name}"
    if not record.times.size:
        is_module = node.behavior < 0 and node.arbiter < 0
        why = (
            "it is a module of the user's own, which promises nothing that could be judged"
            if is_module
            else "the recording holds no tick of it"
        )
        return NotJudged(named, why)
    try:
        if node.behavior >= 0:
            program = architecture.programs[node.behavior]
            made = examine_behavior(program, record, source, depth=how.depth)
            told = controls_as_recorded(program, record.columns) if how.is_named else ()
            examination = _with_notes(made.examination, told)
            return NodeVerdict(record.name, made.program, examination, made.judgement, told)
        arbiter = architecture.arbiters[node.arbiter]
        # What a recording or an artifact says of its source is somebody's word, and no folder.
        beside = Path(architecture.source.file).parent if how.beside is None else how.beside
        if arbiter.paradigm is Paradigm.MODULE and not how.allow_code:
            return NotJudged(named, _not_allowed(arbiter, beside))
        decides = running(arbiter, record.name, node.period, seed=how.seed, beside=beside)
        found = examine_decisions(arbiter, record, source, decides, depth=how.depth)
        return NodeVerdict(record.name, arbiter, found, None)
    except SpecError as error:
        return NotJudged(named, error.diagnostics[0].message)
    except UserCodeError as error:
        return NotJudged(named, str(error))


def _not_allowed(arbiter: Arbiter, beside: Path) -> str:
    place = where_is(arbiter.module, beside)
    return f"{arbiter.module} is code ({place}), which verify runs only with --allow-code"


def _with_notes(examination: Examination, notes: tuple[str, ...]) -> Examination:
    report = examination.report
    return replace(examination, report=replace(report, notes=(*notes, *report.notes)))

"""A recorded architecture: each of its nodes judged by its own spec, where it had its way."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

from runtime.arbiter import Paradigm
from runtime.architecture import Architecture
from spec_schema.diagnostics import SpecError
from specc.verifying_arbiter import running
from verifier.architectures.nodes import NodeRecord, examine_behavior, examine_decisions
from verifier.report.examination import Examination
from verifier.report.layout import table
from verifier.report.report import Verdict
from verifier.report.wording import seconds

WORST_FIRST: Final = (Verdict.FAIL, Verdict.INCONCLUSIVE, Verdict.PASS)


@final
@dataclass(frozen=True, eq=False, slots=True)
class NodeVerdict:
    """A node, and what its record shows; `why` it can't be judged where there is no examination."""

    name: str
    spec: str
    examination: Examination | None
    why: str


def examine_nodes(
    architecture: Architecture,
    records: Sequence[NodeRecord],
    source: str,
    *,
    only_verdict: bool = False,
) -> tuple[NodeVerdict, ...]:
    """Every node of one robot judged by its own spec, in the order of nodes.

    Behaviors are judged where they had their way; arbiters at every tick.
    """
    return tuple(
        _examined(architecture, place, record, source, only_verdict=only_verdict)
        for place, record in enumerate(records)
    )


def _examined(
    architecture: Architecture,
    place: int,
    record: NodeRecord,
    source: str,
    *,
    only_verdict: bool,
) -> NodeVerdict:
    node = architecture.nodes[place]
    if not record.times.size:
        return NodeVerdict(node.name, "", None, "it never had a tick")
    try:
        if node.behavior >= 0:
            program = architecture.programs[node.behavior]
            made = examine_behavior(program, record, source, only_verdict=only_verdict)
            return NodeVerdict(node.name, program.name, made, "")
        if node.arbiter < 0 or architecture.arbiters[node.arbiter].paradigm is Paradigm.MODULE:
            return NodeVerdict(
                node.name, node.module, None, "it is code, which verify does not run"
            )
        arbiter = architecture.arbiters[node.arbiter]
        decides = running(arbiter, node.name, node.period)
        made = examine_decisions(arbiter, record, source, decides, only_verdict=only_verdict)
        return NodeVerdict(node.name, arbiter.name, made, "")
    except SpecError as error:
        return NodeVerdict(node.name, "", None, error.diagnostics[0].message)


def verdict_of(found: Sequence[NodeVerdict]) -> Verdict | None:
    """The worst of all nodes that could be judged; None where none could."""
    verdicts = {each.examination.report.verdict for each in found if each.examination}
    return next((verdict for verdict in WORST_FIRST if verdict in verdicts), None)


def nodes_text(found: Sequence[NodeVerdict]) -> str:
    """A row for each node: its spec, the verdict, how long it was judged, and why."""
    return table([("node", "spec", "verdict", "judged", "why"), *(_row(each) for each in found)])


def _row(each: NodeVerdict) -> tuple[str, ...]:
    if each.examination is None:
        return (each.name, each.spec, "-", "-", each.why)
    report = each.examination.report
    why = "" if report.verdict is Verdict.PASS else "".join(report.reasons[:1])
    judged = f"{seconds(report.trace.judged)} of {seconds(report.trace.duration)}"
    return (each.name, each.spec, report.verdict.upper(), judged, why)

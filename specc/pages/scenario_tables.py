"""The tables of recordings of scenarios: what is required of them, and every node."""

from collections.abc import Iterator
from typing import Final

from specc.pages.page import RunRow, RunsTable
from specc.pages.report_page import SIGNS
from specc.runs import Pool, Runs, recording_of
from specc.texts.scenario_runs import (
    NODE_TITLES,
    node_row,
    nodes_of,
    pool_row,
    required_of,
)
from specc.verifying import Verification
from specc.verifying_architecture import NotJudged
from verifier.report.report import Standing, Verdict
from verifier.report.requirement_results import Outcome

STANDINGS: Final = {
    Verdict.FAIL: str(Standing.EXCEEDED),
    Verdict.INCONCLUSIVE: str(Standing.UNDECIDED),
    Verdict.PASS: "",
}
VERDICTS: Final = {
    Outcome.SATISFIED: Verdict.PASS,
    Outcome.VIOLATED: Verdict.FAIL,
    Outcome.OPEN: Verdict.INCONCLUSIVE,
}
NODES: Final = (
    "A behavior is judged where it had its way: where it acted, nobody else moved what it moves,"
    " and what it read was within its domain. An arbiter is judged at each of its ticks."
)
REQUIRED: Final = "A requirement is judged on the whole run; one that is open needs a longer one."


def scenario_tables(runs: Runs, anchors: dict[int, str]) -> Iterator[RunsTable]:
    """Both, where there is something to say. anchors: of pages, by the id of what is on them."""
    is_one = len({recording_of(each) for each in runs.outcomes}) == 1
    required = [*_required(runs, anchors, is_one=is_one)]
    if required:
        columns = ("what decides",) if is_one else ("recording", "what decides")
        yield RunsTable("Requirements", "required", columns, tuple(required), REQUIRED, words=True)
    nodes = [_node(each, anchors, is_one=is_one) for each in nodes_of(runs.outcomes)]
    nodes += [_pool(pool, anchors[id(pool)]) for pool in runs.pools if pool.members[0].part]
    if nodes:
        titles = (NODE_TITLES[1], *NODE_TITLES[3:])
        yield RunsTable("Nodes", "node", titles, tuple(nodes), NODES, words=True)


def _required(runs: Runs, anchors: dict[int, str], *, is_one: bool) -> Iterator[RunRow]:
    for each in required_of(runs.outcomes):
        for result in each.examination.requirements:
            verdict = VERDICTS[result.outcome]
            decides = (result.sentence, STANDINGS[verdict])
            cells = (decides,) if is_one else ((recording_of(each), ""), decides)
            yield RunRow(anchors[id(each)], result.text, str(verdict), SIGNS[verdict], cells, "")


def _node(each: Verification | NotJudged, anchors: dict[int, str], *, is_one: bool) -> RunRow:
    name, spec, _, judged, found = node_row(each, is_one=is_one)
    if isinstance(each, NotJudged):
        return RunRow("", name, "unjudged", "–", (), found)
    return _linked(anchors[id(each)], name, each.report.verdict, (spec, judged, found))


def _pool(pool: Pool, anchor: str) -> RunRow:
    name, spec, _, judged, found = pool_row(pool)
    return _linked(anchor, name, pool.report.verdict, (spec, judged, found))


def _linked(anchor: str, name: str, verdict: Verdict, told: tuple[str, str, str]) -> RunRow:
    spec, judged, found = told
    # A number and its unit stay on one line.
    lasted = judged.replace(" s", "\N{NO-BREAK SPACE}s")
    cells = ((spec, ""), (lasted, ""), (found, STANDINGS[verdict]))
    return RunRow(anchor, name, str(verdict), SIGNS[verdict], cells, "")

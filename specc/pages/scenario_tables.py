"""The tables of recordings of scenarios: what is required of them, and every node."""

from collections.abc import Iterator
from typing import Final

from specc.pages.page import RunRow, RunsTable
from specc.pages.report_page import SIGNS
from specc.texts.runs import FAILS
from specc.texts.scenario_runs import (
    NODE_TITLES,
    RequirementRow,
    left_out,
    node_row,
    nodes_of,
    pool_row,
    pools_of_nodes,
    required_of,
    requirement_rows,
)
from specc.verifying.architecture import NotJudged
from specc.verifying.runs import Pool, Runs, decided, is_of_one
from specc.verifying.trace import Verification
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
    is_one = is_of_one(runs.outcomes)
    required = [*_required(runs, anchors)]
    if required:
        columns = ("what decides",) if is_one else ("in", "what decides")
        yield RunsTable("Requirements", "required", columns, tuple(required), REQUIRED, words=True)
    titles = (NODE_TITLES[1], *NODE_TITLES[3:])
    pools = tuple(_pool(pool, anchors[id(pool)]) for pool in pools_of_nodes(runs))
    if pools:
        how = ". ".join((f"{NODES} {FAILS[:-1]}", *left_out(runs)))
        title = "Nodes, of all recordings together"
        yield RunsTable(title, "node", titles, pools, how, words=True)
    nodes = tuple(_node(each, anchors, is_one=is_one) for each in nodes_of(runs.outcomes))
    if nodes:
        title, how = ("Nodes, of each recording by itself", "") if pools else ("Nodes", NODES)
        yield RunsTable(title, "node", titles, nodes, how, words=True)


def _required(runs: Runs, anchors: dict[int, str]) -> Iterator[RunRow]:
    every = required_of(runs.outcomes)
    for row in requirement_rows(every):
        verdict = VERDICTS[row.outcome]
        decides = ("; ".join(row.told), STANDINGS[verdict])
        is_one = is_of_one(runs.outcomes)
        cells = (decides,) if is_one else ((row.count, ""), decides)
        worst = next(each for each in every if _has(each, row))
        yield RunRow(anchors[id(worst)], row.text, str(verdict), SIGNS[verdict], cells, "")


def _has(each: Verification, row: RequirementRow) -> bool:
    """Whether the row's outcome is in this recording."""
    return any(
        result.outcome is row.outcome and row.text.endswith(result.text)
        for result in each.examination.requirements
    )


def _node(each: Verification | NotJudged, anchors: dict[int, str], *, is_one: bool) -> RunRow:
    name, spec, _, judged, found = node_row(each, is_one=is_one)
    if isinstance(each, NotJudged):
        return RunRow("", name, "unjudged", "–", (), found)
    return _linked(anchors[id(each)], name, each.report.verdict, (spec, judged, found))


def _pool(pool: Pool, anchor: str) -> RunRow:
    name, spec, _, judged, found = pool_row(pool)
    return _linked(anchor, name, decided(pool), (spec, judged, found))


def _linked(anchor: str, name: str, verdict: Verdict, told: tuple[str, str, str]) -> RunRow:
    spec, judged, found = told
    # A number and its unit stay on one line.
    lasted = judged.replace(" s", "\N{NO-BREAK SPACE}s")
    cells = ((spec, ""), (lasted, ""), (found, STANDINGS[verdict]))
    return RunRow(anchor, name, str(verdict), SIGNS[verdict], cells, "")

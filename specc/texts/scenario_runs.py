"""Recordings of scenarios as text: what is required of them, and a row for each node."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final, final

from specc.verifying.architecture import NotJudged
from specc.verifying.recording import REQUIREMENTS
from specc.verifying.runs import Outcome as Judged
from specc.verifying.runs import (
    Pool,
    Runs,
    decided,
    failing,
    is_of_one,
    not_judged,
    recording_of,
    verifications,
)
from specc.verifying.trace import Verification
from verifier.arbitration.saying import changes_phrase
from verifier.report.arbitration import Arbitration
from verifier.report.examination import Examination
from verifier.report.report import Report, Standing, VariableResult, Verdict
from verifier.report.requirement_results import Outcome, RequirementResult
from verifier.report.situations import stands
from verifier.report.wording import LEFT_OUT, percent, quantity, seconds

NODE_TITLES = ("node", "spec", "verdict", "judged", "what was found")
REQUIREMENT_TITLES = ("required", "outcome", "what decides")
STANDINGS = (Standing.EXCEEDED, Standing.UNDECIDED, Standing.WITHIN)
"""The worst first."""
OUTCOMES: Final = (Outcome.VIOLATED, Outcome.OPEN, Outcome.SATISFIED)
"""The worst first."""
MOST_TOLD: Final = 5
"""In so many recordings it is told what a requirement makes violated, or open."""


def nodes_of(outcomes: Sequence[Judged]) -> tuple[Verification | NotJudged, ...]:
    """The nodes of recordings of scenarios."""
    return tuple(
        each
        for each in outcomes
        if isinstance(each, NotJudged)
        or (isinstance(each, Verification) and each.part and each.part != REQUIREMENTS)
    )


def required_of(outcomes: Sequence[Judged]) -> tuple[Verification, ...]:
    """What recordings of scenarios show of their requirements."""
    return tuple(each for each in verifications(outcomes) if each.part == REQUIREMENTS)


def node_row(each: Verification | NotJudged, *, is_one: bool) -> tuple[str, ...]:
    """A node, its spec, the verdict, how much was judged, and by how much it departs.

    is_one: whether there is one recording only, whose name need not be said.
    """
    if isinstance(each, NotJudged):
        name = each.source.removeprefix(f"{recording_of(each)}: ") if is_one else each.source
        return (name, "", "-", "-", each.why)
    report = each.report
    judged = f"{seconds(report.trace.judged)} of {seconds(report.trace.duration)}"
    name = each.part if is_one else report.trace.source
    return (name, report.spec.name, report.verdict.upper(), judged, found_in(each.examination))


def node_rows(runs: Runs) -> Iterator[tuple[str, ...]]:
    """Every node; one of several recordings by all together, and those that fail by themselves."""
    is_one, members = is_of_one(runs.outcomes), runs.members
    for pool in pools_of_nodes(runs):
        yield pool_row(pool)
        yield from (
            (f"  {recording_of(each)}", *node_row(each, is_one=False)[1:]) for each in failing(pool)
        )
    alone = [each for each in nodes_of(runs.outcomes) if each not in members]
    judged = [each for each in alone if isinstance(each, Verification)]
    yield from (node_row(each, is_one=is_one) for each in judged)
    yield from _unjudged_rows(not_judged(alone), is_one=is_one)


def _unjudged_rows(every: Sequence[NotJudged], *, is_one: bool) -> Iterator[tuple[str, ...]]:
    """A row for each node and reason, however many recordings have it."""
    alike: dict[tuple[str, str], list[NotJudged]] = {}
    for each in every:
        part = each.source.removeprefix(f"{recording_of(each)}: ")
        alike.setdefault((part, each.why), []).append(each)
    for (part, why), found in alike.items():
        if len(found) == 1:
            yield node_row(found[0], is_one=is_one)
        else:
            yield (part, "", "-", f"{len(found)} recordings", why)


def pools_of_nodes(runs: Runs) -> tuple[Pool, ...]:
    """What several recordings of scenarios say together, of each node."""
    return tuple(pool for pool in runs.pools if pool.members[0].part)


def pool_row(pool: Pool) -> tuple[str, ...]:
    """A node in several recordings together."""
    trace, members = pool.report.trace, len(pool.members)
    counted = trace.source.partition(" together")[0]
    judged = f"{seconds(trace.judged)} of {seconds(trace.duration)}, {counted}"
    found, fails = found_in(pool.examination), len(failing(pool))
    if fails and pool.report.verdict is not Verdict.FAIL:
        found = f"{fails} of {members} fail by themselves; together: {found}"
    name = pool.members[0].part
    return (name, pool.report.spec.name, decided(pool).upper(), judged, found)


def left_out(runs: Runs) -> tuple[str, ...]:
    """Of each node that fewer recordings are judged of than were given: which not, and why."""
    return tuple(
        f"{pool.members[0].part}: {_without_part(reason, pool.members[0].part)}"
        for pool in pools_of_nodes(runs)
        for reason in pool.report.reasons
        if LEFT_OUT in reason
    )


def _without_part(reason: str, part: str) -> str:
    source, said, why = reason.partition(LEFT_OUT)
    return f"{source.removesuffix(f': {part}')}{said}{why}"


def found_in(examination: Examination) -> str:
    """By how much the worst variable departs, or how often it decides as the spec."""
    report = examination.report
    if examination.arbitration is not None:
        return _agreement(examination.arbitration, report.verdict)
    if not report.variables:
        return "" if report.verdict is Verdict.PASS else "".join(report.reasons[:1])
    worst = min((each.standing for each in report.variables), key=STANDINGS.index)
    told = [_departs(report, each) for each in report.variables if each.standing is worst]
    if worst is Standing.WITHIN and report.verdict is not Verdict.PASS:
        told.append("what else is open, or fails, is told below")
    return "; ".join(told)


def _agreement(of: Arbitration, verdict: Verdict) -> str:
    """How often it decides as the spec, and whether that is too little to tell."""
    share = of.share
    told = f"{share.agreeing} of {share.decisions} decisions agree, over {changes_phrase(of)}"
    if verdict is Verdict.INCONCLUSIVE and share.decisions and of.required < 1.0:
        told += f": too few to tell whether {percent(of.required)} do"
    return told


def _departs(report: Report, result: VariableResult) -> str:
    """By how much a variable departs, and whether standing still would have done as well."""
    departure = quantity(result.declared.departure, result.unit)
    allowed = f"{quantity(result.tolerance, result.unit)} allowed after {seconds(report.horizon)}"
    if result.allowed_scatter > 0.0:
        allowed += f" beside {quantity(result.allowed_scatter, result.unit)} of scatter"
    weak = ""
    if report.verdict is Verdict.PASS and result.hardly_moves:
        weak = f" (weak evidence: it moved by {quantity(result.moved, result.unit)} only)"
    return f"{result.name} departs by {departure}, {allowed}: {stands(result)}{weak}"


@final
@dataclass(frozen=True, slots=True)
class RequirementRow:
    """One requirement, in one recording or in several: `told` what decides, the worst first."""

    text: str
    outcome: Outcome
    count: str
    told: tuple[str, ...]


def requirement_rows(every: Sequence[Verification]) -> Iterator[RequirementRow]:
    """A row for each requirement of each scenario, however many recordings there are of it."""
    alike: dict[tuple[str, str], list[tuple[str, RequirementResult]]] = {}
    for each in every:
        for result in each.examination.requirements:
            key = (each.report.spec.name, result.text)
            alike.setdefault(key, []).append((recording_of(each), result))
    is_mixed = len({scenario for scenario, _ in alike}) > 1
    for (scenario, text), found in alike.items():
        yield _requirement_row(f"{scenario}: {text}" if is_mixed else text, found)


def _requirement_row(text: str, found: Sequence[tuple[str, RequirementResult]]) -> RequirementRow:
    if len(found) == 1:
        result = found[0][1]
        return RequirementRow(text, result.outcome, str(result.outcome), (result.detail,))
    outcomes = [result.outcome for _, result in found]
    worst = next(each for each in OUTCOMES if each in outcomes)
    count = f"{worst} in {outcomes.count(worst)} of {len(found)}"
    of_worst = [each for each in found if each[1].outcome is worst]
    of_worst.sort(key=lambda each: each[1].robustness)
    if worst is Outcome.SATISFIED:
        source, result = of_worst[0]
        least = f"least in {source}: {result.detail}" if result.detail else ""
        return RequirementRow(text, worst, count, (least,))
    told = [f"{source}: {result.detail}" for source, result in of_worst[:MOST_TOLD]]
    more = len(of_worst) - MOST_TOLD
    told += [f"and {more} more"] if more > 0 else []
    return RequirementRow(text, worst, count, tuple(told))

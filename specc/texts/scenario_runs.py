"""Recordings of scenarios as text: what is required of them, and a row for each node."""

from collections.abc import Iterator, Sequence

from specc.runs import Outcome, Pool, recording_of, verifications
from specc.verifying import Verification
from specc.verifying_architecture import NotJudged
from specc.verifying_recording import REQUIREMENTS
from verifier.report.examination import Examination
from verifier.report.report import Standing, Verdict
from verifier.report.wording import quantity, seconds

NODE_TITLES = ("node", "spec", "verdict", "judged", "what was found")
REQUIREMENT_TITLES = ("required", "outcome", "what decides")
STANDINGS = (Standing.EXCEEDED, Standing.UNDECIDED, Standing.WITHIN)
"""The worst first."""


def nodes_of(outcomes: Sequence[Outcome]) -> tuple[Verification | NotJudged, ...]:
    """The nodes of recordings of scenarios."""
    return tuple(
        each
        for each in outcomes
        if isinstance(each, NotJudged)
        or (isinstance(each, Verification) and each.part and each.part != REQUIREMENTS)
    )


def required_of(outcomes: Sequence[Outcome]) -> tuple[Verification, ...]:
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


def pool_row(pool: Pool) -> tuple[str, ...]:
    """A node in several recordings together."""
    report = pool.report
    judged = f"{seconds(report.trace.judged)} of {seconds(report.trace.duration)}"
    what = found_in(pool.examination)
    return (report.trace.source, report.spec.name, report.verdict.upper(), judged, what)


def found_in(examination: Examination) -> str:
    """By how much the worst variable departs, or how often it decides as the spec."""
    report = examination.report
    if examination.arbitration is not None:
        share = examination.arbitration.share
        return f"{share.agreeing} of {share.decisions} decisions agree"
    if not report.variables:
        return "" if report.verdict is Verdict.PASS else "".join(report.reasons[:1])
    worst = min(report.variables, key=lambda result: STANDINGS.index(result.standing))
    departure = quantity(worst.declared.departure, worst.unit)
    allowed = f"{quantity(worst.tolerance, worst.unit)} allowed after {seconds(report.horizon)}"
    return f"{worst.name} departs by {departure}, {allowed}: {worst.standing}"


def requirement_rows(every: Sequence[Verification], *, is_one: bool) -> Iterator[tuple[str, ...]]:
    """A row for each requirement of each recording."""
    for each in every:
        for result in each.examination.requirements:
            row = (result.text, str(result.outcome), result.sentence)
            yield row if is_one else (recording_of(each), *row)

"""Findings: what a report has to say, one by one, each with the line of the spec it is about.

They are what CI systems show beside the code. Errors are what makes a verdict FAIL, warnings what
makes it INCONCLUSIVE or what a section finds wrong, notes the rest.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Final, final

from verifier.report.arbitration import Arbitration, ThresholdStanding
from verifier.report.diagnosis import Diagnosis
from verifier.report.examination import Examination
from verifier.report.features import Features, FeatureStanding
from verifier.report.report import Report, Standing, VariableResult, Verdict
from verifier.report.requirement_results import Outcome, RequirementResult
from verifier.report.situations import exceeded
from verifier.report.switching import Switching, Way
from verifier.report.wording import exact, percent, quantity, seconds, span


@final
class Level(StrEnum):
    """How grave a finding is."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


@final
class Rule(StrEnum):
    """What kind of finding it is; stable, so that CI systems can follow one over time."""

    EXCEEDED = "tolerance-exceeded"
    UNDECIDED = "tolerance-undecided"
    COVERAGE = "region-not-seen"
    INCONCLUSIVE = "inconclusive"
    SWITCHING = "mode-change"
    DECISIONS = "decisions-differ"
    THRESHOLD = "threshold"
    REQUIREMENT = "requirement"
    FEATURE = "feature-differs"
    DIAGNOSIS = "diagnosis"
    NOT_TOLD = "not-told"
    LOSS = "lost-in-the-log"
    NOT_JUDGED = "not-judged"
    UNUSABLE = "trace-unusable"


MEANINGS: Final = {
    Rule.EXCEEDED: "A variable departs from its prediction by more than its tolerance.",
    Rule.UNDECIDED: "The trace does not decide whether a variable stays within its tolerance.",
    Rule.COVERAGE: "Too little of the declared region was seen for a PASS.",
    Rule.INCONCLUSIVE: "The trace allows no verdict.",
    Rule.SWITCHING: "A change of mode comes at another time, or leads elsewhere.",
    Rule.DECISIONS: "The robot decides otherwise than its arbiter's spec.",
    Rule.THRESHOLD: "A threshold by which the robot decides is not where the spec has it.",
    Rule.REQUIREMENT: "A run does not do what its scenario requires, or is too short to tell.",
    Rule.FEATURE: "An attractor, saddle or cycle of the robot is not where the spec has it.",
    Rule.DIAGNOSIS: "What would explain that the robot departs from its spec.",
    Rule.NOT_TOLD: "Something about the robot that this trace leaves open.",
    Rule.LOSS: "Something in the log could not be used.",
    Rule.NOT_JUDGED: "A node of a recording of which nothing can be said.",
    Rule.UNUSABLE: "A trace, or the spec that it is judged by, can't be used.",
}
"""A sentence for each rule."""


@final
@dataclass(frozen=True, slots=True)
class Finding:
    """One thing to know. subject: the variable or part it is about; origin: `file:line:column`."""

    rule: Rule
    level: Level
    subject: str
    message: str
    origin: str


def findings_of(examination: Examination) -> tuple[Finding, ...]:
    """All findings, the gravest first."""
    found = [
        *_of_report(examination.report, examination.origins.get("fidelity", "")),
        *_of_switching(examination.switching),
        *_of_arbitration(examination.report, examination.arbitration),
        *_of_requirements(examination.requirements),
        *_of_features(examination.features),
        *_of_diagnosis(examination.diagnosis),
        *_of_limits(examination),
        *_of_losses(examination),
    ]
    order = list(Level)
    return tuple(sorted(found, key=lambda finding: order.index(finding.level)))


def departs(report: Report, result: VariableResult) -> str:
    """How far one variable departs, as a sentence.

    `x departs by 0.031 m after 2 s (95 % interval 0.02 to 0.04 m); the tolerance is 0.05 m`.
    Of one that exceeds its tolerance, where it does and in which direction.
    """
    if result.standing is Standing.EXCEEDED:
        return exceeded(result, report.units)
    at, unit = result.declared, result.unit
    interval = span(at.interval.low, at.interval.high, unit)
    return (
        f"{result.name} departs by {quantity(at.departure, unit)} after {seconds(report.horizon)}"
        f" ({percent(report.confidence)} interval {interval});"
        f" the tolerance is {quantity(result.tolerance, unit)}"
    )


def _of_report(report: Report, fidelity: str) -> Iterator[Finding]:
    for result in report.variables:
        message = departs(report, result)
        if result.standing is Standing.EXCEEDED:
            yield Finding(Rule.EXCEEDED, Level.ERROR, result.name, message, result.origin)
        elif result.standing is Standing.UNDECIDED:
            yield Finding(Rule.UNDECIDED, Level.WARNING, result.name, message, result.origin)
    if report.coverage is not None and not report.coverage.is_reached:
        message = (
            f"{percent(report.coverage.share)} of the region was seen,"
            f" {percent(report.coverage.required)} is required"
        )
        yield Finding(Rule.COVERAGE, Level.WARNING, "coverage", message, fidelity)
    if report.verdict is Verdict.INCONCLUSIVE:
        message = "; ".join(report.reasons[:1])
        yield Finding(Rule.INCONCLUSIVE, Level.WARNING, "verdict", message, fidelity)


def _of_switching(switching: Switching | None) -> Iterator[Finding]:
    for way in () if switching is None else switching.ways:
        if way.standing is Standing.EXCEEDED:
            yield _of_way(way, Level.ERROR, "differs from the spec")
        elif way.standing is Standing.UNDECIDED and way.expected + way.unexpected + way.missed:
            yield _of_way(way, Level.WARNING, "is undecided")


def _of_arbitration(report: Report, of: Arbitration | None) -> Iterator[Finding]:
    if of is None:
        return
    if report.verdict is Verdict.FAIL:
        message = "; ".join(report.reasons)
        yield Finding(Rule.DECISIONS, Level.ERROR, "choice", message, of.origin)
    for each in of.thresholds:
        if each.standing is ThresholdStanding.MOVED:
            at = exact(each.fitted, each.unit)
            own = exact(each.value, each.unit)
            message = f"the robot decides {each.comparison} at {at}, the spec at {own}"
            yield Finding(Rule.THRESHOLD, Level.WARNING, each.name, message, each.origin)


def _of_requirements(results: Sequence[RequirementResult]) -> Iterator[Finding]:
    levels = {Outcome.VIOLATED: Level.ERROR, Outcome.OPEN: Level.WARNING}
    for each in results:
        if each.outcome in levels:
            message = f"{each.text}: {each.sentence}"
            yield Finding(Rule.REQUIREMENT, levels[each.outcome], each.text, message, each.origin)


def _of_way(way: Way, level: Level, what: str) -> Finding:
    counts = (
        f"{way.expected} as expected, {way.unexpected} unexpected, {way.missed} missed,"
        f" {way.wrong} to another mode"
    )
    subject = f"{way.source} to {way.target}"
    late = "" if way.timing is None else f", {seconds(way.timing.late)} late on average"
    message = f"the change from {subject} {what}: {counts}{late}"
    return Finding(Rule.SWITCHING, level, subject, message, way.origin)


def _of_features(features: Features | None) -> Iterator[Finding]:
    for feature in () if features is None else features.features:
        if feature.standing is FeatureStanding.EXCEEDED:
            sentence = feature.sentence
            yield Finding(Rule.FEATURE, Level.WARNING, feature.name, sentence, feature.origin)


def _of_diagnosis(diagnosis: Diagnosis | None) -> Iterator[Finding]:
    if diagnosis is None:
        return
    for number in diagnosis.refitted:
        if number.is_moved:
            yield Finding(Rule.DIAGNOSIS, Level.NOTE, number.name, number.sentence, number.origin)
    for candidate in diagnosis.candidates:
        if candidate.is_taken:
            yield Finding(
                Rule.DIAGNOSIS, Level.NOTE, candidate.label, candidate.sentence, candidate.origin
            )


def _of_limits(examination: Examination) -> Iterator[Finding]:
    for each in () if examination.limits is None else examination.limits.not_told:
        message = f"this trace does not tell {each.what}: {each.why}; {each.suggestion}"
        yield Finding(Rule.NOT_TOLD, Level.NOTE, each.what, message, each.origin)


def _of_losses(examination: Examination) -> Iterator[Finding]:
    origin = examination.origins.get("fidelity", "")
    for loss in examination.report.losses:
        message = f"{loss.cause}, {loss.count} x: {loss.detail}"
        yield Finding(Rule.LOSS, Level.NOTE, loss.cause, message, origin)

"""What a spec demands of a robot, one by one, and whether this trace shows it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final, final

from verifier.report.examination import Examination
from verifier.report.findings import departs
from verifier.report.report import Coverage, Report, Standing, Verdict
from verifier.report.requirement_results import Outcome, RequirementResult
from verifier.report.switching import Switching
from verifier.report.wording import percent, quantity, seconds

OVERALL: Final = {
    Verdict.PASS: Standing.WITHIN,
    Verdict.FAIL: Standing.EXCEEDED,
    Verdict.INCONCLUSIVE: Standing.UNDECIDED,
}

WHOLE: Final = "does what the spec says"
"""The name of the verdict as a whole."""
OUTCOMES: Final = {
    Outcome.SATISFIED: Standing.WITHIN,
    Outcome.VIOLATED: Standing.EXCEEDED,
    Outcome.OPEN: Standing.UNDECIDED,
}


@final
@dataclass(frozen=True, slots=True)
class Requirement:
    """One demand: `name` does not change from trace to trace, `message` says what was found."""

    name: str
    standing: Standing
    message: str
    origin: str


def requirements_of(examination: Examination) -> tuple[Requirement, ...]:
    """What a run requires; or the verdict as a whole, variables, the region, changes of mode."""
    report = examination.report
    fidelity = examination.origins.get("fidelity", "")
    reasons = "\n".join(report.reasons)
    if examination.requirements:  # each of them is one, and nothing else is
        return tuple(_of_run(examination.requirements))
    return (
        Requirement(WHOLE, OVERALL[report.verdict], reasons, fidelity),
        *_variables(report),
        *_region(report.coverage, fidelity),
        *_ways(examination.switching),
    )


def _variables(report: Report) -> Iterator[Requirement]:
    after = seconds(report.horizon)
    for result in report.variables:
        tolerance = quantity(result.tolerance, result.unit)
        name = f"{result.name} within {tolerance} after {after}"
        yield Requirement(name, result.standing, departs(report, result), result.origin)


def _region(coverage: Coverage | None, origin: str) -> Iterator[Requirement]:
    if coverage is not None and coverage.required > 0.0:
        name = f"at least {percent(coverage.required)} of the region seen"
        standing = Standing.WITHIN if coverage.is_reached else Standing.UNDECIDED
        yield Requirement(name, standing, f"{percent(coverage.share)} was seen", origin)


def _ways(switching: Switching | None) -> Iterator[Requirement]:
    for way in () if switching is None else switching.ways:
        message = (
            f"{way.expected} as expected, {way.unexpected} unexpected, {way.missed} missed,"
            f" {way.wrong} to another mode"
        )
        name = f"{switching.mode if switching else ''}: {way.source} to {way.target}"
        yield Requirement(name, way.standing, message, way.origin)


def _of_run(results: Sequence[RequirementResult]) -> Iterator[Requirement]:
    for result in results:
        standing = OUTCOMES[result.outcome]
        yield Requirement(result.text, standing, result.sentence, result.origin)

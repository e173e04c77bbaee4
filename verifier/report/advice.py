"""What to do next, where more than the verdict is known: why the robot departs."""

from dataclasses import replace
from typing import Final

from verifier.report.diagnosis import Candidate, CandidateKind, Diagnosis, Told
from verifier.report.report import Report, Standing, Verdict
from verifier.report.switching import Switching
from verifier.report.wording import listed, quantity

WITHOUT_SIZE: Final = {
    CandidateKind.SIGN,
    CandidateKind.SWAPPED_AXES,
    CandidateKind.UNIT_SLIP,
    CandidateKind.REGION,
}
"""Explanations that say all without their number."""
CHECK_FIRST: Final = (
    "before blaming the robot, check units, signs and the `delay:` of every entry in `trace:`"
)
"""Where a robot departs and nothing is known of why."""
MOST: Final = 3
"""So many explanations are named, at most."""


def advised(report: Report, diagnosis: Diagnosis, switching: Switching | None) -> Report:
    """The report, its advice begun by what would settle that the robot departs.

    A PASS needs none, and where nothing was compared the report's own advice comes first.
    """
    if report.verdict is Verdict.PASS or not report.variables:
        return report
    known = (*_of_diagnosis(report, diagnosis), *_of_switching(switching))
    rest = [each for each in report.advice if not (known and each == CHECK_FIRST)]
    return replace(report, advice=tuple(dict.fromkeys((*known, *rest))))


def _of_diagnosis(report: Report, diagnosis: Diagnosis) -> list[str]:
    taken = [each for each in diagnosis.candidates if each.is_taken][:MOST]
    if diagnosis.told not in {Told.SAME_STRUCTURE, Told.STRUCTURE_DIFFERS} or not taken:
        return []
    own = {each.name for each in diagnosis.refitted if each.is_moved}
    if all(_is_own(each, own) for each in taken):
        numbers = listed([_number(each, own) for each in taken])
        fit = f"specc fit {report.trace.source} --spec {report.spec.file}"
        return [
            (
                f"if the robot is as it should be, the spec has to say {numbers} (`{fit}` edits"
                " it); else mend the robot"
            )
        ]
    return [f"settle first what explains it: {listed([_number(each, own) for each in taken])}"]


def _is_own(candidate: Candidate, own: set[str]) -> bool:
    """Whether it is a number of the spec with a name; own: those that were moved."""
    is_of_guard = candidate.kind is CandidateKind.GUARD and own.issuperset(candidate.applies_to)
    return is_of_guard or candidate.kind is CandidateKind.PARAMETER


def _number(candidate: Candidate, own: set[str]) -> str:
    """An explanation with its size, where it has one."""
    if not candidate.numbers or candidate.kind in WITHOUT_SIZE:
        return candidate.label
    number = candidate.numbers[0]
    size = quantity(abs(number.value) if number.name == "delay" else number.value, number.unit)
    label = candidate.label
    return f"{label} = {size}" if _is_own(candidate, own) else f"{label} ({size})"


def _of_switching(switching: Switching | None) -> list[str]:
    if switching is None or switching.standing is not Standing.EXCEEDED:
        return []
    mode = switching.mode
    return [f"check the conditions under `leave:` in the spec, and how late the log tells {mode}"]

"""What to do next, where more than the verdict is known: why the robot departs."""

import math
import re
from collections.abc import Collection
from dataclasses import replace
from typing import Final

from runtime.program import Program
from verifier.report.diagnosis import Candidate, CandidateKind, Diagnosis, Told
from verifier.report.entries import entries_of
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
MOSTLY: Final = 0.6
"""What is named explains at least this share of what departs."""
MOST: Final = 3
"""So many explanations are named, at most."""


def advised(
    report: Report,
    diagnosis: Diagnosis,
    switching: Switching | None,
    program: Program | None = None,
    moot: Collection[str] = (),
) -> Report:
    """The report, its advice begun by what would settle that the robot departs.

    A PASS needs none. Where nothing was compared, only another reading of the log is advised.

    Args:
        program: has the entries of `trace:` that may have to say something else.
        moot: advice on how to decide the verdict, which is of no use where it is known why.
    """
    is_unread = not report.variables and diagnosis.told is not Told.LOG_DIFFERS
    if report.verdict is Verdict.PASS or is_unread:
        return report
    known = (*_of_diagnosis(report, diagnosis, program), *_of_switching(switching))
    is_explained = bool(known) and _is_explained(diagnosis)
    dropped = {*([CHECK_FIRST] if known else []), *(moot if is_explained else ())}
    lines = [line for each in known for line in re.findall(r"`[^`]*`", each)]
    rest = [
        each
        for each in report.advice
        if each not in dropped and not any(line in each for line in lines)
    ]
    return replace(report, advice=tuple(dict.fromkeys((*known, *rest))))


def _is_explained(diagnosis: Diagnosis) -> bool:
    """Whether what is named explains most of what departs: each takes its share of the rest."""
    taken = [each for each in diagnosis.candidates if each.is_taken]
    return math.prod(1.0 - min(each.evidence.share, 1.0) for each in taken) <= 1.0 - MOSTLY


def _of_diagnosis(report: Report, diagnosis: Diagnosis, program: Program | None) -> list[str]:
    taken = [each for each in diagnosis.candidates if each.is_taken][:MOST]
    if diagnosis.told in {Told.NO_DIFFERENCE, Told.CANNOT_TELL} or not taken:
        return []
    own = {each.name for each in diagnosis.refitted if each.is_moved}
    fit = f"`specc fit {report.trace.source} --spec {report.spec.file}`"
    if diagnosis.told is Told.LOG_DIFFERS:
        return _of_log(taken, own, fit, program)
    if all(_is_own(each, own) for each in taken):
        return [_of_numbers(taken, own, fit)]
    named = listed([_number(each, own) for each in taken])
    return [f"mend the robot, or write into the spec what explains it: {named}"]


def _of_numbers(taken: list[Candidate], own: set[str], fit: str) -> str:
    """Numbers of the spec; where others leave the same trace, the fit weighs them."""
    numbers = listed([_number(each, own) for each in taken])
    alike = [each for each in taken if each.alike]
    if alike:
        others = listed(list(alike[0].alike[:MOST]))
        return (
            f"if the robot is as it should be, the spec has to say {numbers}; {others} would leave"
            f" much the same trace as {alike[0].label}: {fit} tries the edit that each would mean;"
            " if the robot is not as it should be, mend it"
        )
    return (
        f"if the robot is as it should be, the spec has to say {numbers} ({fit} edits it); else"
        " mend the robot"
    )


def _of_log(taken: list[Candidate], own: set[str], fit: str, program: Program | None) -> list[str]:
    """How the log has to be read, with the lines of the spec that say so."""
    lines = [] if program is None else [e for each in taken for e in entries_of(each, program)]
    numbers = [_number(each, own) for each in taken if not each.is_of_log]
    told = listed([each.label for each in taken if each.is_of_log])
    beside = f", and {listed(numbers)}" if numbers else ""
    if not lines:
        return [f"mend the log, or say under `trace:` how it is to be read: {told}{beside}"]
    written = " and ".join(f"`{line}`" for line in lines)
    return [f"mend the log ({told}), or write {written} under `trace:`{beside} ({fit} edits it)"]


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

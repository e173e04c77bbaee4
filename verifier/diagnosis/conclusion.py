"""What all of it comes to, in a word and in sentences."""

from typing import Final

from verifier.diagnosis import sentences
from verifier.diagnosis.naming import label_of
from verifier.diagnosis.selection import PLIANT, Selection, Step, Tried
from verifier.report.diagnosis import (
    OF_SENSORS,
    Candidate,
    CandidateKind,
    DepartureAfter,
    Diagnosis,
    DifferingRegion,
    FittedNumber,
    Refitted,
    Told,
)
from verifier.report.report import Interval, Report, Standing, Verdict

SCALARS: Final = (CandidateKind.PARAMETER, CandidateKind.GAIN, CandidateKind.BIAS)

CLEARLY: Final = 0.25
"""A departure that is surely beyond this share of its tolerance is told, though it is allowed."""
LONG: Final = 3
"""So many explanations, or more, deserve doubt."""
AS_GOOD: Final = "several explanations are as good; the first is"
MISREAD: Final = "the log is not what the spec takes it for:"
LONG_CHAIN: Final = (
    "no single candidate explains it; together these do, but one cause that was not tried can look"
    " like them:"
)
PARTLY: Final = 0.6
"""What explains less than this share of the error beyond noise is no explanation."""


def nothing_to_tell(windows: int) -> Diagnosis:
    """For a trace that is too short."""
    why = (
        "nothing of the trace could be compared with the spec"
        if windows == 0
        else f"the trace holds {windows} windows only: too few to hold some of them out"
    )
    return Diagnosis(
        Told.CANNOT_TELL, (f"why the robot departs can't be told: {why}",), (), (), (), ()
    )


def concluded(
    selection: Selection,
    share: float,
    candidates: tuple[Candidate, ...],
    moved: tuple[Refitted, ...],
    after: tuple[DepartureAfter, ...],
    differs: tuple[DifferingRegion, ...],
    report: Report,
) -> tuple[Told, tuple[str, ...]]:
    """The word, and the sentences; the deciding one first."""
    taken = [each for each in candidates if each.is_taken]
    departs = [each for each in after if each.standing is Standing.EXCEEDED]
    if not taken:
        return _unexplained(after, differs, report)
    told = _told(selection, share, taken, departs, differs)
    is_passed = report.verdict is Verdict.PASS
    said = [_opening(told, share, taken, is_over=bool(departs), is_passed=is_passed)]
    said += [each.sentence for each in taken]
    for step in selection.taken:
        said += _in_other_words(step, candidates, is_only=len(taken) == 1)
        rivals = [_name(each) for each in step.alike if each.matters]
        if rivals:
            said.append(f"{_name(step.tried[0])}: {sentences.either(rivals)}")
    if selection.taken and share < PARTLY:
        said.append(sentences.partly(share, len(taken)))
    said += sentences.afterwards(after)
    said += [each.sentence for each in differs[:1] if departs or share < PARTLY]
    beside = [each.sentence for each in moved if not each.is_moved]
    said += [f"refitted beside it: {'; '.join(beside)}"] if beside else []
    return told, tuple(said)


def _told(
    selection: Selection,
    share: float,
    taken: list[Candidate],
    departs: list[DepartureAfter],
    differs: tuple[DifferingRegion, ...],
) -> Told:
    if selection.taken and share < PARTLY:
        return Told.STRUCTURE_DIFFERS if differs else Told.CANNOT_TELL
    if any(_is_open(step) for step in selection.taken[:1]):  # later ones add to the first
        return Told.CANNOT_TELL
    if departs or any(not (each.is_of_log or each.kind in SCALARS) for each in taken):
        return Told.STRUCTURE_DIFFERS
    return Told.LOG_DIFFERS if any(each.is_of_log for each in taken) else Told.SAME_STRUCTURE


def _is_open(step: Step) -> bool:
    """Whether something else, that matters as well, explains as much."""
    return any(each.matters for each in step.alike)


def _in_other_words(step: Step, candidates: tuple[Candidate, ...], *, is_only: bool) -> list[str]:
    """What leaves the same trace; of sensors first, since these are mended in `trace:`.

    Of a delay, only other delays: of what stands on the other side.
    """
    head = step.tried[0]
    found = [each for each in step.same if each.matters and each.effect.kind not in PLIANT]
    if head.effect.is_delay:
        found = [each for each in found if each.effect.is_delay]
    found.sort(key=_rank)
    told = {each.label: each.claim for each in candidates}
    said = sentences.in_other_words([told.get(_name(each)) or _said(each) for each in found])
    return [said if is_only else f"{_name(head)}: {said}"] if found else []


def _rank(tried: Tried) -> int:
    """Offsets of sensors, then their scales, then all else."""
    kind = tried.effect.parameter
    return -OF_SENSORS.index(kind) if kind in OF_SENSORS else 1


def _said(tried: Tried) -> str:
    """The clause that names it, its numbers without their doubt."""
    count = len(tried.effect.numbers)
    values = tried.fitted.values[len(tried.fitted.values) - count :]
    numbers = tuple(
        FittedNumber(n.name, n.unit, n.neutral, value, Interval(value, value))
        for n, value in zip(tried.effect.numbers, values, strict=True)
    )
    return sentences.of_candidate(tried.effect, values, numbers)


def _name(tried: Tried) -> str:
    count = len(tried.effect.numbers)
    return label_of(tried.effect, tried.fitted.values[len(tried.fitted.values) - count :])


def _opening(
    told: Told, share: float, taken: list[Candidate], *, is_over: bool, is_passed: bool
) -> str:
    """is_over: something still departs by more than is allowed. is_passed: nothing ever did."""
    labels = [each.label for each in taken]
    is_long = len(taken) >= LONG and told is Told.STRUCTURE_DIFFERS
    cases = (
        (share < PARTLY, "no candidate explains the departure well; the best is"),
        (is_over, "no candidate explains all of the departure; the best is"),
        (told is Told.CANNOT_TELL, AS_GOOD),
        (is_passed, "what differs is allowed; it would be less with"),
        (is_long, LONG_CHAIN),
        (told is Told.LOG_DIFFERS, MISREAD),
    )
    said = next((words for holds, words in cases if holds), "")
    if said == MISREAD:
        labels = [each.label for each in taken if each.is_of_log]
        own = [each.label for each in taken if not each.is_of_log]
        beside = f"; and other numbers: {', '.join(own)}" if own else ""
        return f"{said} {', '.join(labels)}{beside}"
    return f"{said} {', '.join(labels)}" if said else opening(told, labels)


def opening(told: Told, labels: list[str]) -> str:
    """The first sentence where what is named explains all."""
    words = {Told.SAME_STRUCTURE: "same structure, other numbers:", Told.CANNOT_TELL: AS_GOOD}
    return f"{words.get(told, 'the structure differs:')} {', '.join(labels)}"


def _unexplained(
    after: tuple[DepartureAfter, ...], differs: tuple[DifferingRegion, ...], report: Report
) -> tuple[Told, tuple[str, ...]]:
    departs = [each for each in report.variables if each.standing is Standing.EXCEEDED]
    if not departs:
        text = "no difference that matters beside the tolerances was found"
        clear = [
            sentences.within(each.name, each.declared.departure, each.tolerance, each.unit)
            for each in report.variables
            if each.declared.interval.low > CLEARLY * each.tolerance
        ]
        return Told.NO_DIFFERENCE, tuple(clear) or (text,)
    left = sentences.afterwards(after)
    if differs:
        said = "the structure differs, and no candidate explains how"
        return Told.STRUCTURE_DIFFERS, (said, *(each.sentence for each in differs[:2]), *left)
    said = "the robot departs, but no candidate explains it, nor does it depart in one place"
    return Told.CANNOT_TELL, (said, *left)

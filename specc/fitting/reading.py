"""From a diagnosis to aims: which of its numbers stand in the spec, and where.

A gain of a rate, a dead time or a saturation is no number of the spec: there the structure differs.
"""

import math
from typing import Final

from runtime.program import Program
from specc.fitting.aims import Aim, Aims, AnyAim
from specc.fitting.explanations import LATE, OF_LOGS
from specc.fitting.readings import OF_INPUTS, affine, delays, mended, own_number
from verifier.report.diagnosis import (
    OF_SENSORS,
    Candidate,
    CandidateKind,
    Diagnosis,
    ParameterKind,
    Refitted,
    Told,
)
from verifier.report.report import Standing
from verifier.report.wording import listed, percent

ENOUGH: Final = 0.6
"""What is moved explains at least this share of the error beyond noise."""
SCALARS: Final = (CandidateKind.PARAMETER, CandidateKind.GAIN, CandidateKind.BIAS)


def aims_of(program: Program, diagnosis: Diagnosis) -> Aims:
    """What the diagnosis of one recording would have moved, and what speaks against it."""
    found = _found(program, diagnosis)
    aims = tuple(each for each in found if not isinstance(each, str))
    beyond = tuple(each for each in found if isinstance(each, str))
    if diagnosis.told in {Told.STRUCTURE_DIFFERS, Told.LOG_DIFFERS} and not found:
        beyond = diagnosis.sentences[:2]
    choices = (*_choices(diagnosis), *(_either(*each) for each in _late_instead(diagnosis)))
    left = _left(diagnosis) if aims else ()
    return Aims(aims, beyond, left, choices, _by_hand(diagnosis), _witnesses(program, diagnosis))


def _witnesses(program: Program, diagnosis: Diagnosis) -> tuple[Aim, ...]:
    """Numbers of the spec that the recording tells, and would leave as they are."""
    found = [own_number(each, program) for each in diagnosis.refitted if not each.is_moved]
    return tuple(each for each in found if isinstance(each, Aim))


def _by_hand(diagnosis: Diagnosis) -> tuple[str, ...]:
    """The bare numbers of guards: those with names stand among the refitted ones."""
    named = {each.name for each in diagnosis.refitted}
    return tuple(
        each.sentence
        for each in diagnosis.candidates
        if each.is_taken and each.kind is CandidateKind.GUARD and not named & set(each.applies_to)
    )


def _found(program: Program, diagnosis: Diagnosis) -> list[AnyAim | str]:
    bindings = {binding.name: binding for binding in program.bindings}
    moved = _in_order(diagnosis)
    of_rates = {each.name for each in moved if each.kind is ParameterKind.RATE_GAIN}
    found: list[AnyAim | str] = []
    by_hand: set[str] = set()
    instead = dict(_late_instead(diagnosis))
    named = [each for each in diagnosis.candidates if each.is_taken and not _is_nothing(each)]
    taken = [instead.get(each, each) for each in named]
    found += delays([each for each in taken if each.kind in LATE], bindings)
    for each in taken:
        if each.kind in OF_LOGS and not of_rates & set(each.applies_to):
            found += mended(each, program, bindings)
            by_hand.update(each.applies_to)
        elif each.kind not in (*SCALARS, *OF_LOGS, *LATE, CandidateKind.GUARD):
            found.append(each.sentence)
    names = dict.fromkeys(each.name for each in moved if each.kind in OF_INPUTS + OF_SENSORS)
    for name in names:
        own: dict[ParameterKind, Refitted] = {
            e.kind: e for e in moved if e.name == name and e.kind in OF_INPUTS + OF_SENSORS
        }
        if name not in by_hand:
            found += affine(name, own, program, bindings)
    for number in moved:
        if number.kind not in OF_INPUTS + OF_SENSORS:
            found.append(own_number(number, program))
    return found


def _is_nothing(found: Candidate) -> bool:
    """Whether others have taken over all of it: its numbers are back where they change nothing."""
    return bool(found.numbers) and all(
        each.interval.low <= each.neutral <= each.interval.high for each in found.numbers
    )


def _late_instead(diagnosis: Diagnosis) -> list[tuple[Candidate, Candidate]]:
    """Dead times, which no number of the spec is, with the late logs that leave the same trace."""
    by_label = {each.label: each for each in diagnosis.candidates if each.kind in LATE}
    return [
        (each, by_label[label])
        for each in diagnosis.candidates
        if each.is_taken and each.kind is CandidateKind.DEAD_TIME
        for label in each.alike[:1]
        if label in by_label
    ]


def _either(dead: Candidate, late: Candidate) -> str:
    said = (each.claim for each in (dead, late))
    return f"{', or '.join(said)}: these leave the same trace (--anyway writes the latter)"


def _in_order(diagnosis: Diagnosis) -> list[Refitted]:
    """The numbers that explain something, in the order in which they were taken in."""
    labels = [each.label for each in diagnosis.candidates]
    moved = [each for each in diagnosis.refitted if each.is_moved]

    def place(number: Refitted) -> int:
        word = "gain" if number.kind in {OF_INPUTS[0], OF_SENSORS[0]} else "offset"
        label = f"{word} of {number.name}"
        return labels.index(label) if label in labels else 0

    return sorted(moved, key=place)


def _left(diagnosis: Diagnosis) -> tuple[str, ...]:
    """What the moved numbers leave open."""
    left = [each.name for each in diagnosis.after if each.standing is Standing.EXCEEDED]
    said = [f"{listed(left)} would still depart"] if left else []
    of_states = [
        each
        for each in diagnosis.candidates
        if each.is_taken and each.kind is not CandidateKind.GUARD
    ]
    share = _share(of_states)
    if of_states and share < ENOUGH:
        said.append(f"they explain {percent(max(share, 0.0))} of the error beyond noise only")
    return tuple(said)


def _share(taken: list[Candidate]) -> float:
    """Each explains a share of what those before it left."""
    return 1.0 - math.prod(1.0 - each.evidence.share for each in taken)


def _choices(diagnosis: Diagnosis) -> tuple[str, ...]:
    """Other explanations that are as good."""
    if diagnosis.told is not Told.CANNOT_TELL:
        return ()
    taken = [each for each in diagnosis.candidates if each.is_taken and each.alike]
    return (
        tuple(
            f"{each.label}: this recording can't tell it from {listed(list(each.alike[:3]))}"
            for each in taken
        )
        or diagnosis.sentences[:1]
    )

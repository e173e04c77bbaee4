"""Explanations that leave the same trace, each with the edits that it would mean."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, final

from runtime.program import Program
from specc.fitting.aims import Aim, AnyAim
from specc.fitting.pooling import pooled_aims
from specc.fitting.readings import OF_INPUTS, affine, delays, mended, own_number
from verifier.report.diagnosis import (
    OF_SENSORS,
    Candidate,
    CandidateKind,
    Diagnosis,
    ParameterKind,
    Refitted,
)
from verifier.report.wording import listed

LATE: Final = (CandidateKind.LATE_LOG, CandidateKind.CLOCK_OFFSET)
OF_LOGS: Final = (CandidateKind.SIGN, CandidateKind.UNIT_SLIP)


@final
@dataclass(frozen=True, slots=True)
class Explanation:
    """One way to explain a recording. gain: log-likelihood that it gains in held-out windows.

    aims: what would be moved. telling: what to record so that it can be told from others.
    is_declared: it moves a value of an input that `trace:` declares for the whole recording.
    """

    label: str
    claim: str
    aims: tuple[AnyAim, ...]
    gain: float
    telling: str
    is_declared: bool


def explanations_of(
    program: Program, diagnosis: Diagnosis, aims: tuple[AnyAim, ...]
) -> tuple[Explanation, ...]:
    """What the diagnosis names, whose edits are `aims`, and what explains as much; else nothing.

    The first that the diagnosis names, and each other one in its place, is tried alone as well,
    since one cause may be behind all that moved, and beside the rest.
    """
    taken = [e for e in diagnosis.candidates if e.is_taken and e.kind is not CandidateKind.GUARD]
    if not taken or not aims:
        return ()
    first = taken[0]
    own = {aim.path for aim in _edits(first, program)}
    if not own:
        return ()
    rest = tuple(aim for aim in aims if aim.path not in own)
    found = [_explanation(first, program, aims)]
    if rest:
        found.append(_explanation(first, program, _edits(first, program)))
    for each in diagnosis.candidates:
        edits = _edits(each, program) if each.label in first.alike and not each.is_taken else ()
        if edits and not own & {aim.path for aim in edits}:
            found.append(_explanation(each, program, edits))
            if rest:
                more = _explanation(each, program, (*edits, *rest))
                found.append(replace(more, label=f"{each.label} with the rest"))
    return tuple(found) if len(found) > 1 else ()


def pooled_explanations(
    told: Sequence[tuple[Explanation, ...]], aims: tuple[AnyAim, ...]
) -> tuple[Explanation, ...]:
    """Those that every recording has that tells anything; `aims` are of the first of all."""
    speaking = [each for each in told if each]
    if not speaking:
        return ()
    first = speaking[0][0]
    found = [replace(first, aims=aims, gain=sum(each[0].gain for each in speaking))]
    for one in speaking[0][1:]:
        same = [each for others in speaking for each in others[1:] if each.label == one.label]
        together, contradictions = pooled_aims([each.aims for each in same])
        if len(same) == len(speaking) and not contradictions:
            gain = sum(each.gain for each in same)
            found.append(replace(one, aims=together, gain=gain))
    return tuple(found) if len(found) > 1 else ()


def _explanation(found: Candidate, program: Program, aims: tuple[AnyAim, ...]) -> Explanation:
    is_declared = any(aim.path[0] == "trace" and aim.path[-1] == "constant" for aim in aims)
    claim = _claimed(found, aims)
    telling = _telling(found, program)
    return Explanation(found.label, claim, aims, found.evidence.gain, telling, is_declared)


def _claimed(found: Candidate, aims: tuple[AnyAim, ...]) -> str:
    """The claim, and what else would have to move."""
    others = [aim.name for aim in aims if aim.sentence not in {found.claim, found.sentence}]
    others = [name for name in dict.fromkeys(others) if name not in found.label]
    return f"{found.claim}, and {listed(others)} too" if others else found.claim


def _edits(found: Candidate, program: Program) -> tuple[AnyAim, ...]:
    """What it alone would have moved; nothing where some of it is no number of the spec."""
    bindings = {binding.name: binding for binding in program.bindings}
    edits: list[AnyAim | str] = []
    if found.kind in LATE:
        edits = list(delays([found], bindings))
    elif found.kind in OF_LOGS and found.parameter is not ParameterKind.RATE_GAIN:
        edits = list(mended(found, program, bindings))
    elif found.parameter in OF_INPUTS + OF_SENSORS:
        name, number = found.applies_to[0], _refitted(found, found.parameter)
        edits = list(affine(name, {found.parameter: number}, program, bindings))
    elif found.parameter in {ParameterKind.CONSTANT, ParameterKind.CONTROL}:
        edits = [own_number(_refitted(found, found.parameter), program)]
    aims = tuple(each for each in edits if not isinstance(each, str) and not _is_early(each))
    return aims if len(aims) == len(edits) else ()


def _is_early(aim: AnyAim) -> bool:
    """Whether the log would have told something before it was there."""
    return isinstance(aim, Aim) and aim.path[-1] == "delay" and aim.value < 0.0


def _refitted(found: Candidate, kind: ParameterKind) -> Refitted:
    """The candidate's number as one that was refitted."""
    number = found.numbers[0]
    return Refitted(
        kind=kind,
        name=found.applies_to[0],
        unit=number.unit,
        spec=number.neutral,
        value=number.value,
        interval=number.interval,
        is_moved=True,
        origin=found.origin,
        sentence=found.claim,
    )


def _telling(found: Candidate, program: Program) -> str:
    """What to record, or to measure, so that this can be told from what leaves the same trace."""
    names = listed(list(found.applies_to))
    if found.kind in LATE:
        return f"record {names} with stamps from one clock, or measure how late they come"
    match found.parameter:
        case ParameterKind.CONTROL:
            return f"log {names}, or measure it, or record with {names} at several values"
        case ParameterKind.CONSTANT:
            states = listed(list(program.field.driven))
            return f"for {names}, record more of the region: other values of {states}"
        case _:
            return f"compare what the log says of {names} with a second instrument"

"""Guards that are off, among the explanations: the numbers in them as the robot's switches tell.

They are told where the field itself is right, or right with other numbers: a late log or a sensor
that is off would move the states at all switches.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from runtime.program import Fidelity, Program, Unit
from verifier.diagnosis import sentences
from verifier.diagnosis.conclusion import opening
from verifier.fidelity.stretches.needs import Needs, mode_of, parts_of
from verifier.fidelity.switching.judge import FEWEST, judged_changes
from verifier.fidelity.switching.setting import setting_of
from verifier.fidelity.switching.thresholds import (
    Mended,
    Threshold,
    Unmended,
    Why,
    guards_off,
    thresholds_of,
)
from verifier.report.diagnosis import (
    OF_SENSORS,
    Candidate,
    CandidateKind,
    Diagnosis,
    Evidence,
    FittedNumber,
    ParameterKind,
    Refitted,
    Told,
)
from verifier.report.report import Interval, Standing
from verifier.report.switching import Way
from verifier.report.wording import listed, number, suffix

PLAIN: Final = (Told.NO_DIFFERENCE, Told.SAME_STRUCTURE)


def with_guards(
    diagnosis: Diagnosis, program: Program, needs: Needs, fidelity: Fidelity
) -> Diagnosis:
    """The diagnosis, with what the changes of mode say of numbers in guards."""
    mode = mode_of(program, needs)
    is_told = bool(program.field.guards) and not needs.missing and bool(needs.driven)
    if not is_told or len(needs.series[needs.base].times) < FEWEST:
        return diagnosis
    sensors = any(each.is_moved and each.kind in OF_SENSORS for each in diagnosis.refitted)
    if diagnosis.told not in PLAIN or sensors or (mode is not None and not mode.is_known):
        return diagnosis
    setting = setting_of(program, needs, fidelity)
    switching, compared = judged_changes(setting)
    late = [w.timing is not None and w.timing.standing is Standing.EXCEEDED for w in switching.ways]
    if compared is None or not guards_off(switching.ways, late):
        return diagnosis
    mended = thresholds_of(compared, needs, switching.ways, late)
    return _with(diagnosis, program, switching.ways, mended)


def _with(diagnosis: Diagnosis, program: Program, ways: Sequence[Way], mended: Mended) -> Diagnosis:
    """The first of each group is taken; the others explain as well."""
    found, open_ = mended.groups, mended.unmended
    taken = tuple(_candidate(program, ways, group) for group in found)
    moved = tuple(_refitted(program, ways, group[0]) for group in found if _is_own(group[0]))
    said = [each.sentence for each in taken]
    said += [_as_good(program, ways, group) for group in found if len(group) > 1]
    said += [_unmended(ways[each.guard], each) for each in open_]
    told = _word(mended)
    if diagnosis.told is Told.NO_DIFFERENCE:
        return replace(
            diagnosis,
            told=told,
            sentences=(_opening(told, mended, [each.label for each in taken]), *said),
            refitted=(*moved, *diagnosis.refitted),
            candidates=taken,
        )
    return replace(
        diagnosis,
        told=told,
        sentences=(*diagnosis.sentences, *said),
        refitted=(*diagnosis.refitted, *moved),
        candidates=(*taken, *diagnosis.candidates),
    )


def _word(mended: Mended) -> Told:
    if any(each.why is Why.NONE_FITS for each in mended.unmended):
        return Told.STRUCTURE_DIFFERS
    is_open = bool(mended.unmended) or any(len(group) > 1 for group in mended.groups)
    return Told.CANNOT_TELL if is_open else Told.SAME_STRUCTURE


def _opening(told: Told, mended: Mended, labels: list[str]) -> str:
    if told is Told.STRUCTURE_DIFFERS:
        return "the structure differs in when the robot switches"
    if mended.unmended:
        return "this trace does not tell why the robot switches at other times than the spec"
    return opening(told, labels)


def _as_good(program: Program, ways: Sequence[Way], group: tuple[Threshold, ...]) -> str:
    others = [_sentence(program, ways, each) for each in group[1:]]
    return f"{_label(ways, group[0])}: {sentences.either(others)}"


def _is_own(found: Threshold) -> bool:
    return not found.number.is_bare


def _part(program: Program, found: Threshold) -> tuple[ParameterKind, Unit, str]:
    """What kind of number it is, its unit, and where it stands."""
    name = found.number.name
    constants = {each.name: each for each in program.constants}
    if found.number.is_bare:
        return ParameterKind.CONSTANT, Unit("1", 1.0), ""
    if name in constants:
        return ParameterKind.CONSTANT, constants[name].unit, constants[name].origin
    part = parts_of(program)[name]
    return ParameterKind.CONTROL, part.unit, part.origin


def _fitted(found: Threshold) -> tuple[float, Interval]:
    spec, interval = found.number.spec, found.mean.interval
    return spec + found.mean.mean, Interval(spec + interval.low, spec + interval.high)


def _refitted(program: Program, ways: Sequence[Way], found: Threshold) -> Refitted:
    kind, unit, origin = _part(program, found)
    value, interval = _fitted(found)
    return Refitted(
        kind=kind,
        name=found.number.name,
        unit=unit,
        spec=found.number.spec,
        value=value,
        interval=interval,
        is_moved=True,
        origin=origin,
        sentence=_sentence(program, ways, found),
    )


def _candidate(program: Program, ways: Sequence[Way], group: tuple[Threshold, ...]) -> Candidate:
    found = group[0]
    _, unit, origin = _part(program, found)
    value, interval = _fitted(found)
    count = found.mean.count
    gain = -0.5 * count * float(np.log(max(1.0 - found.share, 1e-12))) - 1.0
    return Candidate(
        kind=CandidateKind.GUARD,
        applies_to=(found.number.name,),
        label=_label(ways, found),
        numbers=(FittedNumber("value", unit, found.number.spec, value, interval),),
        evidence=Evidence(count, found.share, gain, ()),
        is_taken=True,
        alike=tuple(_label(ways, each) for each in group[1:]),
        origin=origin or ways[found.number.guards[0]].origin,
        claim=_sentence(program, ways, found),
        sentence=_sentence(program, ways, found),
    )


def _label(ways: Sequence[Way], found: Threshold) -> str:
    """`low`; of a bare number, where it stands."""
    if found.number.is_bare:
        return f"{found.number.name} in the guard {_way(ways[found.number.guards[0]])}"
    return found.number.name


def _sentence(program: Program, ways: Sequence[Way], found: Threshold) -> str:
    """`low is 18.5 ± 0.05 degC (spec 18), as 17 switches from cool to heat tell`."""
    value, interval = _fitted(found)
    _, unit, _ = _part(program, found)
    shown = f"{sentences.with_doubt(value, interval, unit.scale)}{suffix(unit)}"
    count = f"{found.mean.count} switches"
    if found.number.is_bare:
        way = ways[found.number.guards[0]]
        return (
            f"where {way.origin} has {found.number.name}, {shown} would do: so {count}"
            f" {_way(way)} tell"
        )
    names = listed([_way(ways[guard]) for guard in found.mends])
    return (
        f"{found.number.name} is {shown} (spec {number(found.number.spec / unit.scale)}), as"
        f" {count} {names} tell"
    )


def _way(way: Way) -> str:
    return f"from {way.source} to {way.target}"


def _unmended(way: Way, found: Unmended) -> str:
    name = f"the guard {_way(way)} ({way.origin})"
    match found.why:
        case Why.TOO_FEW:
            switches = f"{found.switches or 'no'} switch{'' if found.switches == 1 else 'es'}"
            return f"{switches} tell{'s' if found.switches == 1 else ''} too little of {name}"
        case Why.NOT_TRIED:
            shared = listed(list(found.shared))
            return f"{name} reads {shared}, which the rates read, too; another was not tried"
        case Why.NONE_FITS:
            return f"no number that only guards read makes {name} open when the robot switches"

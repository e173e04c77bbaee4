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
from verifier.fidelity.stretches.needs import Needs, mode_of, parts_of
from verifier.fidelity.switching.judge import FEWEST, judged_changes
from verifier.fidelity.switching.setting import setting_of
from verifier.fidelity.switching.thresholds import Threshold, guards_off, thresholds_of
from verifier.report.diagnosis import (
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
OF_SENSORS: Final = (ParameterKind.SENSOR_SCALE, ParameterKind.SENSOR_OFFSET)
ENOUGH: Final = 0.6
"""A number explains at least this share of what single switches say of it."""
NONE: Final = "no difference that matters beside the tolerances was found"


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
    off = guards_off(switching.ways, late)
    if compared is None or not off:
        return diagnosis
    found = [
        tuple(each for each in group if each.share >= ENOUGH)
        for group in thresholds_of(compared, needs, off)
    ]
    found = [group for group in found if group]
    mended = {guard for group in found for each in group for guard in each.mends}
    open_ = [way for i, way in enumerate(switching.ways) if i in off and i not in mended]
    return _with(diagnosis, program, switching.ways, found, open_)


def _with(
    diagnosis: Diagnosis,
    program: Program,
    ways: Sequence[Way],
    found: Sequence[tuple[Threshold, ...]],
    open_: Sequence[Way],
) -> Diagnosis:
    """The first of each group is taken; the others explain as well."""
    taken = tuple(_candidate(program, ways, group) for group in found)
    moved = tuple(_refitted(program, ways, group[0]) for group in found if _is_own(group[0]))
    said = [each.sentence for each in taken]
    said += [f"{each.label}: {sentences.either(list(each.alike))}" for each in taken if each.alike]
    said += [_unmended(way) for way in open_]
    told = Told.SAME_STRUCTURE
    if open_:
        told = Told.STRUCTURE_DIFFERS
    elif any(each.alike for each in taken):
        told = Told.CANNOT_TELL
    before = diagnosis.sentences
    if diagnosis.told is Told.NO_DIFFERENCE:
        names = listed([each.label for each in taken])
        opening = {
            Told.SAME_STRUCTURE: f"same structure, other numbers: {names}",
            Told.CANNOT_TELL: f"several explanations are as good; the first is {names}",
        }.get(told, "the structure differs in when the robot switches")
        before = tuple(each for each in before if each != NONE)
        return replace(
            diagnosis,
            told=told,
            sentences=(opening, *said, *before),
            refitted=(*moved, *diagnosis.refitted),
            candidates=taken,
        )
    return replace(
        diagnosis,
        told=told,
        sentences=(*before, *said),
        refitted=(*diagnosis.refitted, *moved),
        candidates=(*taken, *diagnosis.candidates),
    )


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
        alike=tuple(_sentence(program, ways, each) for each in group[1:]),
        origin=origin or ways[found.number.guards[0]].origin,
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


def _unmended(way: Way) -> str:
    return (
        f"no other number in the guard {_way(way)} ({way.origin}) makes the spec switch when the"
        " robot does"
    )

"""From fits to the frozen types of the report."""

from typing import Final

import numpy as np

from runtime.program import Fidelity, Program, Unit
from verifier.diagnosis import sentences
from verifier.diagnosis.between_samples import recorded_between
from verifier.diagnosis.candidates.inputs import origin_of
from verifier.diagnosis.candidates.readings import Reading
from verifier.diagnosis.fitting import intervals_of
from verifier.diagnosis.leftover import Bench, leaves
from verifier.diagnosis.naming import kind_of, label_of, slip_of
from verifier.diagnosis.refitting import Number
from verifier.diagnosis.rereading import Reread
from verifier.diagnosis.selection import Selection, Step, Tried
from verifier.fidelity.stretches.needs import parts_of
from verifier.report.diagnosis import (
    Candidate,
    CandidateKind,
    DepartureAfter,
    DifferingRegion,
    Evidence,
    FittedNumber,
    Refitted,
)
from verifier.report.report import Interval, Report, Standing, VariableResult

SHOWN: Final = 6
"""So many candidates that were not taken are reported."""
WORTH: Final = 0.1
"""If they explain more than this share of the error, and it matters beside the tolerances."""
CLEARLY: Final = 0.25
"""A mean that is surely beyond this share of the tolerance makes a part differ."""


def told_of(numbers: tuple[Number, ...]) -> tuple[Refitted, ...]:
    """The refitted numbers, each with its sentence."""
    return tuple(
        Refitted(
            kind=each.parameter.kind,
            name=each.parameter.name,
            unit=each.parameter.unit,
            spec=each.parameter.spec,
            value=each.value,
            interval=each.interval,
            is_moved=each.is_moved,
            origin=each.parameter.origin,
            sentence=sentences.of_parameter(
                each.parameter, each.value, each.interval, moved=each.is_moved
            ),
        )
        for each in numbers
    )


def departures(results: tuple[VariableResult, ...], report: Report) -> tuple[DepartureAfter, ...]:
    """Each judged variable before and after."""
    before = {each.name: each.declared.departure for each in report.variables}
    return tuple(
        DepartureAfter(
            name=each.name,
            unit=each.unit,
            tolerance=each.tolerance,
            noise=each.noise.sigma,
            before=before.get(each.name, np.inf),
            after=each.declared.departure,
            interval=each.declared.interval,
            standing=each.standing,
            origin=each.origin,
        )
        for each in results
    )


def regions(
    results: tuple[VariableResult, ...], units: dict[str, Unit]
) -> tuple[DifferingRegion, ...]:
    """The parts in which a variable surely still departs, each once, the worst first."""
    found = [
        (max(part.interval.low, -part.interval.high) / each.tolerance, each, part)
        for each in results
        for part in each.regions
        if part.standing is Standing.EXCEEDED
        or max(part.interval.low, -part.interval.high) > CLEARLY * each.tolerance
    ]
    found.sort(key=lambda item: -item[0])
    told: dict[str, DifferingRegion] = {}
    for _, each, part in found:
        said = sentences.where(each.name, part, units)
        told.setdefault(said, DifferingRegion(each.name, each.unit, part, said))
    return tuple(told.values())


def candidates_of(
    bench: Bench, selection: Selection, confidence: float, *, with_others: bool
) -> tuple[Candidate, ...]:
    """Those that were taken, then the best of those that were not, if these are wanted."""
    taken = selection.taken
    found = []
    before: list[str] = []
    for step in taken:
        found.append(_candidate(bench, selection, step, step.tried[0], tuple(before), confidence))
        before.append(found[-1].label)
    named = {each.label for each in found}
    rest = selection.steps[-1].tried if not taken else taken[0].tried[1:]
    for tried in rest if with_others else ():
        is_worth = tried.matters and tried.gain > 0.0 and tried.share > WORTH
        if not is_worth or len(found) >= len(taken) + SHOWN:
            continue
        other = _candidate(bench, selection, None, tried, (), confidence)
        if other.label not in named:
            named.add(other.label)
            found.append(other)
    return tuple(found)


def reading_of(
    program: Program, best: Reread, selection: Selection, fidelity: Fidelity, *, was_judged: bool
) -> Candidate:
    """A reading of the trace as the first candidate; was_judged: before it was read so."""
    reading = best.reading
    bindings = {binding.name: binding for binding in program.bindings}
    evidence = sentences.of_reading(reading, best.share, was_judged=was_judged)
    left = leaves(Bench(best.scene, best.study, fidelity), selection.plain)
    return Candidate(
        kind=reading.kind,
        applies_to=reading.applies_to,
        label=reading.label,
        numbers=_mending(program, reading),
        evidence=Evidence(best.scene.windows, best.share, best.gain, ()),
        is_taken=True,
        alike=(),
        origin=origin_of(bindings, reading.applies_to[0]),
        claim=reading.words,
        sentence=f"{reading.words}; {evidence}{sentences.still(left, ())}",
        leaves=left,
        slip=reading.slip,
    )


def _mending(program: Program, reading: Reading) -> tuple[FittedNumber, ...]:
    """The factor and the offset that each number in the log needs, where one does."""
    factor, offset = reading.factor, reading.offset
    unit = parts_of(program)[reading.applies_to[0]].unit
    found = []
    if factor != 1.0:
        exact = Interval(factor, factor)
        found.append(FittedNumber("factor", Unit("1", 1.0), 1.0, factor, exact))
    if offset != 0.0:
        found.append(FittedNumber("offset", unit, 0.0, offset, Interval(offset, offset)))
    return tuple(found)


def _candidate(
    bench: Bench,
    selection: Selection,
    step: Step | None,
    tried: Tried,
    before: tuple[str, ...],
    confidence: float,
) -> Candidate:
    """With the numbers of the last fit where it was taken, of its own fit where not."""
    effect, scene = tried.effect, bench.scene
    fitted = selection.final if step is not None else tried.fitted
    intervals = intervals_of(scene, fitted, confidence)
    labels = [each.label for each in fitted.effects]
    place = labels.index(effect.label)
    first = sum(len(each.numbers) for each in fitted.effects[:place])
    numbers = tuple(
        FittedNumber(n.name, n.unit, n.neutral, fitted.values[first + i], intervals[first + i])
        for i, n in enumerate(effect.numbers)
    )
    values = fitted.values[first : first + len(effect.numbers)]
    alike = (
        ()
        if step is None
        else tuple(
            label_of(t.effect, t.fitted.values[len(t.fitted.values) - len(t.effect.numbers) :])
            for t in (*step.same, *step.alike)
        )
    )
    kind, said = kind_of(effect, values), sentences.of_candidate(effect, values, numbers)
    left = leaves(bench, tried.fitted)
    evidence = f"{sentences.evidence(tried.share, before)}{sentences.still(left, before)}"
    recorded = recorded_between(scene, effect, kind, values[0]) if values else ""
    return Candidate(
        kind=kind,
        applies_to=effect.applies_to,
        label=label_of(effect, values),
        numbers=numbers,
        evidence=Evidence(scene.windows, tried.share, tried.gain, before),
        is_taken=step is not None,
        alike=alike,
        origin=effect.origin,
        claim=said,
        sentence=f"{said}; {evidence}{recorded}",
        leaves=left,
        slip=slip_of(effect, values) if kind is CandidateKind.UNIT_SLIP else "",
        parameter=effect.parameter,
    )

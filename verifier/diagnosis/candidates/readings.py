"""A trace read otherwise: a wrong sign or unit, or two things in each other's place.

What is measured decides which stretches are judged and where windows start, so each reading is
a trace of its own. Inputs are tried here only where they lie outside their domain as they are;
a state's rarer units, too.
"""

from dataclasses import dataclass, replace
from itertools import combinations
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.program import Kind, Program, Unit
from verifier.fidelity.stretches.needs import Needs, parts_of
from verifier.mixed_units import PLAUSIBLE, Slip, alternatives, unit_read
from verifier.report.diagnosis import CandidateKind
from verifier.traces.trace import Trace

FEW: Final = 4
"""Of so many values of a discrete variable, at most, pairs are exchanged."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Reading:
    """The trace read otherwise. factor, offset: what mends each of `applies_to`, if that does it.

    words: what the log is, as a clause. slip: of units, in words.
    """

    kind: CandidateKind
    applies_to: tuple[str, ...]
    label: str
    words: str
    factor: float
    offset: float
    trace: Trace
    slip: str = ""


def readings_of(program: Program, needs: Needs, trace: Trace) -> tuple[Reading, ...]:
    """Those that put all that they touch within its domain."""
    states = [s.name for s in needs.driven]
    told = [i.name for i in needs.inputs if i.series is not None and np.isfinite(i.low)]
    outside = [name for name in (*states, *told) if not _is_inside(program, trace, name)]
    names = list(dict.fromkeys((*states, *outside)))
    found = [
        *(_turned(trace, name) for name in names),
        *_in_units(program, trace, names, outside),
        *_swapped(program, trace, states),
        *_exchanged_values(program, needs, trace),
    ]
    return tuple(
        each
        for each in found
        if all(_is_inside(program, each.trace, name) for name in each.applies_to)
    )


def read_units(program: Program) -> dict[str, Unit]:
    """In which unit each variable of the log was read."""
    bound = {each.name: each for each in program.bindings}
    return {n: unit_read(part.unit, bound.get(n)) for n, part in parts_of(program).items()}


def _turned(trace: Trace, name: str) -> Reading:
    turned = _affine(trace, (name,), -1.0, 0.0)
    words = f"{name} has the wrong sign in the log"
    return Reading(CandidateKind.SIGN, (name,), f"sign of {name}", words, -1.0, 0.0, turned)


def _in_units(
    program: Program, trace: Trace, names: list[str], outside: list[str]
) -> list[Reading]:
    """Each variable alone, and all those together that share a slip."""
    units = read_units(program)
    shared: dict[tuple[str, float], list[tuple[str, Slip]]] = {}
    for name in names:
        for slip in alternatives(units[name]):
            if slip.is_classic or name in outside:
                shared.setdefault((slip.words, slip.factor), []).append((name, slip))
    found = []
    for own in shared.values():
        found += [_slipped(trace, (name,), slip) for name, slip in own]
        if len(own) > 1:
            found.append(_slipped(trace, tuple(name for name, _ in own), own[0][1]))
    return found


def _slipped(trace: Trace, names: tuple[str, ...], slip: Slip) -> Reading:
    label = f"{slip.words} in {' and '.join(names)}"
    return Reading(
        kind=CandidateKind.UNIT_SLIP,
        applies_to=names,
        label=label,
        words=f"the log has {label}",
        factor=slip.factor,
        offset=slip.offset,
        trace=_affine(trace, names, slip.factor, slip.offset),
        slip=slip.words,
    )


def _swapped(program: Program, trace: Trace, states: list[str]) -> list[Reading]:
    units = {name: part.unit.text for name, part in parts_of(program).items()}
    return [
        Reading(
            CandidateKind.SWAPPED_AXES,
            (a, b),
            f"{a} and {b} swapped",
            f"{a} and {b} are swapped in the log",
            1.0,
            0.0,
            _exchanged(trace, a, b),
        )
        for a, b in combinations(states, 2)
        if units[a] == units[b]
    ]


def _exchanged_values(program: Program, needs: Needs, trace: Trace) -> list[Reading]:
    """Two values of a discrete input in each other's place."""
    told = {each.name for each in needs.inputs if each.series is not None}
    few = [s for s in program.states if s.name in told and 2 <= len(s.values) <= FEW]
    return [
        Reading(
            CandidateKind.EXCHANGED_VALUES,
            (state.name,),
            f"{state.values[a]} and {state.values[b]} exchanged in {state.name}",
            f"{state.values[a]} and {state.values[b]} of {state.name} are exchanged in the log",
            1.0,
            0.0,
            _renamed(trace, state.name, a, b),
        )
        for state in few
        for a, b in combinations(_seen(trace, state.name, len(state.values)), 2)
    ]


def _seen(trace: Trace, name: str, count: int) -> list[int]:
    values = trace.series[name].values
    return [index for index in range(count) if np.any(values == index)]


def _renamed(trace: Trace, name: str, a: int, b: int) -> Trace:
    series = trace.series[name]
    values = np.where(series.values == a, b, np.where(series.values == b, a, series.values))
    other = replace(series, values=values.astype(float))
    return replace(trace, series={**trace.series, name: other})


def _affine(trace: Trace, names: tuple[str, ...], factor: float, offset: float) -> Trace:
    others = {
        name: replace(trace.series[name], values=factor * trace.series[name].values + offset)
        for name in names
    }
    return replace(trace, series={**trace.series, **others})


def _exchanged(trace: Trace, a: str, b: str) -> Trace:
    one, other = trace.series[a], trace.series[b]
    swapped = {a: replace(other, name=a), b: replace(one, name=b)}
    return replace(trace, series={**trace.series, **swapped})


def _is_inside(program: Program, trace: Trace, name: str) -> bool:
    return _share_inside(program, name, trace.series[name].values) >= PLAUSIBLE


def _share_inside(program: Program, name: str, values: Array) -> float:
    part = parts_of(program)[name]
    if getattr(part, "kind", Kind.CONTINUOUS) is not Kind.CONTINUOUS:
        return 1.0
    return float(np.mean((values >= part.low) & (values <= part.high)))

"""A trace read otherwise: driven states with a wrong sign, in the wrong unit, or swapped.

What is measured decides which stretches are judged and where windows start, so each reading is
a trace of its own. Inputs are tried here only where their unit puts them outside their domain.
"""

import re
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.program import Kind, Program, Unit
from verifier.fidelity.stretches.needs import Needs, parts_of
from verifier.report.diagnosis import CandidateKind
from verifier.traces.trace import Trace

DEGREE: Final = np.pi / 180.0
ANGLES: Final = {"degrees for radians": DEGREE, "radians for degrees": 1.0 / DEGREE}
LENGTHS: Final = {"millimetres for metres": 1e-3, "metres for millimetres": 1e3}
PLAUSIBLE: Final = 0.9
"""At least this share of the samples lies within the domain."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Reading:
    """The trace read otherwise: each of `applies_to` times its factor, perhaps swapped."""

    kind: CandidateKind
    applies_to: tuple[str, ...]
    label: str
    factors: dict[str, float]
    trace: Trace


def readings_of(program: Program, needs: Needs, trace: Trace) -> tuple[Reading, ...]:
    """Those that put all that they touch within its domain."""
    states = [s.name for s in needs.driven]
    told = [i.name for i in needs.inputs if i.series is not None and np.isfinite(i.low)]
    found = [
        *(_turned(trace, name) for name in states),
        *(each for name in states for each in _in_units(program, trace, name)),
        *(
            each
            for name in told
            if _share_inside(program, name, trace.series[name].values) < PLAUSIBLE
            for each in _in_units(program, trace, name)
        ),
        *_swapped(program, trace, states),
    ]
    return tuple(
        each
        for each in found
        if all(
            _share_inside(program, name, each.trace.series[name].values) >= PLAUSIBLE
            for name in each.applies_to
        )
    )


def _turned(trace: Trace, name: str) -> Reading:
    label = f"sign of {name}"
    turned = _scaled(trace, name, -1.0)
    return Reading(CandidateKind.SIGN, (name,), label, {name: -1.0}, turned)


def _in_units(program: Program, trace: Trace, name: str) -> list[Reading]:
    unit = parts_of(program)[name].unit
    return [
        Reading(
            CandidateKind.UNIT_SLIP,
            (name,),
            f"{words} in {name}",
            {name: factor},
            _scaled(trace, name, factor),
        )
        for words, factor in slips_of(unit).items()
    ]


def slips_of(unit: Unit) -> dict[str, float]:
    """What a number in this unit may have been taken for, and the factor that mends it.

    >>> list(slips_of(Unit("m/s", 1.0)))
    ['millimetres for metres', 'metres for millimetres']
    """
    if re.match(r"(rad|deg|1($|/))", unit.text):
        return ANGLES
    return LENGTHS if re.match(r"[kcm]?m\b", unit.text) else {}


def _swapped(program: Program, trace: Trace, states: list[str]) -> list[Reading]:
    units = {name: part.unit.text for name, part in parts_of(program).items()}
    return [
        Reading(
            CandidateKind.SWAPPED_AXES, (a, b), f"{a} and {b} swapped", {}, _exchanged(trace, a, b)
        )
        for a, b in combinations(states, 2)
        if units[a] == units[b]
    ]


def _scaled(trace: Trace, name: str, factor: float) -> Trace:
    series = trace.series[name]
    other = replace(series, values=factor * series.values)
    return replace(trace, series={**trace.series, name: other})


def _exchanged(trace: Trace, a: str, b: str) -> Trace:
    one, other = trace.series[a], trace.series[b]
    swapped = {a: replace(other, name=a), b: replace(one, name=b)}
    return replace(trace, series={**trace.series, **swapped})


def _share_inside(program: Program, name: str, values: Array) -> float:
    part = parts_of(program)[name]
    if getattr(part, "kind", Kind.CONTINUOUS) is not Kind.CONTINUOUS:
        return 1.0
    return float(np.mean((values >= part.low) & (values <= part.high)))

"""What the self-test found, in words."""

from typing import Final, TypeAlias

import numpy as np

from verifier.limits.faults import Planned
from verifier.report.limits import Caught, Fault, Trial
from verifier.report.report import Verdict
from verifier.report.wording import listed, quantity

Sides: TypeAlias = tuple[Verdict, Verdict]
"""The verdicts on a fault planted as too much, and as too little."""

WORDS: Final = {
    Fault.GAIN: ("faster", "slower"),
    Fault.OFFSET: ("upwards", "downwards"),
    Fault.DELAY: ("later", "earlier"),
    Fault.SENSOR: ("too high", "too low"),
}


def said(
    planned: Planned,
    rungs: tuple[int | None, int | None],
    trials: tuple[Trial, ...],
    shown_by: tuple[str, ...],
    largest_of_all: Sides | None = None,
) -> Caught:
    """The finding on one fault.

    rungs: of its ladder, the one that was missed and the one that was caught, if any.
    largest_of_all: the verdicts on the largest fault, where it was not caught in both directions.
    """
    missed, caught = rungs
    smallest = np.inf if caught is None else float(planned.sizes[caught])
    largest = 0.0 if missed is None else float(planned.sizes[missed])
    if not planned.can_act:
        largest = np.inf
    sentence = (
        _untold(planned, largest, largest_of_all)
        if caught is None
        else _told(planned, smallest, largest, shown_by)
    )
    return Caught(
        fault=planned.fault,
        variable=planned.variable,
        unit=planned.unit,
        smallest=smallest,
        largest=largest,
        trials=trials,
        shown_by=shown_by,
        sentence=sentence,
        origin=planned.origin,
    )


def _untold(planned: Planned, largest: float, sides: Sides | None) -> str:
    name, words = planned.variable, WORDS[planned.fault]
    if not planned.can_act:
        return (
            f"a sensor that shows {name} too high or too low by a constant can't be caught: the"
            f" field does not read {name}"
        )
    if sides is not None and Verdict.FAIL in sides:
        missed = 1 if sides[0] is Verdict.FAIL else 0
        one = _fault(planned, largest, words[missed])
        return f"not even {one} would have failed; as much {words[1 - missed]} would have"
    said = f"not even {_fault(planned, largest, ' or '.join(words))} would have failed"
    if sides is None:
        return said
    if Verdict.PASS not in sides:
        return f"{said}: it would have been inconclusive"
    return f"{said}: it would have passed" if set(sides) == {Verdict.PASS} else said


def _told(planned: Planned, smallest: float, largest: float, shown_by: tuple[str, ...]) -> str:
    name = planned.variable
    others = [each for each in shown_by if each != name]
    by = f", seen in {listed(others)}" if others and name not in shown_by else ""
    beside = (
        f"; {quantity(largest, planned.unit)} would not"
        if largest > 0.0
        else " (none smaller tried)"
    )
    words = " or ".join(WORDS[planned.fault])
    return f"{_fault(planned, smallest, words)} would have failed{by}{beside}"


def _fault(planned: Planned, size: float, direction: str) -> str:
    name, much = planned.variable, quantity(size, planned.unit)
    match planned.fault:
        case Fault.GAIN:
            return f"a robot whose {name} changes {much} {direction} than the spec says"
        case Fault.OFFSET:
            return f"a robot whose {name} drifts {much} {direction} beside what the spec says"
        case Fault.DELAY:
            return f"a robot that acts on {name} {much} {direction} than logged"
        case Fault.SENSOR:
            return f"a sensor that shows {name} {much} {direction}"

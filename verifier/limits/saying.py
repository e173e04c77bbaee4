"""What the self-test found, in words."""

import numpy as np

from verifier.limits.faults import Planned
from verifier.report.limits import Caught, Fault, Trial
from verifier.report.wording import listed, quantity


def said(
    planned: Planned,
    missed: int | None,
    caught: int | None,
    trials: tuple[Trial, ...],
    shown_by: tuple[str, ...],
) -> Caught:
    """The finding on one fault: the rungs of its ladder that were missed and caught, if any."""
    smallest = np.inf if caught is None else float(planned.sizes[caught])
    largest = 0.0 if missed is None else float(planned.sizes[missed])
    if not planned.can_act:
        largest = np.inf
    return Caught(
        fault=planned.fault,
        variable=planned.variable,
        unit=planned.unit,
        smallest=smallest,
        largest=largest,
        trials=trials,
        shown_by=shown_by,
        sentence=_sentence(planned, smallest, largest, shown_by),
        origin=planned.origin,
    )


def _sentence(planned: Planned, smallest: float, largest: float, shown_by: tuple[str, ...]) -> str:
    name = planned.variable
    if not planned.can_act:
        return (
            f"no constant error of the sensor of {name} could be caught: the field does not read"
            f" {name}, so every value of it is as good as another"
        )
    if not np.isfinite(smallest):
        return f"not even {_fault(planned, largest)} would have been caught"
    others = [each for each in shown_by if each != name]
    by = f" (by {listed(others)})" if others and name not in shown_by else ""
    beside = (
        f", {quantity(largest, planned.unit)} not" if largest > 0.0 else " (none smaller tried)"
    )
    return f"{_fault(planned, smallest)} would have been caught{by}{beside}"


def _fault(planned: Planned, size: float) -> str:
    name, much = planned.variable, quantity(size, planned.unit)
    match planned.fault:
        case Fault.GAIN:
            return f"a rate of {name} {much} too high or too low"
        case Fault.OFFSET:
            return f"a rate of {name} that is off by a constant {much}"
        case Fault.DELAY:
            return f"a robot that acts on {name} {much} later or earlier than logged"
        case Fault.SENSOR:
            return f"a sensor that shows {much} too much or too little of {name}"

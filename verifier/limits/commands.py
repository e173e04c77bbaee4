"""What inputs cannot tell that stood still, took two values only, or rarely changed."""

from typing import Final

import numpy as np

from runtime.arrays import Array
from runtime.program import Control, Kind, Program, State
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.needs import Input, held, names_read, parts_of
from verifier.fidelity.stretches.spans import contains
from verifier.report.limits import NotTold
from verifier.report.wording import listed, quantity, span

ALIKE: Final = 0.01
"""Values that differ by less than this share of the domain are one value."""
PAIR: Final = 2
FEW_CHANGES: Final = 3
"""With fewer changes, when an input acts rests on too little."""
WANTED: Final = 5
"""So many values, spread over the domain, are suggested."""


def untold_of_inputs(program: Program, study: Study) -> list[NotTold]:
    """What stays open because an input of the field did not vary enough in the judged stretches."""
    parts, read = parts_of(program), names_read(program)
    still: list[tuple[State | Control, float]] = []
    found = []
    for given in study.plan.needs.inputs:
        part = parts[given.name]
        if given.name not in read or (isinstance(part, State) and part.kind is Kind.DISCRETE):
            continue
        values = _values(study, given)
        if is_still(part, values):
            still.append((part, float(np.median(values))))
        else:
            found += _untold(part, given, values)
    return [_still(still), *found] if still else found


def is_still(part: State | Control, values: Array) -> bool:
    """Whether all values are one value."""
    return float(np.ptp(values)) <= ALIKE * (part.high - part.low)


def _values(study: Study, given: Input) -> Array:
    """The values in the judged stretches, in order of time."""
    if given.series is None:
        return np.array([given.value])
    spans, times = study.segments.spans, given.series.times
    return np.concatenate(
        [held(given.series, spans[:, 0]), given.series.values[contains(spans, times)]]
    )


def levels(values: Array, apart: float) -> Array:
    """The distinct values, ascending: means of groups whose neighbours are at most `apart`.

    >>> levels(np.array([0.0, 0.51, 0.5, 0.0]), 0.02)
    array([0.   , 0.505])
    """
    ordered = np.unique(values)
    group = np.concatenate([[0], np.cumsum(np.diff(ordered) > apart)])
    return np.asarray(np.bincount(group, weights=ordered) / np.bincount(group))


def _untold(part: State | Control, given: Input, values: Array) -> list[NotTold]:
    apart = ALIKE * (part.high - part.low)
    changes = int(np.sum(np.abs(np.diff(values)) > apart / 2.0))
    untold = [] if changes >= FEW_CHANGES or given.is_sensed else [_rarely(part, changes)]
    found = levels(values, apart)
    # A slowly moving input has a chain of neighbouring values: one group, and a wide one.
    if len(found) == PAIR and _is_pair(values, found, apart):
        untold.append(_two_valued(part, found))
    return untold


def _is_pair(values: Array, found: Array, apart: float) -> bool:
    """Whether all values are near one of two."""
    distance = np.min(np.abs(values[:, None] - found), axis=1)
    return bool(np.max(distance) <= apart)


def _still(still: list[tuple[State | Control, float]]) -> NotTold:
    names = listed([part.name for part, _ in still])
    if len(still) == 1:
        [(part, value)] = still
        why = f"{names} stayed at {quantity(value, part.unit)} wherever the trace was judged"
        they, suggestion = "it", f"record with {names} at {_spread(part)}"
    else:
        values = listed([f"{part.name} at {quantity(value, part.unit)}" for part, value in still])
        why = f"each stayed at one value wherever the trace was judged: {values}"
        they = "them"
        suggestion = f"record with each of them at {WANTED} values or more, spread over its domain"
    return NotTold(
        what=f"how the field depends on {names}, and how late the robot acts on {they}",
        names=tuple(part.name for part, _ in still),
        why=why,
        suggestion=suggestion,
        origin=still[0][0].origin,
    )


def _rarely(part: State | Control, changes: int) -> NotTold:
    times = "once" if changes == 1 else "twice" if changes == PAIR else "never by a clear step"
    return NotTold(
        what=f"how late the robot acts on {part.name}",
        names=(part.name,),
        why=f"{part.name} changed {times}, so a delay rests on next to nothing",
        suggestion=(
            f"change {part.name} by clear steps, ten times or more, at uneven intervals of about"
            " the horizon"
        ),
        origin=part.origin,
    )


def _two_valued(part: State | Control, found: Array) -> NotTold:
    both = listed([quantity(float(value), part.unit) for value in found])
    return NotTold(
        what=f"a gain of {part.name} apart from a saturation, a dead zone or an offset",
        names=(part.name,),
        why=(
            f"{part.name} took only two values, {both}: through two points go a straight line and"
            " every bent one"
        ),
        suggestion=f"record with {part.name} at {_spread(part)}, among them small ones",
        origin=part.origin,
    )


def _spread(part: State | Control) -> str:
    return f"{WANTED} values or more from {span(part.low, part.high, part.unit)}"

"""The faults that are planted, and the sizes that are tried of each.

Sizes are a ladder of equal ratios around the size whose effect at the horizon is about the
tolerance, so that a few rungs up or down is where the verdict turns.
"""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.program import Control, Fidelity, Kind, Program, State, Unit
from verifier.fidelity.shooting.prediction import Model, predict
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.needs import Input, held, names_read, parts_of
from verifier.report.limits import Fault

RATIO: Final = 1.3
"""From one size to the next: how precisely the smallest one is known."""
ABOVE: Final = 12
"""Rungs above the guess."""
RUNGS: Final = 22
LARGEST_GAIN: Final = 1.0
"""A rate that is doubled, or that is not there at all."""
FEW_CHANGES: Final = 2
"""An input that changes less often has no delay to speak of."""
DELAY: Final = 0.02
"""What a delay does is foretold from one of this share of the horizon,"""
LEAST_DELAY: Final = 1e-3
"""and no guess is below this share of it."""
SECOND: Final = Unit("s", 1.0)
PER_CENT: Final = Unit("%", 0.01)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Planned:
    """One fault with the sizes to try: `sizes` (S,) ascending, SI; `guess`: where to begin.

    target: its place among the predicted states for a gain or an offset of a rate, among the
    inputs for a delay; of a sensor, either.
    can_act: False where the field reads nothing that the fault touches.
    """

    fault: Fault
    variable: str
    unit: Unit
    target: int
    can_act: bool
    sizes: Array
    guess: int
    origin: str


def faults_of(program: Program, fidelity: Fidelity, study: Study) -> tuple[Planned, ...]:
    """All faults that are worth planting into a trace of `program`."""
    driven = study.plan.needs.driven
    found = [_of_rate(program, fidelity, study, j) for j in range(len(driven))]
    planned = [each for pair in found for each in pair]
    planned += [_of_sensor(program, fidelity, state, j) for j, state in enumerate(driven)]
    for i, each in enumerate(study.plan.needs.inputs):
        planned += _of_input(program, fidelity, study, each, i)
    return tuple(planned)


def _of_rate(program: Program, fidelity: Fidelity, study: Study, j: int) -> list[Planned]:
    """A gain and an offset of one predicted state's rate."""
    state = study.plan.needs.driven[j]
    horizon, tolerance = fidelity.horizon, _allowed(fidelity, study, j)
    speed = _speed(study, j)
    gain = tolerance / (horizon * speed) if speed > 0.0 else LARGEST_GAIN
    clock = program.field.every if program.field.is_map else 1.0
    unit = _per_time(state.unit, is_map=program.field.is_map)
    most = (state.high - state.low) / horizon * clock
    return [
        _planned(Fault.GAIN, state, PER_CENT, j, gain, LARGEST_GAIN),
        _planned(Fault.OFFSET, state, unit, j, tolerance / horizon * clock, most),
    ]


def _per_time(unit: Unit, *, is_map: bool) -> Unit:
    """The unit of a rate; of a step map, of a step.

    >>> [_per_time(Unit(text, 1.0), is_map=False).text for text in ("m", "m/s", "1")]
    ['m/s', 'm/s^2', '1/s']
    """
    text = unit.text or "1"
    if is_map:
        return Unit(f"{text}/step", unit.scale)
    return Unit(f"{text}^2" if text.endswith("/s") else f"{text}/s", unit.scale)


def _of_sensor(program: Program, fidelity: Fidelity, state: State, j: int) -> Planned:
    width = state.high - state.low
    share = min(t / _width(program, name) for name, t in fidelity.tolerance.items())
    guess = fidelity.tolerance.get(state.name, share * width)
    can_act = state.name in names_read(program)
    return _planned(Fault.SENSOR, state, state.unit, j, guess, width / 4.0, can_act=can_act)


def _of_input(
    program: Program, fidelity: Fidelity, study: Study, given: Input, i: int
) -> list[Planned]:
    """A delay of a measured input; of a sensed-only one also an offset of its sensor."""
    part = parts_of(program)[given.name]
    if given.series is None or (isinstance(part, State) and part.kind is Kind.DISCRETE):
        return []
    found = []
    if np.count_nonzero(np.diff(given.series.values)) >= FEW_CHANGES:
        horizon = study.plan.windows.horizon
        guess = _telling_delay(fidelity, study, given, i)
        found.append(_planned(Fault.DELAY, part, SECOND, i, guess, horizon))
    if isinstance(part, State):
        width = part.high - part.low
        found.append(_planned(Fault.SENSOR, part, part.unit, i, width / 50.0, width / 4.0))
    return found


def _telling_delay(fidelity: Fidelity, study: Study, given: Input, i: int) -> float:
    """The delay of an input that moves some prediction by about its tolerance.

    Larger ones are told less surely where the input changes often: what it does then looks like
    chance. So the search has to begin there.
    """
    assert given.series is not None, "what comes late was measured"
    plan, horizon = study.plan, study.plan.windows.horizon
    late = DELAY * horizon
    inputs = np.array(plan.model.grid.inputs)
    inputs[:, i] = np.clip(held(given.series, plan.model.grid.times - late), given.low, given.high)
    models = plan.model, Model(plan.model.flow, replace(plan.model.grid, inputs=inputs))
    windows = plan.windows
    rows, ends = np.arange(len(windows.times)), windows.last - windows.first
    plain, moved = (
        predict(model, study.shots.start, windows.first, windows.last)[rows, ends]
        for model in models
    )
    found = [_typical(moved[:, s.column] - plain[:, s.column]) for s in plan.samples]
    shares = [f / _allowed(fidelity, study, j) for j, f in enumerate(found)]
    return float(np.clip(late / max(*shares, 1e-9), LEAST_DELAY * horizon, horizon))


def _typical(moved: Array) -> float:
    """The root mean square (W,) of what stayed in the domain."""
    kept = moved[np.isfinite(moved)]
    return float(np.sqrt(np.mean(kept**2))) if len(kept) else 0.0


def _planned(  # one row of a table
    fault: Fault,
    part: State | Control,
    unit: Unit,
    target: int,
    guess: float,
    most: float,
    *,
    can_act: bool = True,
) -> Planned:
    top = min(guess * RATIO**ABOVE, most)
    sizes = [_rounded(top * RATIO**-k / unit.scale) * unit.scale for k in range(RUNGS)]
    ladder = np.array(sizes[::-1])
    begin = int(np.clip(np.searchsorted(ladder, guess), 0, RUNGS - 1))
    return Planned(fault, part.name, unit, target, can_act, ladder, begin, part.origin)


def _rounded(value: float) -> float:
    """Two significant digits, as the size is told."""
    return float(f"{value:.2g}")


def _allowed(fidelity: Fidelity, study: Study, j: int) -> float:
    """The tolerance of a predicted state; where it has none, as large a share of its domain."""
    state = study.plan.needs.driven[j]
    widths = {s.name: s.high - s.low for s in study.plan.needs.driven}
    share = min(t / widths[name] for name, t in fidelity.tolerance.items() if name in widths)
    return fidelity.tolerance.get(state.name, share * widths[state.name])


def _speed(study: Study, j: int) -> float:
    """The root mean square rate of a predicted state, from its way over the horizon."""
    return _typical(study.shots.errors[-1][j].moved) / study.plan.windows.horizon


def _width(program: Program, name: str) -> float:
    part = parts_of(program)[name]
    return part.high - part.low

"""The time grid on which the model is integrated: every instant at which anything happens.

For a flow the knots are the samples of the predicted states (so that they are compared at their
own stamps, without interpolation), the times at which an input changes (so that zero-order hold
switches exactly), and further instants that keep every step at or below a maximum. For a step map
they are the ticks of its clock.
"""

from dataclasses import dataclass, field, replace
from typing import final

import numpy as np

from runtime.arrays import Array, Integers
from verifier.fidelity.stretches.needs import Needs, held, period_of
from verifier.fidelity.stretches.segments import GAP_PERIODS, GAP_SECONDS

CLOCK_SLACK = 0.2
"""How far the sample period may be from a multiple of a map's clock, as a share of it."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Grid:
    """Knots (G,) and the inputs' values from each knot to the next, (G, k).

    columns (k,): the inputs' entries of the register. leaps: the knots at which a mode is left for
    itself.
    """

    times: Array
    inputs: Array
    columns: Integers
    leaps: Integers = field(default_factory=lambda: np.zeros(0, np.int64))


def flow_grid(needs: Needs, max_step: float) -> Grid:
    """The grid of a flow, with no step above `max_step` (s) but in gaps."""
    told = [each.series for each in needs.inputs if each.series is not None]
    knots = np.unique(
        np.concatenate([*(s.times for s in (*needs.series, *told)), needs.leaps.times])
    )
    longest = max(GAP_SECONDS, GAP_PERIODS * period_of(needs.series[needs.base].times))
    return _grid(needs, _refined(knots, max_step, longest))


def tick_grid(needs: Needs, every: float) -> Grid | None:
    """The ticks of a map's clock, locked to the time base; None if the samples do not fit it.

    A sample is a tick, or every r-th sample is; samples further apart than the clock have evenly
    spaced ticks between them.
    """
    base = needs.series[needs.base].times
    period = period_of(base)
    stride = max(1, round(every / period))
    kept = base[::stride]
    steps = np.maximum(1, np.rint(np.diff(kept) / every))
    fits = np.abs(np.diff(kept) - steps * every) <= CLOCK_SLACK * every * steps
    if len(fits) == 0 or np.mean(fits) < 1.0 - CLOCK_SLACK:
        return None
    return _grid(needs, _divided(kept, steps))


def moved_inputs(grid: Grid, needs: Needs, shifts: dict[str, Array]) -> Grid:
    """The grid with `shifts` (one number per sample of the series) added to some inputs."""
    inputs = np.array(grid.inputs)
    for column, each in enumerate(needs.inputs):
        if each.name in shifts and each.series is not None:
            at = np.searchsorted(each.series.times, grid.times, side="right") - 1
            inputs[:, column] += shifts[each.name][np.clip(at, 0, None)]
    return replace(grid, inputs=_within(inputs, needs))


def early_inputs(grid: Grid, needs: Needs, mode: str, seconds: float) -> Grid | None:
    """The grid with every measured input but the mode so much earlier; None where none changes."""
    inputs = np.array(grid.inputs)
    for column, each in enumerate(needs.inputs):
        if each.series is not None and each.name != mode:
            inputs[:, column] = held(each.series, grid.times + seconds)
    if np.array_equal(inputs, grid.inputs):
        return None
    return Grid(grid.times, _within(inputs, needs), grid.columns, grid.leaps)


def _grid(needs: Needs, times: Array) -> Grid:
    values = [
        np.full(len(times), each.value) if each.series is None else held(each.series, times)
        for each in needs.inputs
    ]
    inputs = np.stack(values, axis=-1) if values else np.empty((len(times), 0))
    columns = np.array([each.column for each in needs.inputs], dtype=np.int64)
    leaps = np.searchsorted(times, needs.leaps.times)
    return Grid(times, _within(inputs, needs), columns, leaps)


def _within(inputs: Array, needs: Needs) -> Array:
    """Inputs (G, k or more) clipped to their domains: what rounding put beyond stays usable.

    Where a measured input is truly outside, `segments` has excluded the time. Columns beyond those
    of `needs` (rates that a diagnosis puts in) have no domain.
    """
    more = np.full(inputs.shape[1] - len(needs.inputs), np.inf)
    low = np.array([*(each.low for each in needs.inputs), *-more])
    high = np.array([*(each.high for each in needs.inputs), *more])
    return np.clip(inputs, low, high)


def _refined(knots: Array, max_step: float, longest: float) -> Array:
    """The knots, with steps above `max_step` divided; steps above `longest` are gaps."""
    steps = np.diff(knots)
    pieces = np.ceil(steps / max_step - 1e-9)
    return _divided(knots, np.where(steps > longest, 1.0, np.maximum(1.0, pieces)))


def _divided(knots: Array, pieces: Array) -> Array:
    """The knots (G,), with step i divided into `pieces[i]` equal ones."""
    count = pieces.astype(np.int64)
    first = np.repeat(np.cumsum(count) - count, count)
    part = (np.arange(int(count.sum())) - first) / np.repeat(pieces, count)
    inner = np.repeat(knots[:-1], count) + part * np.repeat(np.diff(knots), count)
    return np.append(inner, knots[-1])

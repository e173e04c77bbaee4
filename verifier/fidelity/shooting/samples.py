"""The measured values of each predicted state, tied to the knots of the time grid."""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.program import Kind, State
from verifier.fidelity.shooting.grid import Grid
from verifier.fidelity.shooting.prediction import Model
from verifier.fidelity.stretches.needs import Needs, period_of
from verifier.traces.trace import Series


@final
@dataclass(frozen=True, eq=False, slots=True)
class Samples:
    """One predicted state as measured: `times` and `values` (M,), at `knots` (M,) of the grid.

    column: of the state vector. turn: the period of a periodic state, else 0. distance: the
    median time from one sample to the next.
    """

    state: State
    column: int
    times: Array
    values: Array
    knots: Integers
    turn: float
    distance: float


def samples_of(needs: Needs, grid: Grid, every: float) -> tuple[Samples, ...]:
    """The samples of each predicted state; `every` is the clock of a step map, 0 for a flow."""
    parts = zip(needs.columns, needs.driven, needs.series, strict=True)
    return tuple(
        _samples(column, state, series, _knots(series, grid, every), grid)
        for column, state, series in parts
    )


def turned(difference: Array, turn: float) -> Array:
    """A difference of angles on the shorter way round; other differences as they are.

    >>> turned(np.array([3.0, 6.0]), 2 * np.pi).round(2)
    array([ 3.  , -0.28])
    """
    return difference - turn * np.rint(difference / turn) if turn > 0.0 else difference


def nearest(times: Array, to: Array) -> Integers:
    """The index of the sample nearest to each time."""
    after = np.clip(np.searchsorted(times, to), 1, max(len(times) - 1, 1))
    before = after - 1
    after = np.minimum(after, len(times) - 1)
    return np.where(to - times[before] <= times[after] - to, before, after)


def edges(samples: Samples) -> tuple[float, float]:
    """Between which values a prediction may start."""
    if samples.turn > 0.0:
        return -np.inf, np.inf
    return samples.state.low, samples.state.high


def measured_states(model: Model, samples: tuple[Samples, ...], knots: Integers) -> Array:
    """The state vectors (W, n) at `knots`: inputs as held, predicted states by nearest sample."""
    states = np.zeros((len(knots), model.states))
    sensed = model.grid.columns < model.states
    states[:, model.grid.columns[sensed]] = model.grid.inputs[knots][:, sensed]
    for each in samples:
        at = nearest(each.times, model.grid.times[knots])
        states[:, each.column] = np.clip(each.values[at], *edges(each))
    return states


def _knots(series: Series, grid: Grid, every: float) -> Integers:
    """The knot of each sample, -1 for a sample that a map's clock passes over."""
    if every == 0.0:
        return np.searchsorted(grid.times, series.times)
    chosen = nearest(series.times, grid.times)
    near = np.abs(series.times[chosen] - grid.times) <= every / 2.0
    knots = np.full(len(series.times), -1)
    knots[chosen[near]] = np.flatnonzero(near)
    return knots


def _samples(column: int, state: State, series: Series, knots: Integers, grid: Grid) -> Samples:
    used = knots >= 0
    times = grid.times[knots[used]]
    turn = state.high - state.low if state.kind is Kind.PERIODIC else 0.0
    return Samples(state, column, times, series.values[used], knots[used], turn, period_of(times))

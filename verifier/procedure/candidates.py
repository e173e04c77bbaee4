"""Runs that could be driven: starts and inputs drawn evenly over what has to be covered.

Drawn by an additive recurrence (Roberts, The unreasonable effectiveness of quasirandom sequences,
2018), so that the same spec always has the same procedure, and rounded to what people can set.
"""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from runtime.arrays import Array, frozen
from runtime.program import Control, Fidelity, Kind, Program, State
from verifier.fidelity.stretches.needs import names_read
from verifier.procedure.driving import Plans, inputs_of
from verifier.procedure.levels import threshold_levels

MARGIN: Final = 0.05
"""Nothing is started or held so near, as a share of its range, to an end of its domain."""
LEVELS: Final = 3
"""A control is held low, usual and high."""
STAGES: Final = 3
"""Of a run in which there are inputs to be changed."""
STAGE_HORIZONS: Final = 3.0
"""A stage is so long: windows start in it and end in it."""
SHUFFLES: Final = 17.0
"""Of one number drawn, the digits beyond this decide whether a value beside a threshold is held."""
STEPS: Final = 50.0
"""A range is divided into so many round steps at most."""


def candidates(
    program: Program,
    fidelity: Fidelity,
    levels: Mapping[str, tuple[float, ...]],
    count: int,
    every: float,
    slower: float = 1.0,
) -> Plans:
    """So many runs; a stage is a whole number of samples `every` so many seconds.

    slower: so many times as long a stage lasts as it needs to.
    levels: the values (SI) of controls that are held at these alone.
    """
    parts: tuple[State | Control, ...] = (*program.states, *program.controls)
    inputs = inputs_of(program)
    stages = STAGES if inputs.any() else 1
    seconds = slower * STAGE_HORIZONS * fidelity.horizon * STAGES / stages
    drawn = evenly(count, (stages + 1) * len(parts)).reshape(count, stages + 1, len(parts))
    columns = [
        _of_levels(levels[each.name], drawn[..., i])
        if each.name in levels
        else _spread(program, each, drawn[..., i], fidelity)
        for i, each in enumerate(parts)
    ]
    values = np.stack(columns, axis=-1)
    whole = float(np.ceil(seconds / every - 1e-9)) * every
    n = len(program.states)
    return Plans(values[:, 0, :n], values[:, 1:], inputs, whole)


def evenly(count: int, axes: int) -> Array:
    """Points (count, axes) in the unit cube, evenly spread."""
    ratio = 2.0
    for _ in range(64):
        ratio = (1.0 + ratio) ** (1.0 / (axes + 1.0))
    alpha = ratio ** -np.arange(1.0, axes + 1.0)
    return frozen(np.mod(0.5 + np.outer(np.arange(1.0, count + 1.0), alpha), 1.0))


def _of_levels(levels: Sequence[float], share: Array) -> Array:
    """Shares of the unit interval as one of these values."""
    return np.asarray(levels)[np.floor(share * len(levels)).astype(np.int64)]


def _spread(program: Program, part: State | Control, share: Array, fidelity: Fidelity) -> Array:
    """Shares of the unit interval as values of one quantity that people can set.

    Half of them stand beside thresholds at which the mode changes, if there are any; all, where the
    quantity does nothing else.
    """
    levels = threshold_levels(program, part)
    is_guarding = part.name not in names_read(program)
    if isinstance(part, State) and part.kind is Kind.DISCRETE:
        return np.floor(share * len(part.values))
    low, high = fidelity.region.get(part.name, (part.low, part.high))
    inner = share
    if isinstance(part, Control) and part.name not in fidelity.region:
        inner = (np.floor(share * LEVELS) + 0.5) / LEVELS
    is_open = isinstance(part, State) and part.kind is Kind.CONTINUOUS
    margin = MARGIN if is_open and part.name not in fidelity.region else 0.0
    values = low + (margin + (1.0 - 2.0 * margin) * inner) * (high - low)
    values = np.clip(rounded(values, high - low, part.unit.scale), low, high)
    if not levels or part.name in fidelity.region:
        return values
    half = 1.0 if is_guarding else 2.0
    place = np.floor(np.mod(share * SHUFFLES, 1.0) * half * len(levels)).astype(np.int64)
    told = np.array([three_digits(each, part.unit.scale) for each in levels])
    return np.where(place < len(levels), told[place % len(levels)], values)


def three_digits(value: float, scale: float) -> float:
    """A value (SI) in three digits of its own unit."""
    return float(f"{value / scale:.3g}") * scale


def rounded(values: Array, width: float, scale: float) -> Array:
    """Values (SI) at round numbers of their own unit, of which `width` has fifty at most."""
    least = width / scale / STEPS
    decade = 10.0 ** np.floor(np.log10(least))
    step = decade * next(k for k in (1.0, 2.0, 5.0, 10.0) if k * decade >= least * (1.0 - 1e-9))
    return np.asarray(np.round(values / scale / step) * step * scale + 0.0)  # no -0

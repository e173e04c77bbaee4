"""Rates that are nothing but rounding: an axis along which nothing moves. m: number of axes."""

from typing import Final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.program import Kind, Program
from verifier.topology.features import Completeness, Grid
from verifier.topology.slices import Slice, all_rates_at

ROUNDING: Final = 2.0**-44
"""A rate below this share of its largest size in the whole domain of the behavior is rounding."""

PROBES: Final = 256
"""Places in the whole domain at which the size of the rates is looked at."""

SEED: Final = 11


def without_rounding(view: Slice, rates: Array) -> Array:
    """`rates` (..., m) on the slice, zero where they are below what their sums round off."""
    probed = np.abs(all_rates_at(view, _probes(view)))[:, view.columns]
    largest = np.where(np.isfinite(probed), probed, 0.0).max(axis=0)
    if view.is_map:
        # A displacement is the difference of two places.
        largest = np.maximum(largest, np.maximum(np.abs(view.low), np.abs(view.low + view.width)))
    return np.where(np.abs(rates) <= ROUNDING * largest, 0.0, rates)


def still_axes(grid: Grid) -> Booleans:
    """The axes (m,) along which nothing moves, anywhere on the grid."""
    rates = grid.rates.reshape(-1, grid.rates.shape[-1])
    return np.asarray(~np.any(np.nan_to_num(rates), axis=0) & np.isfinite(rates).any(axis=0))


def told_of_stillness(view: Slice, completeness: Completeness) -> tuple[str, ...]:
    """What it means for the fixed points that nothing moves along some axes, as a sentence."""
    still = completeness.still
    if not still:
        return ()
    moving = [axis.name for axis in view.axes if axis.name not in still]
    told = _zero(still, is_map=view.is_map)
    if not moving:
        return (f"{told} throughout: every point is a fixed point",)
    if completeness.complete:
        return (
            f"{told} throughout; there is no place where {_zero(moving, is_map=view.is_map)}, too",
        )
    filled = "fixed points fill lines" if len(view.axes) == 2 else "fixed points are not isolated"
    return (f"{told} throughout: {filled}, where {_zero(moving, is_map=view.is_map)}",)


def _zero(names: tuple[str, ...] | list[str], *, is_map: bool) -> str:
    """`x' and y' are zero`; of a map, that steps do not change them."""
    if is_map:
        return f"a step changes no {' and no '.join(names)}"
    rates = " and ".join(f"{name}'" for name in names)
    return f"{rates} {'is' if len(names) == 1 else 'are'} zero"


def _probes(view: Slice) -> Array:
    """Whole states (k, n), spread at random over all that the behavior may be in, and the ends."""
    program: Program = view.program
    low = np.array([state.low for state in program.states])
    high = np.array([state.high for state in program.states])
    at = low + (high - low) * np.random.default_rng(SEED).random((PROBES, low.size))
    at = np.concatenate([at, low[None], high[None]])
    for i, state in enumerate(program.states):
        if state.kind is Kind.DISCRETE or not np.all(np.isfinite(at[:, i])):
            at[:, i] = view.x[i]
    return at

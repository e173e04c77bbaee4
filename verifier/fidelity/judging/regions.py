"""Where in phase space: the cells that were seen, and the mean error in each part of it."""

from dataclasses import replace
from itertools import product

import numpy as np
from scipy import special

from runtime.arrays import Array, Booleans, Integers
from runtime.program import Control, Fidelity, Kind, Program, State
from verifier.fidelity.judging.departure import CONFIDENCE, count_of, mean_of, standard_error
from verifier.fidelity.stretches.needs import Needs, names_read, parts_of
from verifier.report.report import CellAxis, Coverage, RegionMean, Standing

CELLS = {1: 20, 2: 10, 3: 5}
"""Cells per axis of the coverage, by the number of axes; more axes have 3 each."""
MOST_AXES = 4
PARTS = 4
"""Parts of each axis in which mean errors are told apart: two axes jointly, more one by one."""
STILL = 1e-6
"""A variable that moves less than this share of its axis has no parts."""
ENOUGH = 3
"""So many effective samples make a cell seen."""
FEWEST_BLOCKS = 3
"""A part with fewer independent stretches has no interval worth the name."""


def axes_of(program: Program, needs: Needs, fidelity: Fidelity) -> tuple[CellAxis, ...]:
    """The axes of the declared region; without one, what the field reads, over its domain."""
    parts = parts_of(program)
    constant = {each.name for each in needs.inputs if each.series is None}
    read = [name for name in parts if name in names_read(program) and name not in constant]
    chosen = (read or list(fidelity.tolerance))[:MOST_AXES]
    bounds = fidelity.region or {name: (parts[name].low, parts[name].high) for name in chosen}
    count = CELLS.get(len(bounds), 3)
    return tuple(_axis(parts[name], edges, count) for name, edges in bounds.items())


def coverage_of(axes: tuple[CellAxis, ...], values: Array, required: float) -> Coverage:
    """The cells that the effective samples `values` (N, d) went through."""
    shape = tuple(axis.count for axis in axes)
    cells = _cell_of(axes, values, shape)
    samples = np.bincount(cells[cells >= 0], minlength=int(np.prod(shape))).reshape(shape)
    share = float(np.mean(samples >= ENOUGH))
    return Coverage(axes, samples, ENOUGH, share, required)


def region_means(
    axes: tuple[CellAxis, ...], places: Array, errors: Array, blocks: Integers, tolerance: float
) -> tuple[RegionMean, ...]:
    """The mean error of the windows in each visited part of the region that holds enough of them.

    places (W, d): where each window ran. A part exceeds the tolerance where that is shown after
    Holm's correction for the number of parts.
    """
    found, chances = [], []
    for bounds, here in _visited_parts(axes, places):
        if count_of(blocks[here]) < FEWEST_BLOCKS:
            continue
        mean, interval = mean_of(errors[here], blocks[here])
        inside = max(abs(interval.low), abs(interval.high)) <= tolerance
        standing = Standing.WITHIN if inside else Standing.UNDECIDED
        found.append(RegionMean(bounds, int(np.sum(here)), mean, interval, standing))
        chances.append(_chance(errors[here], blocks[here], tolerance))
    shown = holm(np.array(chances), (1.0 - CONFIDENCE) / 2.0)
    return tuple(
        replace(region, standing=Standing.EXCEEDED) if is_shown else region
        for region, is_shown in zip(found, shown, strict=True)
    )


def _visited_parts(
    axes: tuple[CellAxis, ...], places: Array
) -> list[tuple[dict[str, tuple[float, float]], Booleans]]:
    """Parts of what was visited of the region: their bounds, and which windows (W,) are in each."""
    if len(places) == 0:
        return []
    columns = [(_visited(a, places[:, i]), places[:, i : i + 1]) for i, a in enumerate(axes)]
    moving = [(axis, values) for axis, values in columns if axis.high > axis.low]
    groups = [moving] if len(moving) <= 2 else [[column] for column in moving]
    found = []
    for group in (group for group in groups if group):
        own = tuple(axis for axis, _ in group)
        shape = tuple(min(axis.count, PARTS) for axis in own)
        cells = _cell_of(own, np.concatenate([values for _, values in group], axis=1), shape)
        for flat, index in enumerate(product(*map(range, shape))):
            found.append((_bounds(own, index, shape), np.asarray(cells == flat)))
    return found


def _visited(axis: CellAxis, values: Array) -> CellAxis:
    """The axis between the lowest and the highest value inside it; empty where none moves."""
    inside = values[(values >= axis.low) & (values <= axis.high)]
    if len(inside) == 0 or np.ptp(inside) <= STILL * (axis.high - axis.low):
        return replace(axis, low=0.0, high=0.0)
    return replace(axis, low=float(np.min(inside)), high=float(np.max(inside)))


def worst_of(regions: tuple[RegionMean, ...]) -> RegionMean | None:
    """The part that departs most surely: the one whose interval stays furthest from zero.

    Where every interval holds zero, the one with the largest mean.
    """
    return max(
        regions,
        key=lambda r: (max(r.interval.low, -r.interval.high, 0.0), abs(r.mean)),
        default=None,
    )


def holm(chances: Array, level: float) -> list[bool]:
    """Which hypotheses are rejected at a family-wise `level` (Holm 1979).

    >>> holm(np.array([0.01, 0.04, 0.02]), 0.05)
    [True, True, True]
    >>> holm(np.array([0.01, 0.04, 0.03]), 0.05)
    [True, False, False]
    """
    order = np.argsort(chances, kind="stable")
    rejected = np.zeros(len(chances), dtype=bool)
    for rank, place in enumerate(order):
        if chances[place] > level / (len(chances) - rank):
            break
        rejected[place] = True
    return [bool(each) for each in rejected]


def _axis(part: State | Control, edges: tuple[float, float], count: int) -> CellAxis:
    if isinstance(part, State) and part.kind is Kind.DISCRETE:
        values = len(part.values)
        return CellAxis(part.name, part.unit, -0.5, values - 0.5, values)
    return CellAxis(part.name, part.unit, *edges, count)


def _cell_of(axes: tuple[CellAxis, ...], values: Array, shape: tuple[int, ...]) -> Integers:
    """The flat index (N,) of the cell of each point (N, d); -1 outside the region."""
    low = np.array([axis.low for axis in axes])
    high = np.array([axis.high for axis in axes])
    unit = (values - low) / (high - low)
    inside = np.all((unit >= 0.0) & (unit <= 1.0), axis=-1)
    index = np.clip((np.nan_to_num(unit) * shape).astype(np.int64), 0, np.array(shape) - 1)
    flat = np.ravel_multi_index(tuple(index.T), shape)
    return np.where(inside, flat, -1)


def _bounds(
    axes: tuple[CellAxis, ...], index: tuple[int, ...], shape: tuple[int, ...]
) -> dict[str, tuple[float, float]]:
    bounds = {}
    for axis, i, count in zip(axes, index, shape, strict=True):
        step = (axis.high - axis.low) / count
        bounds[axis.name] = (axis.low + i * step, axis.low + (i + 1) * step)
    return bounds


def _chance(errors: Array, blocks: Integers, tolerance: float) -> float:
    """The one-sided p-value of a mean this far beyond the tolerance."""
    beyond = abs(float(np.mean(errors))) - tolerance
    error = standard_error(errors, blocks)
    if error == 0.0:
        return 0.0 if beyond > 0.0 else 1.0
    return float(special.stdtr(count_of(blocks) - 1, -beyond / error))

"""Where in phase space: the cells of the coverage, and which of them were seen."""

from collections.abc import Collection

import numpy as np

from runtime.arrays import Array, Integers
from runtime.program import Control, Fidelity, Kind, Program, State
from verifier.fidelity.stretches.needs import names_read, parts_of
from verifier.report.report import CellAxis, Coverage

CELLS = {1: 20, 2: 10, 3: 5}
"""Cells per axis of the coverage, by the number of axes; more axes have 3 each."""
MOST_AXES = 4
ENOUGH = 3
"""So many effective samples make a cell seen."""


def axes_of(
    program: Program, constant: Collection[str], fidelity: Fidelity
) -> tuple[CellAxis, ...]:
    """The axes of the declared region; without one, what the field reads, over its domain.

    constant: the names of inputs that never change.
    """
    parts = parts_of(program)
    read = [name for name in parts if name in names_read(program) and name not in constant]
    chosen = (read or list(fidelity.tolerance))[:MOST_AXES]
    bounds = fidelity.region or {name: (parts[name].low, parts[name].high) for name in chosen}
    count = CELLS.get(len(bounds), 3)
    return tuple(axis_of(parts[name], edges, count) for name, edges in bounds.items())


def coverage_of(axes: tuple[CellAxis, ...], values: Array, required: float) -> Coverage:
    """The cells that the effective samples `values` (N, d) went through."""
    shape = tuple(axis.count for axis in axes)
    cells = cells_of(axes, values)
    samples = np.bincount(cells[cells >= 0], minlength=int(np.prod(shape))).reshape(shape)
    share = float(np.mean(samples >= ENOUGH))
    return Coverage(axes, samples, ENOUGH, share, required)


def axis_of(part: State | Control, edges: tuple[float, float], count: int) -> CellAxis:
    """The axis of one quantity; a discrete one has a cell for each value."""
    if isinstance(part, State) and part.kind is Kind.DISCRETE:
        values = len(part.values)
        return CellAxis(part.name, part.unit, -0.5, values - 0.5, values, part.values)
    return CellAxis(part.name, part.unit, *edges, count)


def cells_of(axes: tuple[CellAxis, ...], values: Array) -> Integers:
    """The flat index (...) of the cell of each point (..., d); -1 outside the region."""
    shape = tuple(axis.count for axis in axes)
    low = np.array([axis.low for axis in axes])
    high = np.array([axis.high for axis in axes])
    unit = (values - low) / (high - low)
    inside = np.all((unit >= 0.0) & (unit <= 1.0), axis=-1)
    index = np.clip((np.nan_to_num(unit) * shape).astype(np.int64), 0, np.array(shape) - 1)
    flat = np.ravel_multi_index(tuple(np.moveaxis(index, -1, 0)), shape)
    return np.where(inside, flat, -1)

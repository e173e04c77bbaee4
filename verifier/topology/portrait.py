"""The phase portrait of a behavior: topology first, as numbers; others draw it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import frozen
from runtime.program import Program
from verifier.topology.cycles.limit_cycles import DIRECTIONS, find_cycles
from verifier.topology.ends.basins import find_basins
from verifier.topology.features import (
    Cycle,
    FixedPoint,
    Grid,
    Portrait,
    Separatrix,
    Trajectory,
)
from verifier.topology.hybrid.flow import hybrid_of
from verifier.topology.hybrid.portrait import with_modes
from verifier.topology.lines.nullclines import find_nullclines
from verifier.topology.manifolds.separatrices import find_separatrices
from verifier.topology.paths.orbits import find_orbits
from verifier.topology.paths.trajectories import find_trajectories
from verifier.topology.slices import Slice, SliceError, cut, rates_at
from verifier.topology.zeros.fixed_points import find_fixed_points
from verifier.topology.zeros.stillness import told_of_stillness, without_rounding


@final
@dataclass(frozen=True, slots=True)
class Detail:
    """How finely to look: points per axis by the number of axes, and how many trajectories.

    cycles, separatrices, nullclines: whether they are looked for. basins: cells per axis, 0 for
    none. rays: how many are laid from each point to find cycles. compared: whether zeros of
    tables are held against those of the formula.
    """

    plane: int = 257
    line: int = 2049
    solid: int = 33
    trajectories: int = 4
    cycles: bool = True
    separatrices: bool = True
    nullclines: bool = True
    basins: int = 0
    rays: int = len(DIRECTIONS)
    compared: bool = True


EVERYTHING: Final = Detail()

MOST_AXES: Final = 3
"""More axes nobody can draw; their fixed points are proved all the same."""

FIELD_STRIDE: Final = 4
"""Every which node of the search grid is kept in the portrait."""


def portrait(
    program: Program,
    axes: tuple[str, ...] | None = None,
    held: Mapping[str, float] | None = None,
    detail: Detail = EVERYTHING,
) -> Portrait:
    """The portrait over one to three states, everything else held at `held` (SI).

    Without `axes` the first two variables that move by themselves are taken, or the only one.
    What `held` does not name stays at a control's default, a state's `hold`.

    Raises:
        SliceError: an axis or a held value that the behavior does not have.
    """
    view = cut(program, axes, held or {})
    if len(view.axes) > MOST_AXES:
        named = ", ".join(axis.name for axis in view.axes)
        raise SliceError(f"a portrait has one to three different axes (got {named})")
    grid = _sampled(view, detail)
    hybrid = hybrid_of(view)
    if hybrid is None:
        return _assembled(program, view, grid, detail)
    one_mode = replace(detail, separatrices=False, trajectories=0, basins=0)
    return with_modes(
        hybrid,
        _assembled(program, view, grid, one_mode),
        grid,
        cycles=detail.cycles,
        paths=detail.trajectories,
        basins=detail.basins,
        compared=detail.compared,
    )


def _assembled(program: Program, view: Slice, grid: Grid, detail: Detail) -> Portrait:
    """The portrait; of a field with modes, as if the one that is shown were never left."""
    points, completeness, remarks = find_fixed_points(view, grid, compare=detail.compared)
    moves = len(completeness.still) < len(view.axes)
    cycles, hints = _cycles(view, points, detail) if moves else ((), ())
    separatrices = find_separatrices(view, points, cycles) if detail.separatrices else ()
    lines = detail.nullclines and len(view.axes) == 2
    return Portrait(
        name=program.name,
        about=program.about,
        axes=view.axes,
        held=view.held,
        every=program.field.every,
        field=_thinned(grid, 2 * FIELD_STRIDE if len(view.axes) == 1 else FIELD_STRIDE),
        nullclines=find_nullclines(view, grid) if lines else (),
        fixed_points=points,
        completeness=completeness,
        cycles=cycles,
        separatrices=separatrices,
        basins=find_basins(view, points, cycles, detail.basins),
        switching=(),
        trajectories=_trajectories(view, grid, detail, points, separatrices),
        notes=(
            *remarks,
            *hints,
            *told_of_stillness(view, completeness),
            *_held_ones(program, view),
        ),
    )


def _cycles(
    view: Slice, points: tuple[FixedPoint, ...], detail: Detail
) -> tuple[tuple[Cycle, ...], tuple[str, ...]]:
    """The cycles, and notes on them; none where nobody asked."""
    return find_cycles(view, points, detail.rays) if detail.cycles else ((), ())


def _trajectories(
    view: Slice,
    grid: Grid,
    detail: Detail,
    points: tuple[FixedPoint, ...],
    separatrices: tuple[Separatrix, ...],
) -> tuple[Trajectory, ...]:
    """Orbits of a map, trajectories in a plane; a line shows its own."""
    if view.is_map:
        return find_orbits(view, detail.trajectories)
    if len(view.axes) == 1 or detail.trajectories == 0:
        return ()
    return find_trajectories(view, grid, points, separatrices, detail.trajectories)


def _sampled(view: Slice, detail: Detail) -> Grid:
    """The field on the fine grid that zeros and nullclines are looked for on."""
    count = (detail.line, detail.plane, detail.solid)[len(view.axes) - 1]
    nodes = tuple(frozen(np.linspace(axis.low, axis.high, count)) for axis in view.axes)
    points = np.stack(np.meshgrid(*nodes, indexing="ij"), axis=-1)
    return Grid(nodes, frozen(without_rounding(view, rates_at(view, points))))


def _thinned(grid: Grid, stride: int) -> Grid:
    every: slice = slice(None, None, stride)
    nodes = tuple(frozen(axis[every]) for axis in grid.nodes)
    return Grid(nodes, frozen(grid.rates[(every,) * len(nodes)]))


def _held_ones(program: Program, view: Slice) -> tuple[str, ...]:
    """A note on what moves in the behavior, but not here."""
    kept = {*(axis.name for axis in view.axes), program.field.mode}
    others = [state.name for state in program.states if state.is_driven and state.name not in kept]
    return (f"held although the behavior drives it: {', '.join(others)}",) if others else ()

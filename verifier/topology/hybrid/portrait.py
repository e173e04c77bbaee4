"""What modes add to a portrait: lines where one is left, cycles and paths through all of them.

m: number of axes; n: of states.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array, frozen
from verifier.topology.cycles.limit_cycles import find_cycles
from verifier.topology.features import (
    Completeness,
    Cycle,
    FixedPoint,
    Grid,
    Portrait,
    Switching,
    Trajectory,
)
from verifier.topology.hybrid.basins import find_hybrid_basins
from verifier.topology.hybrid.contours import zero_lines
from verifier.topology.hybrid.cycles import find_hybrid_cycles
from verifier.topology.hybrid.flow import (
    ROUGH,
    Hybrid,
    conditions,
    followed,
    leaves_at,
    on_axes,
    points_in,
)
from verifier.topology.paths.seeds import spread
from verifier.topology.slices import cut, rates_at, wrapped
from verifier.topology.zeros.fixed_points import find_fixed_points
from verifier.topology.zeros.stillness import without_rounding

FIELD_OF: Final = "the field is that of"
OF_ALL: Final = "fixed points and cycles are those of all modes"
OF_EACH_PANEL: Final = f"the field of each panel is that of its mode; {OF_ALL}"
"""The note on a portrait among those of all modes."""

LASTING: Final = 4.0
"""How long paths are followed, in tempos."""
SAMPLES: Final = 400


@final
@dataclass(frozen=True, eq=False, slots=True)
class InMode:
    """What one mode's field has where the mode is not left, and notes on what it seems to have."""

    mode: int
    fixed_points: tuple[FixedPoint, ...]
    cycles: tuple[Cycle, ...]
    completeness: Completeness
    notes: tuple[str, ...]


def with_modes(
    hybrid: Hybrid,
    plain: Portrait,
    grid: Grid,
    *,
    cycles: bool,
    paths: int,
    basins: int,
    compared: bool,
) -> Portrait:
    """The portrait with all modes, given `plain`: as if the shown mode were never left.

    cycles: whether they are looked for; paths: how many are followed; basins: cells per axis;
    compared: whether zeros of tables are held against those of the formula. Separatrices are not
    traced.
    """
    shown = _kept(hybrid, hybrid.shown, (plain.fixed_points, plain.cycles, plain.completeness))
    others = (mode for mode in range(len(hybrid.modes)) if mode != hybrid.shown)
    look = {"cycles": cycles, "compared": compared}
    each = (shown, *(_in_mode(hybrid, mode, grid, **look) for mode in others))
    through, notes, rests = find_hybrid_cycles(hybrid) if cycles else ((), (), ())
    closed = (*through, *(cycle for one in each for cycle in one.cycles))
    closed = tuple(sorted(closed, key=lambda cycle: cycle.period))
    resting = tuple((point, one.mode) for one in each for point in one.fixed_points)
    flat = len(hybrid.view.axes) <= 2
    return replace(
        plain,
        fixed_points=tuple(point for point, _ in resting),
        completeness=_together([one.completeness for one in each]),
        cycles=closed,
        separatrices=(),
        basins=find_hybrid_basins(hybrid, resting, closed, basins),
        switching=tuple(_lines(hybrid, grid)) if flat else (),
        trajectories=tuple(_paths(hybrid, paths)) if len(hybrid.view.axes) > 1 and paths else (),
        notes=(
            _about(hybrid),
            *plain.notes,
            *(_where(hybrid, point, mode) for point, mode in resting if mode != hybrid.shown),
            *(note for one in each for note in one.notes),
            *notes,
        ),
        rests=rests,
    )


def _about(hybrid: Hybrid) -> str:
    mode, shown = hybrid.flow.program.field.mode, hybrid.modes[hybrid.shown]
    return f"{FIELD_OF} {mode} = '{shown}'; {OF_ALL}"


def _where(hybrid: Hybrid, point: FixedPoint, mode: int) -> str:
    return f"the {point.kind} at {_place(hybrid, point.at)} is one of '{hybrid.modes[mode]}'"


def _in_mode(hybrid: Hybrid, mode: int, grid: Grid, *, cycles: bool, compared: bool) -> InMode:
    """What another mode than the shown one has."""
    whole = hybrid.view.whole.program
    held = {each.name: each.value for each in hybrid.view.held} | {whole.field.mode: float(mode)}
    view = cut(whole, tuple(axis.name for axis in hybrid.view.axes), held)
    places = np.stack(np.meshgrid(*grid.nodes, indexing="ij"), axis=-1)
    on_grid = Grid(grid.nodes, without_rounding(view, rates_at(view, places)))
    points, completeness, _ = find_fixed_points(view, on_grid, compare=compared)
    closed = find_cycles(view, points)[0] if cycles else ()
    return _kept(hybrid, mode, (points, closed, completeness))


def _kept(
    hybrid: Hybrid,
    mode: int,
    found: tuple[tuple[FixedPoint, ...], tuple[Cycle, ...], Completeness],
) -> InMode:
    """What lies where the mode is not left, and a note on each point that does not."""
    points, cycles, completeness = found
    left = [bool(leaves_at(hybrid, wrapped(hybrid.view, p.at[None]), mode)[0]) for p in points]
    return InMode(
        mode,
        tuple(point for point, gone in zip(points, left, strict=True) if not gone),
        tuple(
            replace(cycle, modes=(mode,) * len(cycle.points))
            for cycle in cycles
            if not leaves_at(hybrid, wrapped(hybrid.view, cycle.points), mode).any()
        ),
        completeness,
        tuple(
            f"no fixed point, although the field of '{hybrid.modes[mode]}' is zero there, as that "
            f"mode is left: {_place(hybrid, point.at)}"
            for point, gone in zip(points, left, strict=True)
            if gone
        ),
    )


def _together(each: list[Completeness]) -> Completeness:
    """What is known of all modes: as much as of the one of which least is known."""
    abouts = {one.about for one in each}
    return Completeness(
        complete=all(one.complete for one in each),
        undecided=tuple(box for one in each for box in one.undecided),
        lost=frozen(np.concatenate([one.lost for one in each])),
        about=abouts.pop() if len(abouts) == 1 else "",
        still=tuple(name for name in each[0].still if all(name in one.still for one in each)),
    )


def _place(hybrid: Hybrid, at: Array) -> str:
    axes = zip(hybrid.view.axes, at, strict=True)
    return ", ".join(f"{axis.name} = {value / axis.unit.scale:.4g}" for axis, value in axes)


def _lines(hybrid: Hybrid, grid: Grid) -> Iterator[Switching]:
    """Where the shown mode is left."""
    guards = tuple(guard for guard in hybrid.guards if guard.mode == hybrid.shown)
    if not guards:
        return
    places = np.stack(np.meshgrid(*grid.nodes, indexing="ij"), axis=-1)
    values = conditions(hybrid, guards, points_in(hybrid, places, hybrid.shown))
    for i, guard in enumerate(guards):
        lines = tuple(frozen(line) for line in _zeros(grid, values[..., i]))
        yield Switching(hybrid.modes[guard.mode], hybrid.modes[guard.target], lines)


def _zeros(grid: Grid, values: Array) -> tuple[Array, ...]:
    """Where values on the grid are zero: lines (k, 2), on one axis single points (1, 1)."""
    if len(grid.nodes) == 2:
        return zero_lines(grid.nodes, values)
    (nodes,) = grid.nodes
    left = np.flatnonzero((values[:-1] >= 0.0) != (values[1:] >= 0.0))
    share = values[left] / (values[left] - values[left + 1])
    at = nodes[left] + share * (nodes[left + 1] - nodes[left])
    return tuple(place.reshape(1, 1) for place in at)


def _paths(hybrid: Hybrid, count: int) -> Iterator[Trajectory]:
    """Paths from spread places in the shown mode, through all that follows."""
    places = spread(hybrid.view, 4 * count)
    places = places[~leaves_at(hybrid, places, hybrid.shown)][:count]
    if not len(places) or not np.isfinite(hybrid.tempo):
        return
    times = np.linspace(0.0, LASTING * hybrid.tempo, SAMPLES)
    starts = points_in(hybrid, places, hybrid.shown)
    ran = followed(hybrid, starts, times, ROUGH)
    for b in range(len(places)):
        mine = ran.switches.of(b)
        known = np.all(np.isfinite(ran.states[b]), axis=-1)
        clock = np.concatenate([times[known], mine.times, mine.times])
        states = np.concatenate([ran.states[b, known], mine.before, mine.after])
        rank = np.repeat([0, 1, 2], [int(known.sum()), len(mine), len(mine)])
        order = np.lexsort((rank, clock))
        points = on_axes(hybrid, states)[order]
        yield Trajectory(frozen(clock[order]), frozen(points), 0)

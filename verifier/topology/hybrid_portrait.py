"""What modes add to a portrait: lines where one is left, cycles and paths through all of them.

m: number of axes; n: of states.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from runtime.arrays import Array, frozen
from verifier.topology.contours import zero_lines
from verifier.topology.features import (
    Course,
    Cycle,
    FixedPoint,
    Grid,
    Portrait,
    Switching,
    Trajectory,
)
from verifier.topology.hybrid import (
    ROUGH,
    Hybrid,
    conditions,
    followed,
    leaves_at,
    on_axes,
    points_in,
)
from verifier.topology.hybrid_basins import find_hybrid_basins
from verifier.topology.hybrid_cycles import find_hybrid_cycles
from verifier.topology.seeds import spread
from verifier.topology.slices import wrapped

LASTING: Final = 4.0
"""How long paths are followed, in tempos."""
SAMPLES: Final = 400


def with_modes(
    hybrid: Hybrid, plain: Portrait, grid: Grid, *, cycles: bool, paths: int, basins: int
) -> Portrait:
    """The portrait with all modes, given `plain`: as if the shown mode were never left.

    cycles: whether those through several modes are looked for; paths: how many are followed;
    basins: cells per axis. Separatrices are not traced.
    """
    fixed_points, gone = _kept(hybrid, plain.fixed_points)
    found, notes = find_hybrid_cycles(hybrid) if cycles else ((), ())
    closed = (*_within(hybrid, plain.cycles), *found)
    closed = tuple(sorted(closed, key=lambda cycle: cycle.period))
    planar = len(hybrid.view.axes) == 2
    mode, shown = hybrid.flow.program.field.mode, hybrid.modes[hybrid.shown]
    about = f"field and fixed points are those of {mode} = '{shown}'; cycles go through all modes"
    return replace(
        plain,
        fixed_points=fixed_points,
        cycles=closed,
        separatrices=(),
        basins=find_hybrid_basins(hybrid, fixed_points, closed, basins),
        switching=tuple(_lines(hybrid, grid)) if planar else (),
        trajectories=tuple(_paths(hybrid, paths)) if len(hybrid.view.axes) > 1 and paths else (),
        notes=(about, *plain.notes, *gone, *notes),
    )


def _kept(
    hybrid: Hybrid, fixed_points: tuple[FixedPoint, ...]
) -> tuple[tuple[FixedPoint, ...], tuple[str, ...]]:
    """The points where the shown mode is not left, and a note on the others."""
    if not fixed_points:
        return (), ()
    places = np.array([point.at for point in fixed_points])
    left = leaves_at(hybrid, wrapped(hybrid.view, places), hybrid.shown)
    kept = tuple(point for point, gone in zip(fixed_points, left, strict=True) if not gone)
    shown = hybrid.modes[hybrid.shown]
    notes = tuple(
        f"no fixed point, although the field of '{shown}' is zero there, as that mode is left: "
        f"{_place(hybrid, point.at)}"
        for point, gone in zip(fixed_points, left, strict=True)
        if gone
    )
    return kept, notes


def _place(hybrid: Hybrid, at: Array) -> str:
    axes = zip(hybrid.view.axes, at, strict=True)
    return ", ".join(f"{axis.name} = {value / axis.unit.scale:.4g}" for axis, value in axes)


def _within(hybrid: Hybrid, cycles: tuple[Cycle, ...]) -> Iterator[Cycle]:
    """Cycles of the shown mode along which it is never left."""
    for cycle in cycles:
        points = wrapped(hybrid.view, cycle.points)
        if not leaves_at(hybrid, points, hybrid.shown).any():
            yield replace(cycle, modes=(hybrid.shown,) * len(points))


def _lines(hybrid: Hybrid, grid: Grid) -> Iterator[Switching]:
    """Where the shown mode is left."""
    guards = tuple(guard for guard in hybrid.guards if guard.mode == hybrid.shown)
    if not guards:
        return
    places = np.stack(np.meshgrid(*grid.nodes, indexing="ij"), axis=-1)
    values = conditions(hybrid, guards, points_in(hybrid, places, hybrid.shown))
    for i, guard in enumerate(guards):
        lines = tuple(frozen(line) for line in zero_lines(grid.nodes, values[..., i]))
        yield Switching(hybrid.modes[guard.mode], hybrid.modes[guard.target], lines)


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
        yield Trajectory(Course.SEED, frozen(clock[order]), frozen(points), 0)

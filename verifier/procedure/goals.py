"""What the runs of a procedure have to show, in the numbers by which the verifier judges.

A goal is a number of samples, or of switches, that all runs together must provide: in each cell of
the coverage, at low, usual and high values of each input, in each value of what is discrete, of
each way out of a mode. Letters: C runs, G goals.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.program import Control, Fidelity, Kind, Program
from verifier.fidelity.judging.part_means import CLUSTER_HORIZONS
from verifier.fidelity.judging.parts import LEAST
from verifier.fidelity.judging.regions import ENOUGH, axes_of, axis_of, cells_of
from verifier.fidelity.recording import stride_of
from verifier.fidelity.stretches.needs import names_guarded, names_read, parts_of
from verifier.fidelity.stretches.segments import on_circle
from verifier.fidelity.switching.means import FEWEST
from verifier.procedure.candidates import LEVELS
from verifier.procedure.driving import Paths
from verifier.report.report import CellAxis

SHORTEST: Final = 2.0
"""A run lasts for at least so many horizons."""
SHOWN: Final = 5.0
"""The runs together move what is judged by so many tolerances, at the horizon, by each input."""
SPARE: Final = 1
"""So many samples more than a cell needs, since noise moves a few of them elsewhere."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Goals:
    """What C runs provide for G goals: gives (C, G), needs (G,), names (G,).

    axes, in_cell: of the coverage, and (C, cells) the samples of each run in each of its cells.
    is_cell: (G,) which goals are joint cells of a declared region.
    """

    gives: Array
    needs: Array
    names: tuple[str, ...]
    is_cell: Booleans
    axes: tuple[CellAxis, ...]
    in_cell: Integers


def judged_samples(horizon: float, every: float) -> float:
    """So many samples the smallest part needs that is judged on its own."""
    return LEAST * CLUSTER_HORIZONS * horizon / every


def goals_of(
    program: Program, fidelity: Fidelity, paths: Paths, held: Collection[str] = ()
) -> Goals:
    """What these runs provide; one in which hardly a window fits provides nothing.

    held: controls that are not to be varied.
    """
    every = float(paths.times[1])
    fits = paths.alive * every >= SHORTEST * fidelity.horizon
    paths = replace(paths, alive=np.where(fits, paths.alive, 0), taken=paths.taken * fits[:, None])
    columns = _columns(program, paths)
    axes = axes_of(program, (), fidelity)
    in_cell = _counts(axes, columns, paths, stride_of(fidelity.horizon, every))
    has_region = bool(fidelity.region) and fidelity.coverage > 0.0
    told = {axis.name for axis in axes} if has_region else set()
    parts = [_Part(in_cell, float(ENOUGH + SPARE), ("",) * in_cell.shape[1])] if has_region else []
    for axis in _single_axes(program, axes, told | set(held)):
        least = judged_samples(fidelity.horizon, every) if axis.values else fidelity.horizon / every
        values = tuple(_told(axis, k) for k in range(axis.count))
        parts.append(_Part(_counts((axis,), columns, paths, 1), least, values))
    ways = tuple(_way(program, index) for index in range(paths.taken.shape[1]))
    parts.append(_Part(paths.taken, float(FEWEST + SPARE), ways))
    parts.append(_Part(paths.alive[:, None], judged_samples(fidelity.horizon, every), ("",)))
    return Goals(
        gives=np.concatenate([each.gives for each in parts], axis=1).astype(np.float64),
        needs=np.array([each.need for each in parts for _ in each.names]),
        names=tuple(name for each in parts for name in each.names),
        is_cell=np.array([has_region and each is parts[0] for each in parts for _ in each.names]),
        axes=axes,
        in_cell=in_cell,
    )


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Part:
    """Goals of one sort: gives (C, number of names), and how much each of them needs."""

    gives: Integers
    need: float
    names: tuple[str, ...]


def with_effects(goals: Goals, effects: Mapping[str, Array]) -> Goals:
    """The goals, and for each input that moves what is judged: that some runs show by how much.

    effects: (C,) by name, in tolerances at the horizon.
    """
    shown = [each for each in effects.values() if each.max(initial=0.0) >= 1.0]
    gives = np.column_stack([goals.gives, *shown])
    needs = np.array([*goals.needs, *(min(SHOWN, float(each.max())) for each in shown)])
    names = (*goals.names, *("" for _ in shown))
    is_cell = np.append(goals.is_cell, np.zeros(len(shown), dtype=np.bool_))
    return replace(goals, gives=gives, needs=needs, names=names, is_cell=is_cell)


def _single_axes(program: Program, axes: tuple[CellAxis, ...], told: set[str]) -> list[CellAxis]:
    """The axes that are covered each by itself: all that is read and no region tells of."""
    read = names_read(program) | names_guarded(program)
    discrete = {state.name for state in program.states if state.kind is Kind.DISCRETE}
    own = {axis.name: axis for axis in axes}
    found = []
    for name, part in parts_of(program).items():
        is_level = name in names_read(program) or name == program.field.mode
        if name in told or not (is_level or (name in read and name in discrete)):
            continue
        by_levels = isinstance(part, Control) or name not in own
        found.append(axis_of(part, (part.low, part.high), LEVELS) if by_levels else own[name])
    return found


def _columns(program: Program, paths: Paths) -> dict[str, Array]:
    """(C, T) of each state and control, angles within their domain."""
    parts = parts_of(program)
    return {
        name: on_circle(part, paths.register[..., i])
        for i, (name, part) in enumerate(parts.items())
    }


def _counts(
    axes: tuple[CellAxis, ...], columns: dict[str, Array], paths: Paths, stride: int
) -> Integers:
    """(C, cells) effective samples of each run, while it lasts."""
    points = np.stack([columns[axis.name] for axis in axes], axis=-1)[:, ::stride]
    cells = np.where(paths.is_alive[:, ::stride], cells_of(axes, points), -1)
    size = int(np.prod([axis.count for axis in axes]))
    runs = np.broadcast_to(np.arange(len(cells))[:, None], cells.shape)
    flat = (runs * size + cells)[cells >= 0]
    return np.bincount(flat, minlength=len(cells) * size).reshape(len(cells), size)


def _told(axis: CellAxis, k: int) -> str:
    if axis.values:
        return f"{axis.name} = {axis.values[k]}"
    edges = np.linspace(axis.low, axis.high, axis.count + 1) / axis.unit.scale
    unit = "" if axis.unit.text in {"", "1"} else f" {axis.unit.text}"
    return f"{axis.name} {edges[k]:.3g} to {edges[k + 1]:.3g}{unit}"


def _way(program: Program, index: int) -> str:
    guard = program.field.guards[index]
    mode = next(s for s in program.states if s.name == program.field.mode)
    return f"{mode.values[guard.mode]} to {mode.values[guard.target]}"

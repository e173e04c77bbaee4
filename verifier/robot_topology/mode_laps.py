"""Laps of a robot around a cycle that changes its mode on the way.

The modes tell laps by themselves: a lap is the sequence of changes that the spec's cycle makes,
from one of them to the same one again. That holds where the state alone tells nothing (on a single
axis there is no way round), and noise does not make or break a lap.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from verifier.fidelity.stretches.changes import Changes
from verifier.robot_topology.laps import Laps, settled_runs
from verifier.robot_topology.scene import Stretch
from verifier.topology.features import Cycle

UNLIKE: Final = 3.0
"""A lap takes at most so many times as long as most do, and at least the inverse."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Round:
    """The changes of mode in one lap of the spec's cycle: (left, entered) at `phases` (L,)."""

    changes: tuple[tuple[int, int], ...]
    phases: Array


def round_of(cycle: Cycle) -> Round | None:
    """None for a cycle that stays in one mode."""
    modes = np.array(cycle.modes, dtype=np.int64)
    after = np.flatnonzero(np.diff(modes)) + 1
    if len(after) < 2:
        return None
    phases = np.mod((cycle.times[after] - cycle.times[0]) / cycle.period, 1.0)
    order = np.argsort(phases, kind="stable")
    pairs = tuple((int(modes[k - 1]), int(modes[k])) for k in after[order])
    return Round(pairs, phases[order])


def laps_by_modes(stretches: tuple[Stretch, ...], changes: Changes, way: Round) -> tuple[Laps, ...]:
    """The robot's laps in each stretch, once they have settled."""
    found = [_passages(stretch, changes, way) for stretch in stretches]
    lengths = np.concatenate([np.diff(each[0][0]) for each in found]) if found else np.empty(0)
    lengths = lengths[np.isfinite(lengths)]
    if not len(lengths):
        return ()
    usual = float(np.median(lengths))
    return tuple(
        laps
        for stretch, (passages, doubt) in zip(stretches, found, strict=True)
        for laps in settled_runs(
            stretch, passages, _like(passages[0], usual), phases=way.phases, doubt=doubt
        )
    )


def _passages(stretch: Stretch, changes: Changes, way: Round) -> tuple[Array, float]:
    """When each change of the round happened in each lap (L, k + 1), and the doubt about them.

    NaN in a column stands for a way that is not the cycle's.
    """
    inside = (changes.since >= stretch.times[0]) & (changes.until <= stretch.times[-1])
    real = np.flatnonzero(inside & (changes.left != changes.entered))
    pairs = [(int(changes.left[k]), int(changes.entered[k])) for k in real]
    count = len(way.changes)
    columns: list[list[float]] = []
    i = 0
    while i < len(pairs):
        ahead = pairs[i : i + count]
        if ahead == list(way.changes[: len(ahead)]):
            times = [float(t) for t in changes.times[real[i : i + count]]]
            columns.append(times + [np.nan] * (count - len(times)))
            i += count
        else:
            columns.append([np.nan] * count)
            i += 1
    table = np.array(columns).reshape(-1, count).T
    return table, float(np.median(changes.doubt[real])) if len(real) else 0.0


def _like(starts: Array, usual: float) -> list[bool]:
    """Of each pair of successive starts, whether it bounds a lap that takes about as long."""
    lengths = np.diff(starts)
    return [bool(usual / UNLIKE < length < usual * UNLIKE) for length in lengths]

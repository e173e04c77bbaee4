"""Few runs that together reach all goals: greedily, the one next that brings the most."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from runtime.arrays import Array
from verifier.procedure.goals import Goals

MOST_RUNS: Final = 24
"""A procedure of more is none that anybody drives."""
LITTLE: Final = 0.02
"""A run that brings less than this share of one goal brings nothing."""
ROOM: Final = 0.1
"""So much more of the region than is required is aimed at, since noise loses some cells."""


def chosen_runs(goals: Goals, required: float, have: Array | None = None) -> tuple[int, ...]:
    """The runs, in the order of what they bring.

    required: the share of the region's cells. have: (G,) what recordings provide already.

    The greedy choice needs at most about ln(G) times as many runs as the best one (Chvatal 1979).
    """
    left = goals.needs - (np.zeros(len(goals.needs)) if have is None else have)
    chosen: list[int] = []
    while len(chosen) < MOST_RUNS:
        left = np.maximum(left, 0.0)
        wanted = _wanted(goals, left, required)
        gains = np.sum(np.minimum(goals.gives, left) / goals.needs * wanted, axis=1)
        gains[chosen] = 0.0
        best = int(np.argmax(gains))
        if gains[best] < LITTLE:
            break
        chosen.append(best)
        left = left - goals.gives[best]
    return tuple(chosen)


def reached(goals: Goals, runs: Sequence[int]) -> Array:
    """(G,) by how much of its need each goal is met by these runs."""
    return np.asarray(goals.gives[list(runs)].sum(axis=0) / goals.needs)


def _wanted(goals: Goals, left: Array, required: float) -> Array:
    """(G,) which goals still count: cells only until the share that is required is seen."""
    wanted = left > 0.0
    cells = goals.is_cell
    if cells.any():
        seen = float(np.mean(left[cells] <= 0.0))
        if seen >= min(required + ROOM, 1.0):
            wanted = wanted & ~cells
    return wanted.astype(np.float64)

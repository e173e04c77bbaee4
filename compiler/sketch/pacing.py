"""How fast a closed curve is passed, edge by edge, so that each edge takes its own time.

The field is a sum of one over an edge's time, times a pace: that of an edge of one second. Near a
vertex one pace hands over to the next, smoothly, and there times don't simply add: the handover
lies a little into the faster edge, and factors make up for the rest, over all controls as well as
constant numbers can. t: angles (T,) evenly round the curve; K: edges; S: settings of controls.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array

TURN: Final = 2.0 * np.pi
HANDOVER: Final = 0.12
"""Half the width in which one edge's pace hands over to the next, as a share of the edges."""
SHIFTS: Final = tuple(0.05 * i for i in range(9))
"""How far into the faster edge a handover may lie, in its half width; what serves best is taken."""
COARSE: Final = 4
"""Every so many angles are enough to choose among shifts."""
ROUNDS: Final = 10
"""Of mending the factors: each leaves about a tenth of what was wrong."""
UNEVEN: Final = 1e-3
"""Speeds that differ by a lesser share are the same: their handover lies on the vertex."""


def even_paces(length: Array, starts: Array, t: Array) -> Array:
    """The paces (T, K) of a curve that is passed once a second, as long on each edge.

    length: (T,) of the curve for an angle; starts: (K,) the angles of the vertices.
    """
    windows = _windows(starts, t, np.zeros(len(starts)))
    paces = windows * (windows * length[:, np.newaxis]).mean(axis=0) * TURN / length[:, np.newaxis]
    found: Array = paces * np.mean(1.0 / paces.sum(axis=1)) * TURN
    return found


def timed_paces(length: Array, starts: Array, t: Array, seconds: Array) -> Array:
    """The paces (T, K) of a curve whose edges take times of their own.

    seconds: (S, K) examples of those times, over which the worst misfit is made least.
    """
    edge = np.searchsorted(starts, t, side="right") - 1
    on_edge = (edge[:, np.newaxis] == np.arange(len(starts))).astype(np.float64)
    lengths = (on_edge * length[:, np.newaxis]).mean(axis=0) * TURN
    aside = _towards_faster(lengths / seconds[0])

    def tried(shift: float, every: int) -> tuple[float, Array]:
        windows = _windows(starts, t[::every], shift * aside)
        paces = windows * lengths / length[::every, np.newaxis]
        return _mended(paces, on_edge[::every], seconds)

    best = min(SHIFTS, key=lambda shift: tried(shift, COARSE)[0])
    return tried(best, 1)[1]


def smooth_step(x: Array) -> Array:
    """0 below 0, 1 above 1, four times differentiable between."""
    x = np.clip(x, 0.0, 1.0)
    step: Array = x**5 * (126.0 - 420.0 * x + 540.0 * x**2 - 315.0 * x**3 + 70.0 * x**4)
    return step


def _towards_faster(speeds: Array) -> Array:
    """For each vertex (K,) where the faster edge is: 1 ahead, -1 behind, 0 where both are alike."""
    before = np.roll(speeds, 1)
    ahead, behind = speeds > before * (1.0 + UNEVEN), before > speeds * (1.0 + UNEVEN)
    return ahead.astype(np.float64) - behind


def _mended(paces: Array, on_edge: Array, seconds: Array) -> tuple[float, Array]:
    """By what share an edge's time is off at worst, and the paces with factors for the edges."""
    factors = np.ones(paces.shape[1])
    misfit = np.inf
    for _ in range(ROUNDS):
        step = TURN / len(paces) / ((factors / seconds) @ paces.T)
        share = (step @ on_edge) / seconds
        factors = factors * np.sqrt(share.max(axis=0) * share.min(axis=0))
        misfit = float(np.abs(np.log(share)).max())
    return misfit, paces * factors


def _windows(starts: Array, t: Array, aside: Array) -> Array:
    """How much (T, K) the pace of each edge counts; 1 in all.

    aside: (K,) where the handover at each vertex lies, in its half widths.
    """
    spans = np.diff(np.append(starts, TURN))
    halves = HANDOVER * np.minimum(spans, np.roll(spans, 1))
    begins = starts + aside * halves
    ends = np.roll(begins, -1)
    ends[-1] += TURN
    found = []
    for begin, end, half, following in zip(begins, ends, halves, np.roll(halves, -1), strict=True):
        along = np.mod(t - begin + half, TURN) - half
        rise = smooth_step((along + half) / (2.0 * half))
        fall = smooth_step((along - (end - begin) + following) / (2.0 * following))
        found.append(rise * (1.0 - fall))
    return np.stack(found, axis=1)

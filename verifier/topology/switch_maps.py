"""The return map of a hybrid flow: from a switch to the next one of the same kind.

A state right after a switch is taken for the start; nearby states of the same mode may be started
from, too, so that the map is one of m numbers. It forgets where along the flow it was started:
beside the multipliers of a cycle, its derivative has the eigenvalue 0.

m: number of axes; n: of states; B: lanes.
"""

from dataclasses import dataclass
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arrays import Array, Integers
from verifier.topology.hybrid import EXACT, Hybrid, followed, on_axes, points_in
from verifier.topology.slices import shortest

Kind: TypeAlias = tuple[int, int]
"""The modes that a switch leaves and enters."""

NUDGE: Final = 1e-4
"""How far starts are displaced, in widths, where the map is differentiated."""
ROUNDS: Final = 16
CLOSED: Final = 1e-9
"""How close, in widths, a cycle's end must come to its beginning."""
PATIENCE: Final = 4.0
"""How many times the expected time a return may take."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Return:
    """A cycle to be: a point (m,) after a switch, the kind of the switch, and when it comes again.

    count: which switch of that kind closes it; period: expected, or found.
    """

    point: Array
    kind: Kind
    count: int
    period: float


@final
@dataclass(frozen=True, eq=False, slots=True)
class Closed:
    """A cycle: its return, how many switches it has, and the map's derivative (m, m) in widths."""

    at: Return
    switches: int
    derivative: Array
    turns: Array


def returned(hybrid: Hybrid, points: Array, sought: Return) -> tuple[Array, Array, Integers]:
    """Where points (B, m) return to, (B, m), when (B,), after how many switches; NaN if never."""
    states = points_in(hybrid, points, sought.kind[1])
    ran = followed(hybrid, states, np.array([0.0, PATIENCE * sought.period]), EXACT)
    ends = np.full(points.shape, np.nan)
    times = np.full(len(points), np.nan)
    counts = np.zeros(len(points), dtype=np.int64)
    for b in range(len(points)):
        mine = ran.switches.of(b)
        hits = np.flatnonzero((mine.left == sought.kind[0]) & (mine.entered == sought.kind[1]))
        if len(hits) >= sought.count:
            hit = hits[sought.count - 1]
            ends[b], times[b] = on_axes(hybrid, mine.after[hit]), mine.times[hit]
            counts[b] = hit + 1
    return ends, times, counts


def closed(hybrid: Hybrid, guess: Return) -> Closed | None:
    """The cycle near a guess, by Newton's method; None where there is none."""
    view = hybrid.view
    point = guess.point
    best: Closed | None = None
    least = CLOSED
    for _ in range(ROUNDS):
        ends, times, counts = returned(hybrid, _around(hybrid, point), guess)
        gap = shortest(view, ends[0] - point) / view.width
        slope = _derivative(ends, view.width)
        if not (np.all(np.isfinite(gap)) and np.all(np.isfinite(slope))):
            break
        size = float(np.abs(gap).max())
        if size < least:
            turns = np.round((ends[0] - point) / view.width) * np.array(view.periodic)
            found = Return(point, guess.kind, guess.count, float(times[0]))
            best, least = Closed(found, int(counts[0]), slope, turns), 0.5 * size
        elif best is not None:
            break
        step, *_ = np.linalg.lstsq(np.eye(len(point)) - slope, gap, rcond=1e-10)
        point = np.clip(point + step * view.width, view.low, view.low + view.width)
        if size == 0.0:
            break
    return best


def _around(hybrid: Hybrid, point: Array) -> Array:
    """The point, and two displaced ones for each axis, (1 + 2 m, m)."""
    nudges = NUDGE * np.diag(hybrid.view.width)
    return np.concatenate([point[None], point + nudges, point - nudges])


def _derivative(ends: Array, width: Array) -> Array:
    """The derivative (m, m), in widths; one-sided where one side does not return."""
    m = len(width)
    scaled = ends / width
    above, below = scaled[1 : 1 + m] - scaled[0], scaled[0] - scaled[1 + m :]
    both = 0.5 * (above + below)
    one = np.where(np.isfinite(above), above, below)
    return np.asarray(np.where(np.isfinite(both), both, one).T / NUDGE)

"""A closed trajectory of a flow, found exactly from one that nearly closes: multiple shooting.

m: number of axes; K: segments. The unknowns are the starts of K segments and the period; Newton's
method makes each segment end where the next one starts (Seydel 2010, section 7.6).
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from verifier.topology.cycles.floquet import fundamental
from verifier.topology.paths.motion import moved
from verifier.topology.slices import Slice, rates_at

SEGMENTS: Final = 16
"""Enough that what a cycle repels or attracts grows moderately within one."""

ITERATIONS: Final = 12

PATIENCE: Final = 4
"""Steps after which each must at least halve the gaps, or there is nothing to be found."""

TOLERANCE: Final = 1e-12
"""Of the integration, as a share of the widths."""

CLOSED: Final = 1e-10
"""Gaps between segments, as shares of the widths, below which a trajectory is closed."""

ROUGH: Final = (16,)
"""Parts of a segment for the linearisation that Newton's steps are taken by."""

STILL: Final = 1e-6
"""A closed trajectory that is smaller than this share of the widths is a fixed point."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Closed:
    """A closed trajectory: starts (K, m) of segments of equal duration, and its period.

    Where the period is negative, it is followed backwards, starts in that order: what repels
    strongly is known well only so. turns: (m,) how many widths further it ends than it began; 0
    but on periodic axes.
    """

    starts: Array
    period: float
    turns: Array


def segments(view: Slice, start: Array, period: float, count: int = SEGMENTS) -> Closed:
    """The path from `start` for one period, cut into equal segments; it need not be closed."""
    path = moved(view, start[None], np.linspace(0.0, period, count + 1), TOLERANCE)[0]
    gap = np.nan_to_num((path[-1] - path[0]) / view.width)
    turns = np.where(view.periodic, np.round(gap), 0.0)
    return Closed(np.array(path[:-1]), period, turns)


def closed(view: Slice, guess: Closed) -> Closed | None:
    """The closed trajectory near `guess`; None where Newton's method finds none."""
    now, gaps = guess, _gaps(view, guess)
    before = np.inf
    for iteration in range(ITERATIONS):
        size = float(np.abs(gaps).max())
        if not np.isfinite(size) or (iteration > PATIENCE and size > 0.5 * before):
            return None
        if size < CLOSED:
            return _minimal(view, now)
        step = _newton_step(view, now, gaps)
        if step is None:
            return None
        moved_on = _stepped(view, now, step)
        if moved_on is None:
            return None
        before, now, gaps = size, moved_on, _gaps(view, moved_on)
    return None


def _ends(view: Slice, at: Closed) -> Array:
    duration = at.period / len(at.starts)
    return np.asarray(moved(view, at.starts, np.array([0.0, duration]), TOLERANCE)[:, -1])


def _gaps(view: Slice, at: Closed) -> Array:
    """From the start of each next segment to the end of each (K, m), in widths."""
    following = np.concatenate([at.starts[1:], at.starts[:1] + at.turns * view.width])
    return np.asarray((_ends(view, at) - following) / view.width)


def _newton_step(view: Slice, at: Closed, gaps: Array) -> Array | None:
    """Changes of all starts (in widths) and of the period that close the linearised gaps."""
    count, m = at.starts.shape
    duration = at.period / count
    matrices, _ = fundamental(view, at.starts, duration, TOLERANCE, ROUGH)
    scaled = matrices * view.width / view.width[:, None]
    speeds = rates_at(view, _ends(view, at)) / view.width
    system = np.zeros((count * m + 1, count * m + 1))
    for k in range(count):
        rows = slice(k * m, (k + 1) * m)
        follows = (k + 1) % count
        system[rows, rows] += scaled[k]
        system[rows, follows * m : (follows + 1) * m] -= np.eye(m)
        system[rows, -1] = speeds[k] / count
    system[-1, :m] = rates_at(view, at.starts[0]) / view.width
    if not np.all(np.isfinite(system)):
        return None
    # The period counts in units of itself, the phase condition as much as a gap.
    system[:, -1] *= at.period
    system[-1] /= max(float(np.linalg.norm(system[-1])), 1e-300)
    return np.asarray(np.linalg.lstsq(system, -np.append(gaps.ravel(), 0.0), rcond=1e-13)[0])


def _stepped(view: Slice, at: Closed, step: Array) -> Closed | None:
    """The unknowns after a step that is shortened where it would lead far away."""
    shortened = step * min(1.0, 0.2 / max(float(np.abs(step).max()), 1e-300))
    starts = at.starts + shortened[:-1].reshape(at.starts.shape) * view.width
    inside = (starts >= view.low) & (starts <= view.low + view.width)
    if not np.all(inside | np.array(view.periodic)):
        return None
    return Closed(starts, at.period * (1.0 + shortened[-1]), at.turns)


def _minimal(view: Slice, found: Closed) -> Closed | None:
    """The trajectory, gone round once only; None if it is a fixed point."""
    spread = np.ptp(found.starts / view.width, axis=0)
    if float(spread.max()) < STILL and not found.turns.any():
        return None
    for times in (4, 3, 2):
        if found.turns.any() and np.any(found.turns % times):
            continue
        part = segments(view, found.starts[0], found.period / times)
        if np.all(np.abs(_gaps(view, part)[-1]) < 1e3 * CLOSED):
            return part
    return found

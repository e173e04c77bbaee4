"""The return map of a hybrid flow: from a switch to the next one of the same kind.

It starts in the middle of the longest stay in a mode, so that the states around may be started
from, too: right after a switch they would lie on both sides of it. It forgets where along the flow
it was started: beside the multipliers of a cycle, its derivative has the eigenvalue 0.

m: number of axes; n: of states; B: lanes.
"""

from dataclasses import dataclass, replace
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.flow import in_one_mode
from verifier.topology.hybrid.flow import EXACT, Hybrid, followed, on_axes, points_in
from verifier.topology.slices import Slice, shortest, wrapped

Kind: TypeAlias = tuple[int, int]
"""The modes that a switch leaves and enters."""

NUDGE: Final = 1e-5
"""How far starts are displaced, in widths, where the map is differentiated."""
ROUNDS: Final = 16
CLOSED: Final = 1e-9
"""How close, in widths, a cycle's end must come to its beginning."""
BRIEF: Final = 1e-6
"""What stays in no mode for longer than this, in tempos, switches back and forth by rounding."""
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


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Stay:
    """A cycle to be, and half of the time for which it stays in the mode that its switch enters."""

    sought: Return
    half: float


def closed(hybrid: Hybrid, guess: Return) -> Closed | None:
    """The cycle near a guess, by Newton's method; None where there is none."""
    view = hybrid.view
    stay = _longest_stay(hybrid, guess)
    if stay is None:
        return None
    point = wrapped(view, _later(hybrid, stay.sought.point[None], stay)[0])
    best: Closed | None = None
    least = CLOSED
    for _ in range(ROUNDS):
        after, times, counts = _returned(hybrid, _around(hybrid, point), stay)
        ends = _later(hybrid, after, stay)
        gap = shortest(view, ends[0] - point) / view.width
        slope = _derivative(view, ends)
        if not (np.all(np.isfinite(gap)) and np.all(np.isfinite(slope))):
            break
        size = float(np.abs(gap).max())
        if size < least:
            turns = np.round((ends[0] - point) / view.width) * np.array(view.periodic)
            found = replace(
                stay.sought, point=wrapped(view, after[0]), period=float(times[0]) + stay.half
            )
            best, least = Closed(found, int(counts[0]), slope, turns), 0.5 * size
        elif best is not None:
            break
        step, *_ = np.linalg.lstsq(np.eye(len(point)) - slope, gap, rcond=1e-10)
        point = _inside(view, point + step * view.width)
        if size == 0.0:
            break
    return best


def _longest_stay(hybrid: Hybrid, guess: Return) -> _Stay | None:
    """The same cycle, begun with the switch after which it stays longest in one mode.

    None where the guess does not return, or hardly stays anywhere.
    """
    state = points_in(hybrid, guess.point[None], guess.kind[1])
    ran = followed(hybrid, state, np.array([0.0, PATIENCE * guess.period]), EXACT)
    mine = ran.switches.of(0)
    kinds = list(zip(mine.left.tolist(), mine.entered.tolist(), strict=True))
    hits = [i for i, kind in enumerate(kinds) if kind == guess.kind]
    if len(hits) < guess.count:
        return None
    last = hits[guess.count - 1]
    # The stay after the switch that closes the round is the one that it begins with.
    stays = np.append(np.diff(mine.times[: last + 1]), mine.times[0])
    i = int(np.argmax(stays))
    if not stays[i] > BRIEF * hybrid.tempo:
        return None
    if i == last:
        return _Stay(guess, 0.5 * float(stays[i]))
    count = kinds[: last + 1].count(kinds[i])
    point = on_axes(hybrid, mine.after[i])
    return _Stay(Return(point, kinds[i], count, guess.period), 0.5 * float(stays[i]))


def _later(hybrid: Hybrid, points: Array, stay: _Stay) -> Array:
    """Where points (B, m) right after the switch are in the middle of the stay, in its mode."""
    states = points_in(hybrid, points, stay.sought.kind[1])
    clock = np.array([0.0, stay.half])
    ran = followed(hybrid, states, clock, EXACT, in_one_mode(hybrid.flow))
    gone = on_axes(hybrid, ran.states[:, -1]) - on_axes(hybrid, states)
    return np.asarray(points + gone)


def _returned(hybrid: Hybrid, points: Array, stay: _Stay) -> tuple[Array, Array, Integers]:
    """The points (B, m) after the switch to which points amid the stay return; NaN if never.

    Beside them when (B,), and after how many switches.
    """
    sought = stay.sought
    states = points_in(hybrid, points, sought.kind[1])
    ran = followed(hybrid, states, np.array([0.0, PATIENCE * sought.period]), EXACT)
    ends = np.full(points.shape, np.nan)
    times = np.full(len(points), np.nan)
    counts = np.zeros(len(points), dtype=np.int64)
    # Points are started from within the domain.
    shift = points - on_axes(hybrid, states)
    for b in range(len(points)):
        mine = ran.switches.of(b)
        hits = np.flatnonzero((mine.left == sought.kind[0]) & (mine.entered == sought.kind[1]))
        if len(hits) >= sought.count:
            hit = hits[sought.count - 1]
            ends[b], times[b] = on_axes(hybrid, mine.after[hit]) + shift[b], mine.times[hit]
            counts[b] = hit + 1
    return ends, times, counts


def _inside(view: Slice, points: Array) -> Array:
    return wrapped(
        view,
        np.where(view.periodic, points, np.clip(points, view.low, view.low + view.width)),
    )


def _around(hybrid: Hybrid, point: Array) -> Array:
    """The point, and two displaced ones for each axis, (1 + 2 m, m)."""
    nudges = NUDGE * np.diag(hybrid.view.width)
    return np.concatenate([point[None], point + nudges, point - nudges])


def _derivative(view: Slice, ends: Array) -> Array:
    """The derivative (m, m), in widths; one-sided where one side does not return."""
    m = len(view.axes)
    off = shortest(view, ends - ends[0]) / view.width
    above, below = off[1 : 1 + m], -off[1 + m :]
    both = 0.5 * (above + below)
    one = np.where(np.isfinite(above), above, below)
    return np.asarray(np.where(np.isfinite(both), both, one).T / NUDGE)

"""Separatrices: the one-dimensional stable and unstable manifolds of saddles, and where they go.

m: number of axes. Lengths are shares of the axes' widths. "Ahead" is along the unstable manifold
forward in time, and along the stable one backward.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, frozen
from runtime.integrators import adaptive
from runtime.rollout import Ending
from verifier.topology.ends.capture import Trap, traps_of, tubes_of
from verifier.topology.ends.tubes import Tube, gaps_to
from verifier.topology.features import Cycle, FixedPoint, Reaches, Separatrix
from verifier.topology.manifolds.local import Branch, branches_of, growths, is_saddle
from verifier.topology.manifolds.of_maps import map_separatrices
from verifier.topology.slices import Slice, shortest, states_at

TOLERANCE: Final = 1e-10
"""The local error of a step, as a share of the widths and relative to the state."""

STRIDE: Final = 0.01
"""About how far apart the points of a separatrix are."""

SAMPLES: Final = 120
"""Times per stretch at which a branch is looked at first."""

STRETCH: Final = 1.0
"""The length that is followed at once."""

LONGEST: Final = 40.0
"""The length at which a branch that came to no end is given up."""

ROUNDS: Final = 80
"""As many stretches at most."""

MOST_STEPS: Final = 20_000
"""A stretch that needs more steps chatters along a jump of the field."""

ARRIVED: Final = 2e-3
"""Once in the trap of a fixed point a branch is followed until it is this close to it, or"""

SHOWN: Final = 3.0
"""until it has gone this far round it."""

CONNECTED: Final = 1e-6
"""A branch that passes a saddle's own manifold by less than this goes into the saddle."""

LINEAR: Final = 0.05
"""The radius round a saddle within which passing by is judged by the linearisation."""

STILL: Final = 1e-9
"""A stretch that is shorter stands still."""

CLOSE: Final = 0.02
"""A branch that stands still converges to a point that is this close."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Target:
    """A saddle as a possible end: `exponent` (λs + λu) / λs of passing by, ahead in time."""

    index: int
    at: Array
    exponent: float


@final
@dataclass(frozen=True, eq=False, slots=True)
class Ends:
    """What a branch may come to when it is followed in the direction `sign` of time."""

    sign: int
    traps: tuple[Trap, ...]
    tubes: tuple[Tube, ...]
    targets: tuple[Target, ...]
    others: tuple[tuple[int, Array], ...]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Stretch:
    """A piece of a branch: times (T,) from 0, points (T, m), and how it ended."""

    times: Array
    points: Array
    ending: Ending

    def until(self, last: int) -> "Stretch":
        """Only up to the point `last`."""
        return Stretch(self.times[: last + 1], self.points[: last + 1], self.ending)


@final
@dataclass(frozen=True, slots=True)
class End:
    """What a branch reaches, which of them, and the point of the stretch at which it does."""

    reaches: Reaches
    to: int
    last: int


def find_separatrices(
    view: Slice, fixed_points: Sequence[FixedPoint], cycles: Sequence[Cycle]
) -> tuple[Separatrix, ...]:
    """Both sides of each one-dimensional manifold of each saddle, in the direction of time.

    In a plane these are all separatrices; with more axes those manifolds that are curves. Points
    on a periodic axis are unwrapped: values may leave the domain by whole periods. A branch into a
    fixed point ends within its trap (see `capture`), one on a cycle close to it; one into a saddle
    misses its manifold by less than `CONNECTED`, which no numbers can tell from a connection.
    """
    branches = branches_of(view, fixed_points)
    if not branches:
        return ()
    if view.is_map:
        return map_separatrices(view, fixed_points, cycles, branches)
    ends = {sign: _ends(view, fixed_points, cycles, sign) for sign in (1, -1)}
    return tuple(_followed(view, ends[-1 if b.stable else 1], b) for b in branches)


def _ends(
    view: Slice, fixed_points: Sequence[FixedPoint], cycles: Sequence[Cycle], sign: int
) -> Ends:
    traps = traps_of(view, fixed_points, cycles, sign)
    saddles = {i for i, p in enumerate(fixed_points) if is_saddle(view, p)}
    known = saddles | {trap.index for trap in traps}
    return Ends(
        sign,
        traps,
        tubes_of(view, fixed_points, cycles, sign),
        tuple(_target(view, i, fixed_points[i], sign) for i in sorted(saddles)),
        tuple((i, p.at) for i, p in enumerate(fixed_points) if i not in known),
    )


def _target(view: Slice, index: int, point: FixedPoint, sign: int) -> Target:
    growth = sign * growths(view, point)
    slowest, fastest = float(-growth[growth < 0.0].max()), float(growth.max())
    return Target(index, point.at, (slowest + fastest) / slowest)


def _followed(view: Slice, ends: Ends, branch: Branch) -> Separatrix:
    """One branch, stretch after stretch, until it comes to an end."""
    pieces: list[Stretch] = []
    at, length, away, end = branch.at, 0.0, False, None
    duration = -np.log(branch.distance) / abs(branch.eigenvalue)
    while end is None and len(pieces) < ROUNDS and length < LONGEST:
        piece = _stretch(view, at, ends.sign * duration)
        far = _has_left(view, piece.points, ends, branch.saddle, away=away)
        end = _first_end(view, ends, branch, piece, far)
        piece = piece if end is None else piece.until(end.last)
        pieces.append(piece)
        gone = _length(view, piece.points)
        if piece.ending is not Ending.COMPLETED or gone < STILL:
            break
        at, away, length = piece.points[-1], bool(far[-1]), length + gone
        duration *= _longer(gone)
    if end is None:
        end = _converged(view, ends, pieces[-1].points[-1])
    place = next((trap.at for trap in ends.traps if trap.index == end.to), None)
    if end.reaches is Reaches.POINT and place is not None:
        pieces += _run_in(view, pieces[-1].points[-1], place, ends.sign * duration)
    return _separatrix(branch, end, pieces)


def _longer(gone: float) -> float:
    """By what the next stretch takes more time than one of length `gone`."""
    return float(np.clip(STRETCH / gone, 0.25, 4.0))


def _stretch(view: Slice, start: Array, duration: float) -> Stretch:
    """The path from `start` (m,), looked at as often as its speed asks."""
    coarse = _moved(view, start, np.linspace(0.0, duration, SAMPLES))
    steps = np.linalg.norm(np.diff(coarse.points, axis=0) / view.width, axis=-1)
    parts = np.maximum(np.ceil(steps / STRIDE), 1.0).astype(np.int64)
    if parts.max(initial=1) == 1:
        return coarse
    pieces = [
        np.linspace(a, b, n, endpoint=False)
        for a, b, n in zip(coarse.times[:-1], coarse.times[1:], parts, strict=True)
    ]
    fine = _moved(view, start, np.concatenate([*pieces, coarse.times[-1:]]))
    return Stretch(fine.times, fine.points, coarse.ending)


def _moved(view: Slice, start: Array, times: Array) -> Stretch:
    """The path at `times`, continuous on periodic axes, up to where it leaves the domain."""
    x = states_at(view, start[None])
    atol = np.full(x.shape[-1], TOLERANCE)
    atol[list(view.columns)] *= view.width
    found = adaptive(view.flow, x, view.u, times, TOLERANCE, atol, MOST_STEPS)
    states = found.states[0][..., view.columns]
    known = np.all(np.isfinite(states), axis=-1)
    count = len(known) if known.all() else int(np.argmin(known))
    ending = found.ending(0)
    states, times = states[:count], times[:count]
    if ending is Ending.LEFT_DOMAIN and abs(found.ended_at[0]) > abs(times[-1]):
        states = np.concatenate([states, found.ended_in[:1, view.columns]])
        times = np.append(times, found.ended_at[0])
    travelled = np.cumsum(shortest(view, np.diff(states, axis=0)), axis=0)
    return Stretch(times, np.concatenate([start[None], start + travelled]), ending)


def _has_left(view: Slice, points: Array, ends: Ends, saddle: int, *, away: bool) -> Booleans:
    """From which of `points` on the branch has been far from its own saddle."""
    own = next(target.at for target in ends.targets if target.index == saddle)
    gaps = np.linalg.norm(shortest(view, points - own) / view.width, axis=-1)
    return np.asarray(np.logical_or.accumulate(gaps > LINEAR) | away)


def _first_end(
    view: Slice, ends: Ends, branch: Branch, piece: Stretch, far: Booleans
) -> End | None:
    """What the branch comes to first within this stretch, None where nothing."""
    found: list[End] = []
    for trap in ends.traps:
        found += _at_first(trap.holds(view, piece.points), Reaches.POINT, trap.index)
    for tube in ends.tubes:
        found += _at_first(
            gaps_to(view, tube, piece.points) <= tube.reach, Reaches.CYCLE, tube.index
        )
    for target in ends.targets:
        own = target.index == branch.saddle
        reached = _passes(view, target, piece.points)
        if reached is not None and (not own or far[reached]):
            kind = Reaches.ITSELF if own else Reaches.POINT
            found.append(End(kind, target.index, reached))
    if piece.ending is Ending.LEFT_DOMAIN:
        found.append(End(Reaches.EDGE, -1, len(piece.times) - 1))
    return min(found, key=lambda end: end.last, default=None)


def _at_first(there: Booleans, reaches: Reaches, index: int) -> list[End]:
    return [End(reaches, index, int(np.argmax(there)))] if there.any() else []


def _passes(view: Slice, target: Target, points: Array) -> int | None:
    """The point closest to a saddle, if the branch can't be told from one that goes into it.

    In the linearisation a path that misses the saddle's manifold by δ at the radius ρ comes as
    close as d = ρ (δ / ρ)^(λs / (λs + λu)).
    """
    gaps = np.linalg.norm(shortest(view, points - target.at) / view.width, axis=-1)
    # A branch begins close to its saddle; it is judged by where it comes back.
    gaps = np.where(np.logical_or.accumulate(gaps > LINEAR), gaps, np.inf)
    closest = int(np.argmin(gaps))
    share = gaps[closest] / LINEAR
    missed = LINEAR * share**target.exponent if share < 0.5 else np.inf
    return closest if missed < CONNECTED else None


def _converged(view: Slice, ends: Ends, at: Array) -> End:
    """Where a branch that ended nowhere is about to stand still, if at a fixed point."""
    near = [
        (float(np.linalg.norm(shortest(view, at - place) / view.width)), index)
        for index, place in ends.others
    ]
    gap, index = min(near, default=(1.0, -1))
    return End(Reaches.POINT, index, -1) if gap < CLOSE else End(Reaches.NOWHERE_SEEN, -1, -1)


def _run_in(view: Slice, at: Array, place: Array, duration: float) -> list[Stretch]:
    """The rest of the way, from within a trap to its fixed point at `place`, as far as it shows."""
    pieces: list[Stretch] = []
    length = 0.0
    while len(pieces) < ROUNDS and length < SHOWN:
        piece = _stretch(view, at, duration)
        gaps = np.linalg.norm(shortest(view, piece.points - place) / view.width, axis=-1)
        there = gaps < ARRIVED
        pieces.append(piece.until(int(np.argmax(there))) if there.any() else piece)
        gone = _length(view, piece.points)
        if there.any() or piece.ending is not Ending.COMPLETED or gone < STILL:
            break
        at, length = piece.points[-1], length + gone
        duration *= _longer(gone)
    return pieces


def _length(view: Slice, points: Array) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0) / view.width, axis=-1).sum())


def _separatrix(branch: Branch, end: End, pieces: list[Stretch]) -> Separatrix:
    """The pieces, one after the other, in the direction of time."""
    begun = np.cumsum([0.0, *(piece.times[-1] for piece in pieces[:-1])])
    times = np.concatenate([[0.0], *(t + p.times[1:] for t, p in zip(begun, pieces, strict=True))])
    points = np.concatenate([branch.at[None], *(piece.points[1:] for piece in pieces)])
    order = slice(None, None, -1 if branch.stable else 1)
    return Separatrix(
        branch.saddle,
        branch.stable,
        end.reaches,
        end.to,
        frozen(times[order]),
        frozen(points[order]),
    )

"""The closed trajectories of a slice: limit cycles of flows, periodic orbits of maps.

In the plane they are looked for systematically: a cycle encloses fixed points whose indices add up
to 1 (Strogatz 2015, section 6.8), so it crosses every ray from one that is no saddle. One that
goes round a periodic axis crosses every line across it. Beside that, in any number of axes, the
limits of spread trajectories are tried. m: number of axes.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array, frozen
from verifier.topology.cycles.floquet import inverted, multipliers, stability
from verifier.topology.cycles.limit_sets import recurrences
from verifier.topology.cycles.map_cycles import find_map_cycles
from verifier.topology.cycles.return_maps import Candidate, scan
from verifier.topology.cycles.sections import Section
from verifier.topology.cycles.shooting import CLOSED, SEGMENTS, TOLERANCE, Closed, closed, segments
from verifier.topology.features import Cycle, FixedPoint, PointKind, Stability
from verifier.topology.paths.motion import moved, pace
from verifier.topology.slices import Slice, shortest, wrapped

DIRECTIONS: Final = (0.35, 2.44, 4.53)
"""Angles of the rays from a fixed point; none is along an axis, where a field is often special."""

MOST_RAYS: Final = 24
"""With more fixed points fewer rays leave each, but at least one."""

SAME: Final = 2e-3
"""A candidate this close to a known cycle, in widths and relative period, is that one."""

IDENTICAL: Final = 1e-4
"""Exact cycles this close, in widths, are one if they have one period and one stability."""

PERIODS: Final = 1e-7
"""Relative differences of the periods of one cycle that was found twice."""

NEUTRAL: Final = 1e-6
"""How far the logarithm of a multiplier may be off where the field is exact."""

SURE: Final = 100.0
"""How many times larger than what its gap leaves open a cycle must be."""

FINE: Final = 256
"""Parts of a segment at which a cycle is looked at before it is thinned."""

STRIDE: Final = 0.005
"""About how far apart, in widths, the points of a cycle are."""

LEAST_POINTS: Final = 64
"""The points of a cycle are never further apart than such a part of its period."""

ACROSS: Final = 0.137
"""Where on a periodic axis, as a share of it, the line across it is: nowhere special."""

CONTINUUM: Final = (
    "every trajectory closes in a part of the slice, as around a center: "
    "these are not listed as cycles"
)
SADDLES_UNSEEN: Final = (
    "not all cycles that attract in some directions and repel in others may be found"
)


def find_cycles(
    view: Slice, fixed_points: tuple[FixedPoint, ...], rays: int = len(DIRECTIONS)
) -> tuple[tuple[Cycle, ...], tuple[str, ...]]:
    """The cycles, the shortest period first, and notes on what they do not tell.

    rays: so many leave each fixed point at most. A cycle crosses each, so one would do; the others
    are for cycles that cross the first one where it is nearly along the field.
    """
    if view.is_map:
        return find_map_cycles(view)
    tempo = pace(view)
    if not np.isfinite(tempo):
        return (), ()
    candidates: list[Candidate] = []
    notes: list[str] = []
    if len(view.axes) == 2:
        sections, lengths = _sections(view, fixed_points, rays)
        for step in (tempo, -tempo) if sections else ():
            seen = scan(view, sections, lengths, step)
            candidates += seen.candidates
            notes += [CONTINUUM] if seen.continuum else []
    found = _refined(view, candidates, [])
    if not notes:
        for start, period in recurrences(view, fixed_points, tempo):
            found = _refined(
                view, [Candidate(start, period, -1, period < 0.0, touching=False)], found
            )
    if len(view.axes) > 2:
        notes.append(SADDLES_UNSEEN)
    lasting = [cycle for cycle in found if cycle.stability is not Stability.NEUTRAL]
    if len(lasting) < len(found) and not notes:
        notes.append(CONTINUUM)
    return tuple(sorted(lasting, key=_order)), tuple(dict.fromkeys(notes))


def _order(cycle: Cycle) -> tuple[float, float]:
    return (round(cycle.period, 9), float(np.ptp(cycle.points, axis=0).max()))


def _sections(
    view: Slice, fixed_points: tuple[FixedPoint, ...], rays: int
) -> tuple[tuple[Section, ...], tuple[float, ...]]:
    """Rays from all fixed points but saddles, lines across periodic axes; their lengths."""
    centres = [point.at for point in fixed_points if point.kind is not PointKind.SADDLE]
    count = max(1, min(rays, MOST_RAYS // max(1, len(centres))))
    sections: list[Section] = []
    lengths: list[float] = []
    for at in centres:
        for angle in DIRECTIONS[:count]:
            along = np.array([np.cos(angle), np.sin(angle)])
            sections.append(Section(at, along, -1))
            lengths.append(_room(view, at, along))
    for axis in np.flatnonzero(view.periodic):
        origin = view.low.copy()
        origin[axis] += ACROSS * view.width[axis]
        sections.append(Section(origin, np.eye(2)[1 - axis], int(axis)))
        lengths.append(1.0)
    return tuple(sections), tuple(lengths)


def _room(view: Slice, at: Array, along: Array) -> float:
    """How far a ray goes, in widths, before it leaves the domain, or went once round it."""
    edge = np.where(along > 0.0, view.low + view.width - at, at - view.low) / view.width
    room = np.where(view.periodic, 1.0, edge) / np.abs(along)
    return float(room.min())


def _refined(view: Slice, candidates: list[Candidate], known: list[Cycle]) -> list[Cycle]:
    """`known` cycles and those that candidates lead to, each once."""
    found = list(known)
    claimed: set[tuple[int, int, bool]] = set()
    for candidate in candidates:
        twin = _twin(view, found, candidate.start, abs(candidate.period), SAME)
        key = (candidate.section, twin, candidate.backwards)
        # Two candidates of one section near one cycle are two cycles near one another.
        if twin >= 0 and (candidate.section < 0 or key not in claimed):
            claimed.add(key)
            continue
        cycle = _exact(view, candidate)
        if cycle is None:
            continue
        if not _is_known(view, found, cycle):
            found.append(cycle)
            claimed.add((candidate.section, len(found) - 1, candidate.backwards))
    return found


def _twin(view: Slice, cycles: list[Cycle], point: Array, period: float, near: float) -> int:
    """Which of `cycles` goes through `point` with this period; -1 for none."""
    for i, cycle in enumerate(cycles):
        if abs(cycle.period - period) > near * period:
            continue
        if _distance(view, cycle.points, point) < near:
            return i
    return -1


def _is_known(view: Slice, cycles: list[Cycle], new: Cycle) -> bool:
    return any(
        abs(cycle.period - new.period) < PERIODS * new.period
        and cycle.stability is new.stability
        and _distance(view, cycle.points, new.points[0]) < IDENTICAL
        for cycle in cycles
    )


def _distance(view: Slice, line: Array, point: Array) -> float:
    """From a point (m,) to a polyline (T, m), in widths."""
    a = shortest(view, line[:-1] - point) / view.width
    step = np.diff(line, axis=0) / view.width
    size = np.maximum(np.sum(step * step, axis=-1), 1e-300)
    part = np.clip(-np.sum(a * step, axis=-1) / size, 0.0, 1.0)
    return float(np.linalg.norm(a + part[:, None] * step, axis=-1).min())


def _exact(view: Slice, candidate: Candidate) -> Cycle | None:
    guess = segments(view, wrapped(view, candidate.start), candidate.period)
    if not np.all(np.isfinite(guess.starts)):
        return None
    if candidate.touching:
        return _cycle(view, guess, touching=True)
    found = closed(view, guess)
    return None if found is None else _cycle(view, found, touching=False)


def _cycle(view: Slice, found: Closed, *, touching: bool) -> Cycle | None:
    """The cycle with its multipliers and points; None where it leaves the domain."""
    duration = found.period / SEGMENTS
    values, second, doubtful = multipliers(view, found.starts, duration, TOLERANCE)
    times, points = _drawn(view, found)
    if not np.all(np.isfinite(points)) or not np.all(np.isfinite([*values, *second])):
        return None
    if not (touching or found.turns.any()) and _is_point(view, points, values):
        return None
    turns, period = found.turns, float(abs(found.period))
    if found.period < 0.0:
        values, second, turns = inverted(values), inverted(second), -turns
        times, points = (times - times[-1])[::-1], _within(view, points[::-1])
    error = float(np.max(view.accuracy / view.width)) * period
    judged = stability(second if doubtful else values, NEUTRAL + error)
    return Cycle(
        times=frozen(times),
        points=frozen(points),
        period=period,
        stability=Stability.SEMI_STABLE if touching else judged,
        multipliers=values,
        cross_checked=second,
        doubtful=doubtful,
        turns=tuple(int(turn) for turn in turns),
        modes=(),
    )


def _is_point(view: Slice, points: Array, values: tuple[complex, ...]) -> bool:
    """Whether a closed path is not known to be away from a fixed point that it goes round.

    Round a focus that hardly attracts every small path closes as far as numbers tell: a gap of
    `CLOSED` leaves a cycle open by that gap divided by |1 - multiplier|.
    """
    slowest = min(abs(1.0 - value) for value in values)
    size = float(np.ptp(points / view.width, axis=0).max())
    return size * slowest < SURE * CLOSED


def _within(view: Slice, points: Array) -> Array:
    """A path (T, m), moved by whole turns so that it begins within the domain."""
    return np.asarray(points + (wrapped(view, points[0]) - points[0]))


def _drawn(view: Slice, found: Closed) -> tuple[Array, Array]:
    """Times (T,) and points (T, m) over one period, evenly spread along the cycle and in time.

    In the order in which it was found: times fall where it was followed backwards.
    """
    duration = found.period / SEGMENTS
    clock = np.linspace(0.0, duration, FINE + 1)
    paths = moved(view, found.starts, clock, TOLERANCE)[:, :-1].reshape(-1, len(view.axes))
    times = (np.arange(SEGMENTS)[:, None] * duration + clock[:-1]).ravel()
    paths = _within(view, paths)
    points = np.concatenate([paths, paths[:1] + found.turns * view.width])
    times = np.append(times, found.period)
    steps = np.linalg.norm(np.diff(points, axis=0) / view.width, axis=-1) / STRIDE
    progress = np.cumsum(np.append(0.0, steps + LEAST_POINTS / (SEGMENTS * FINE)))
    kept = np.flatnonzero(np.diff(np.floor(progress), prepend=-1.0))
    kept = np.union1d(kept, [len(times) - 1])
    return times[kept], points[kept]

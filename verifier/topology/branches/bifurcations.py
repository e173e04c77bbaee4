"""What happens between two portraits of one behavior on both sides of a bifurcation.

Both are so close to it that what persists has hardly moved: features are matched to the nearest of
the other side, and those without a partner, or with another stability, tell what happened
(Strogatz 2015, chapters 3 and 8; of maps 10).
"""

from dataclasses import dataclass
from itertools import product
from typing import Final, final

import numpy as np

from runtime.arrays import Array, frozen
from spec_schema.wording import with_article
from verifier.topology.branches.continuation import Change
from verifier.topology.features import AxisRange, Cycle, FixedPoint, PointKind, Portrait, Stability
from verifier.topology.words import described_cycle

NEAR_EDGE: Final = 0.01
"""A point this close to the domain's edge, in widths, left through it."""

MOST_AHEAD: Final = 0.15
"""A point moves no further along its tangent than this, in widths: folds have steep ones."""

TOGETHER: Final = 0.2
"""Features that meet are this close on either side, in widths."""

DOUBLE: Final = 0.02
"""How far periods may be off where one is twice the other, relatively: they change on the way."""

NOT_HYPERBOLIC: Final = frozenset({PointKind.DEGENERATE, PointKind.CENTER})


@final
@dataclass(frozen=True, eq=False, slots=True)
class Difference:
    """What happened, near `at` (m,), in words. `is_none`: the portraits have the same features."""

    change: Change
    at: Array
    about: str
    is_none: bool = False


Signature = tuple[tuple[int, ...], tuple[str, ...]]


def signature(portrait: Portrait) -> Signature:
    """What no bifurcation leaves as it is: directions that grow, and the cycles' stabilities."""
    growing = sorted(growing_directions(point, portrait) for point in portrait.fixed_points)
    return tuple(growing), tuple(sorted(str(cycle.stability) for cycle in portrait.cycles))


def growing_directions(point: FixedPoint, portrait: Portrait) -> int:
    """In how many directions what is near a point leaves it; -1 where that is not decided."""
    if point.kind in NOT_HYPERBOLIC:
        return -1
    if portrait.every > 0.0:
        return sum(abs(value) > 1.0 for value in point.eigenvalues)
    return sum(value.real > 0.0 for value in point.eigenvalues)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Steps:
    """How far the points of two portraits move between them, along their tangents: (k, m) each."""

    old: Array
    new: Array


def difference(below: Portrait, above: Portrait, steps: Steps | None = None) -> Difference:
    """What happens between the two, from the lower to the higher value of the control."""
    points = _of_points(below, above, steps)
    if points is not None:
        return points
    cycles = _of_cycles(below, above)
    if cycles is not None:
        return cycles
    centre = frozen([axis.low + axis.width / 2 for axis in below.axes])
    return Difference(Change.OTHER, centre, "no feature comes, goes or changes", is_none=True)


def exchanged(below: Portrait, above: Portrait, steps: Steps) -> bool:
    """Whether points change their stability, although none comes or goes."""
    pairs, gone, new = matched(below.axes, below.fixed_points, above.fixed_points, steps)
    return not gone and not new and len(_changed(below, above, pairs)) > 0


def _changed(
    below: Portrait, above: Portrait, pairs: list[tuple[int, int]]
) -> list[tuple[FixedPoint, FixedPoint]]:
    """The pairs of points of which another number of directions grows."""
    return [
        (below.fixed_points[i], above.fixed_points[j])
        for i, j in pairs
        if growing_directions(below.fixed_points[i], below)
        != growing_directions(above.fixed_points[j], above)
    ]


def _of_points(below: Portrait, above: Portrait, steps: Steps | None) -> Difference | None:
    pairs, gone, new = matched(below.axes, below.fixed_points, above.fixed_points, steps)
    changed = _changed(below, above, pairs)
    extra = [below.fixed_points[i] for i in gone] + [above.fixed_points[j] for j in new]
    if len(extra) == 2 and len(gone) in {0, 2}:
        return _pair(below.axes, extra, changed, comes=not gone)
    if len(extra) == 1 and _edge_distance(below.axes, extra[0].at) < NEAR_EDGE:
        verb = "leaves" if gone else "enters"
        return Difference(
            Change.LEAVES, extra[0].at, f"{_a(extra[0])} {verb} through the domain's edge"
        )
    if extra:
        return Difference(Change.OTHER, extra[0].at, f"{_a(extra[0])} comes or goes")
    if len(changed) == 2 and _distance(below.axes, changed[0][0].at, changed[1][0].at) < TOGETHER:
        about = "two fixed points meet and exchange their stability"
        return Difference(Change.TRANSCRITICAL, changed[0][0].at, about)
    return _turned(below, changed[0][0], changed[0][1]) if changed else None


def _pair(
    axes: tuple[AxisRange, ...],
    extra: list[FixedPoint],
    changed: list[tuple[FixedPoint, FixedPoint]],
    *,
    comes: bool,
) -> Difference:
    """Two points on one side only."""
    middle = frozen((extra[0].at + extra[1].at) / 2)
    verb = "are born" if comes else "meet and vanish"
    for before, after in changed:
        if _distance(axes, before.at, middle) < TOGETHER:
            kept = after if comes else before
            about = f"two fixed points {verb} beside {_a(kept)}, which changes its stability"
            return Difference(Change.PITCHFORK, before.at, about)
    about = f"{_a(extra[0])} and {_a(extra[1])} {verb}"
    return Difference(Change.SADDLE_NODE, middle, about)


def _turned(below: Portrait, before: FixedPoint, after: FixedPoint) -> Difference:
    """One point, of another stability on the other side."""
    about = f"{_a(before)} becomes {_a(after)}"
    turning = [v for v in (*before.eigenvalues, *after.eigenvalues) if abs(v.imag) > 0.0]
    if turning:
        return Difference(Change.HOPF, after.at, about)
    if below.every > 0.0 and min((v.real for v in after.eigenvalues), default=0.0) < -0.9:
        return Difference(Change.PERIOD_DOUBLING, after.at, about)
    return Difference(Change.OTHER, after.at, about)


def _of_cycles(below: Portrait, above: Portrait) -> Difference | None:
    old, new = below.cycles, above.cycles
    if len(old) != len(new):
        more, axes = (new, above.axes) if len(new) > len(old) else (old, below.axes)
        verb = "are born" if more is new else "meet and vanish"
        if abs(len(old) - len(new)) == 2:
            at = frozen(more[0].points[0])
            return Difference(Change.CYCLES_MEET, at, f"two cycles {verb}")
        fewer = old if more is new else new
        periods = {round(c.period, 9) for c in fewer}
        lone = max(more, key=lambda c: min((abs(c.period - p) for p in periods), default=1.0))
        kept = [c for c in more if c is not lone]
        if lone.stability is Stability.SEMI_STABLE:
            at = frozen(lone.points[0])
            return Difference(Change.CYCLES_MEET, at, f"a stable and an unstable cycle {verb}")
        about = f"{with_article(described_cycle(axes, lone))} {'begins' if more is new else 'ends'}"
        if _is_doubled(lone, kept, fewer):
            about = f"{about}, of twice the period of one beside it"
            return Difference(Change.PERIOD_DOUBLING, frozen(lone.points[0]), about)
        return Difference(Change.CYCLE_ENDS, frozen(lone.points[0]), about)
    for before, after in zip(old, new, strict=True):
        if before.stability is not after.stability:
            about = f"{_article(before.stability)} cycle becomes {after.stability}"
            return Difference(Change.OTHER, frozen(after.points[0]), about)
    return None


def _is_doubled(lone: Cycle, kept: list[Cycle], before: tuple[Cycle, ...]) -> bool:
    """Whether a cycle turns twice where another one, that changes its stability, turns once."""
    return any(
        abs(lone.period - 2.0 * after.period) < DOUBLE * lone.period
        and abs(after.period - then.period) < DOUBLE * after.period
        and after.stability is not then.stability
        for after in kept
        for then in before
    )


def matched(
    axes: tuple[AxisRange, ...],
    old: tuple[FixedPoint, ...],
    new: tuple[FixedPoint, ...],
    steps: Steps | None = None,
) -> tuple[list[tuple[int, int]], list[int], list[int]]:
    """Pairs of nearest points, the closest first; then the rest of either side.

    With `steps` nearest to where the tangents of both lead: branches that cross are told apart.
    """
    ahead = _limited(axes, steps or Steps(np.zeros((len(old), 1)), np.zeros((len(new), 1))))
    distances = sorted(
        (
            max(
                _distance(axes, a.at + ahead.old[i], b.at),
                _distance(axes, a.at, b.at - ahead.new[j]),
            ),
            i,
            j,
        )
        for (i, a), (j, b) in product(enumerate(old), enumerate(new))
    )
    pairs: list[tuple[int, int]] = []
    for distance, i, j in distances:
        free = all(i != k and j != n for k, n in pairs)
        if free and distance < TOGETHER:
            pairs.append((i, j))
    gone = [i for i in range(len(old)) if all(i != k for k, _ in pairs)]
    come = [j for j in range(len(new)) if all(j != n for _, n in pairs)]
    return pairs, gone, come


def _limited(axes: tuple[AxisRange, ...], steps: Steps) -> Steps:
    """The steps, shortened to `MOST_AHEAD`; none where there is no tangent."""
    width = np.array([axis.width for axis in axes])

    def short(step: Array) -> Array:
        with np.errstate(all="ignore"):
            size = np.max(np.abs(step) / width, axis=-1, keepdims=True, initial=0.0)
            shorter = step * np.minimum(1.0, MOST_AHEAD / size)
        return np.where(np.isfinite(size) & (size > 0.0), shorter, 0.0)

    return Steps(short(steps.old), short(steps.new))


def _distance(axes: tuple[AxisRange, ...], a: Array, b: Array) -> float:
    """The largest difference in widths, the short way round."""
    off = [
        abs(axis.shortest(d)) / axis.width for axis, d in zip(axes, (a - b).tolist(), strict=True)
    ]
    return float(max(off))


def _edge_distance(axes: tuple[AxisRange, ...], at: Array) -> float:
    """How far the nearest edge is, in widths."""
    gaps = [
        min(value - axis.low, axis.high - value) / axis.width
        for axis, value in zip(axes, at.tolist(), strict=True)
        if not axis.periodic
    ]
    return min(gaps, default=np.inf)


def _a(point: FixedPoint) -> str:
    return _article(str(point.kind))


def _article(words: str) -> str:
    return f"{'an' if words[0] in 'aeiou' else 'a'} {words}"

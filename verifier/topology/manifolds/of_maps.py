"""Separatrices of maps: a piece of the manifold near the saddle, carried along step by step.

m: number of axes. s: how far along the manifold, as a share of the widths; the piece from s to
μ s, where μ is what a saddle's branch grows by, covers the manifold once as it is carried along
(Hobson 1993). A branch whose eigenvalue is negative changes sides with each step: two steps are
one then. Stable manifolds are carried backward by Newton's method, as far as it finds the place
that a step came from.
"""

from collections.abc import Callable, Sequence
from typing import Final, TypeAlias

import numpy as np

from runtime.arrays import Array, frozen
from verifier.topology.ends.capture import Trap, traps_of, tubes_of
from verifier.topology.ends.tubes import Tube, gaps_to
from verifier.topology.features import Cycle, FixedPoint, Reaches, Separatrix
from verifier.topology.manifolds.local import Branch
from verifier.topology.slices import Slice, jacobians_at, rates_at, shortest

STRIDE: Final = 0.01
"""About how far apart the points of a separatrix are, as a share of the widths."""

LONGEST: Final = 8.0
"""The length at which a branch is given up: those of a chaotic map have no end."""

LEVELS: Final = 40
"""How often the piece is carried along at most; branches into a point need no more."""

MOST_POINTS: Final = 1500
"""Of one image of the piece."""

FINEST: Final = 1e-9
"""Neighbours on the piece that are closer are not divided: the map tears there, or ends."""

NEWTON: Final = 16
"""Newton steps; after so many that do not settle there is no place that the step came from."""

SETTLED: Final = 1e-11
"""A residual, as a share of the widths, that counts as solved."""

BORDER: Final = 1e-4
"""How exactly, as a share of the piece, it is found where the domain is left."""

Step: TypeAlias = Callable[[Array], Array]
"""Where points (k, m) go in one step along the branch, NaN where they leave the domain."""


def map_separatrices(
    view: Slice,
    fixed_points: Sequence[FixedPoint],
    cycles: Sequence[Cycle],
    branches: Sequence[Branch],
) -> tuple[Separatrix, ...]:
    """Each branch up to where it first leaves the domain, a fixed point, a cycle, or `LONGEST`.

    The times are those of a point that passes from the beginning to the end of the branch.
    Branches into other saddles, as integrable maps have them, are not told apart.
    """
    found = []
    for branch in branches:
        sign = -1 if branch.stable else 1
        traps = traps_of(view, fixed_points, cycles, sign)
        tubes = tubes_of(view, fixed_points, cycles, sign)
        at = fixed_points[branch.saddle].at
        found.append(_followed(view, branch, at, traps, tubes))
    return tuple(found)


def _followed(
    view: Slice, branch: Branch, at: Array, traps: Sequence[Trap], tubes: Sequence[Tube]
) -> Separatrix:
    count = 1 if branch.eigenvalue > 0.0 else 2
    growth = abs(branch.eigenvalue) ** (-count if branch.stable else count)
    step = _backward(view) if branch.stable else _forward(view)

    def carried(points: Array, times: int) -> Array:
        for _ in range(count * times):
            points = step(points)
        return points

    def image_of(share: Array, level: int) -> Array:
        s = branch.distance / growth * growth**share
        return carried(branch.point(s, at, view.width), level)

    times, points = [np.zeros(0)], [np.empty((0, len(at)))]
    reaches, to, length = Reaches.NOWHERE_SEEN, -1, 0.0
    share = np.linspace(0.0, 1.0, 9)
    image = image_of(share, 0)
    for level in range(LEVELS):
        share, image = _refined(view, share, image, image_of, level)
        known = np.all(np.isfinite(image), axis=-1)
        inside = len(known) if known.all() else int(np.argmin(known))
        # The last one is the first of the next image.
        shown = slice(inside if inside < len(known) else -1)
        times.append(level + share[shown])
        points.append(image[shown])
        length += float(_gaps(view, image[:inside]).sum())
        end = _end(view, image[:inside], traps, tubes)
        if inside < len(known):
            near = inside > 0 and _at_border(view, image[inside - 1])
            reaches = Reaches.EDGE if near else Reaches.NOWHERE_SEEN
            break
        if end is not None:
            reaches, to = end
            break
        if length > LONGEST or len(share) >= MOST_POINTS:
            break
        image = carried(image, 1)
    return _separatrix(
        view, branch, (reaches, to), count * np.concatenate(times), np.concatenate(points)
    )


def _refined(
    view: Slice,
    share: Array,
    image: Array,
    image_of: Callable[[Array, int], Array],
    level: int,
) -> tuple[Array, Array]:
    """More points between those of the image that are too far apart: shares (k,), points (k, m)."""
    while len(share) < MOST_POINTS:
        known = np.all(np.isfinite(image), axis=-1)
        # The first gap to what is not known is the border; nothing beyond it is looked at.
        last = len(known) - 1 if known.all() else max(int(np.argmin(known)), 1)
        gaps = _gaps(view, image[: last + 1])
        finest = np.where(np.isfinite(gaps), FINEST, BORDER)
        where = np.flatnonzero(~(gaps <= STRIDE) & (np.diff(share[: last + 1]) > finest))
        if not where.size:
            break
        parts = np.clip(np.nan_to_num(gaps[where] / STRIDE, nan=8.0), 2.0, 32.0).astype(np.int64)
        fresh = np.concatenate(
            [
                np.linspace(share[i], share[i + 1], n + 1)[1:-1]
                for i, n in zip(where, parts, strict=True)
            ]
        )
        before = np.repeat(where + 1, parts - 1)
        image = np.insert(image[: last + 1], before, image_of(fresh, level), axis=0)
        share = np.insert(share[: last + 1], before, fresh)
    return share, image


def _gaps(view: Slice, points: Array) -> Array:
    return np.asarray(np.linalg.norm(np.diff(points, axis=0) / view.width, axis=-1))


def _forward(view: Slice) -> Step:
    def step(points: Array) -> Array:
        moved = np.full_like(points, np.nan)
        known = np.all(np.isfinite(points), axis=-1)
        moved[known] = points[known] + rates_at(view, points[known])
        return _inside(view, moved)

    return step


def _backward(view: Slice) -> Step:
    """The place that a step came from, by Newton's method from where it went to."""
    one = np.eye(len(view.axes))
    low, high = view.low, view.low + view.width

    def step(points: Array) -> Array:
        places = points.copy()
        missed = before = np.full(len(points), np.inf)
        for tries in range(NEWTON):
            within = np.where(view.periodic, places, np.clip(places, low, high))
            J = np.nan_to_num(jacobians_at(view, within)) * view.width / view.width[:, None]
            off = shortest(view, within + rates_at(view, within) - points) / view.width
            outside = (places - within) / view.width
            missed = np.linalg.norm(off, axis=-1) + np.linalg.norm(outside, axis=-1)
            settled = ~(missed > SETTLED)
            if np.all(settled | (tries > 4) & (missed > 0.9 * before)):
                break
            before = missed
            regular = J + 1e-12 * one
            change = np.linalg.solve(regular, -np.nan_to_num(off)[..., None])[..., 0]
            size = np.linalg.norm(change, axis=-1, keepdims=True)
            places = within + change / np.maximum(1.0, size / 0.25) * view.width
        return _inside(view, np.where((missed <= SETTLED)[:, None], places, np.nan))

    return step


def _inside(view: Slice, points: Array) -> Array:
    """`points` with those outside the domain NaN."""
    low, high = view.low, view.low + view.width
    with np.errstate(invalid="ignore"):
        inside = np.all(view.periodic | ((points >= low) & (points <= high)), axis=-1)
    return np.where(inside[:, None], points, np.nan)


def _at_border(view: Slice, point: Array) -> bool:
    low, high = (point - view.low) / view.width, (view.low + view.width - point) / view.width
    return bool(np.any(~np.array(view.periodic) & (np.minimum(low, high) < 2.0 * STRIDE)))


def _end(
    view: Slice, points: Array, traps: Sequence[Trap], tubes: Sequence[Tube]
) -> tuple[Reaches, int] | None:
    """What a whole image has come to."""
    for trap in traps:
        small = np.ptp(points, axis=0).max(initial=0.0) < STRIDE * view.width.max()
        if small and np.all(trap.holds(view, points)):
            return Reaches.POINT, trap.index
    for tube in tubes:
        if np.all(gaps_to(view, tube, points) <= tube.reach):
            return Reaches.CYCLE, tube.index
    return None


def _separatrix(
    view: Slice, branch: Branch, end: tuple[Reaches, int], steps: Array, points: Array
) -> Separatrix:
    times = view.program.field.every * steps
    if branch.stable:
        times, points = -times[::-1], points[::-1]
    return Separatrix(branch.saddle, branch.stable, *end, frozen(times), frozen(points))

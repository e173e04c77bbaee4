"""All zeros of a field on a slice, proved: branch and prune over interval bounds.

A box is dropped where some rate can't be zero in it. From what is left Newton's method leads to
approximate zeros; around each a box is sought in which Krawczyk's test proves exactly one zero
(epsilon-inflation: the box is centred on the zero, so that zeros in corners and on edges of the
search's boxes are decided, too). Boxes inside such a region are done; the others are halved, until
nothing is left, or they are too small or too many: they stay undecided (Neumaier 1990; Schichl and
Neumaier 2004 on the regions). m: axes; B: boxes; k: zeros.
"""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, frozen
from runtime.enclosure import Enclosure, changes, enclosure_of, slopes
from runtime.flow import Source
from runtime.intervals import Interval, add, exactly
from verifier.topology.features import UndecidedBox
from verifier.topology.slices import Slice
from verifier.topology.zeros.certificates import unstable_directions
from verifier.topology.zeros.contraction import inverses_of, krawczyk, mean_value, narrowed
from verifier.topology.zeros.regions import (
    ROUNDING,
    Regions,
    each_once,
    in_domain,
    joined,
    named,
    proved_regions,
    rows_of,
)
from verifier.topology.zeros.undecided import merged_boxes

SMALLEST: Final = 2.0**-21
"""Boxes of this share of the domain are not halved any more."""

MOST: Final = 4000
"""So many boxes, and more than in the round before, and that three times, are a continuum."""

PATIENCE: Final = 3
"""How often in a row the boxes may become more."""

WORK: Final = 60_000_000
"""How much may be spent on one proof; about two seconds."""

SIZES: Final = (2.0, 0.5, 0.1, 0.01, 1e-3)
"""Radii of the regions that are tried around a zero, in radii of the box that led to it."""

LEAST_START: Final = {1: 64, 2: 32, 3: 12, 4: 6}
"""Boxes per axis that a search begins with, for each number of axes."""

NEWTON_ENDS: Final = 1e-14
"""Newton's method is done when it moves a point by less than this share of its box."""

MOST_START: Final = 140_000
"""A search that begins with the cells of a table begins with no more boxes than this."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Proof:
    """What was proved of the zeros of a field on a slice, for every control in the box asked for.

    zeros, radii: (k, m) for each zero one point and how far from it it may be. regions: (k, m)
    around each zero, in which there is no other. slopes: (k, m, m) bounds of the derivatives at
    the zeros; of a map those of the next point. unstable: how many directions grow at each zero,
    None where that could not be decided. undecided: boxes that may hold further zeros, or none.
    about: "the tables" or "the formula".
    """

    zeros: Array
    radii: Array
    regions: Array
    slopes: Interval
    unstable: tuple[int | None, ...]
    undecided: tuple[UndecidedBox, ...]
    complete: bool
    about: str


def prove(
    view: Slice,
    controls: Array | None = None,
    source: Source = Source.TABLES,
    smallest: float = SMALLEST,
    still: Booleans | None = None,
) -> Proof:
    """Every zero of the slice's field, with proof, or the boxes in which that was not possible.

    controls: (2, p) lowest and highest values; without them those of the slice. For an interval of
    controls "a zero" is one zero for each value of the controls, all of them within its radius.
    smallest: boxes of this share of the domain are not halved any more. still: axes (m,) along
    which nothing moves: their rates are taken as zero, and no zero is isolated.

    Raises:
        ValueError: the field has no formula, and `source` asks for it.
    """
    box = np.stack([view.u, view.u]) if controls is None else np.asarray(controls)
    names = tuple(axis.name for axis in view.axes)
    field = enclosure_of(view.program, names, view.x, box, source)
    moving = np.ones(len(names), dtype=np.bool_) if still is None else ~still
    search = _searched(view, field, smallest, moving)
    formula = source is Source.FORMULA or not view.program.field.tables
    return _reported(view, search, "the formula" if formula else "the tables")


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Search:
    """A search under way: boxes low to high (B, m) that are still open, and what is done.

    moving: the axes (m,) whose rates may exclude a box.
    """

    field: Enclosure
    width: Array
    smallest: float
    low: Array
    high: Array
    regions: Regions
    stuck: tuple[tuple[Array, Array], ...]
    work: int
    moving: Booleans


def _searched(view: Slice, field: Enclosure, smallest: float, moving: Booleans) -> _Search:
    low, high = _start(view, field)
    m = low.shape[1]
    nothing = np.empty((0, m))
    none = Regions(nothing, nothing, nothing, nothing)
    search = _Search(field, view.width, smallest, low, high, none, (), 0, moving)
    search = _without_far_ones(search)
    before, grown = len(search.low), 0
    while len(search.low):
        search = _round(search)
        count = len(search.low)
        grown = grown + 1 if count > max(MOST, before) else 0
        if grown >= PATIENCE or search.work > WORK:
            return _stopped(search)
        before = count
    return search


def _start(view: Slice, field: Enclosure) -> tuple[Array, Array]:
    """The boxes to begin with: cells of the tables, and a little over the domain's edge."""
    m = len(view.axes)
    counts = [max(LEAST_START[m], _cells(field, axis.name)) for axis in view.axes]
    while np.prod(counts) > MOST_START:
        counts = [max(1, (count + 1) // 2) for count in counts]
    edges = []
    for axis, count in zip(view.axes, counts, strict=True):
        nodes = axis.low + axis.width * np.arange(count + 1) / count
        nodes[-1] = axis.low + axis.width
        nodes[0] -= ROUNDING * axis.width
        nodes[-1] += ROUNDING * axis.width
        edges.append(nodes)
    low = np.stack(np.meshgrid(*[e[:-1] for e in edges], indexing="ij"), axis=-1)
    high = np.stack(np.meshgrid(*[e[1:] for e in edges], indexing="ij"), axis=-1)
    return low.reshape(-1, m), high.reshape(-1, m)


def _cells(field: Enclosure, name: str) -> int:
    return max(
        (
            axis.count if axis.periodic else axis.count - 1
            for block in field.blocks
            for axis in block.columns.axes
            if axis.name == name
        ),
        default=0,
    )


def _without_far_ones(search: _Search) -> _Search:
    """The search without the boxes that coarse bounds exclude."""
    if not search.field.blocks:
        return search
    open_ = _may_be_open(search, changes(search.field, search.low, search.high, coarse=True))
    return replace(search, low=search.low[open_], high=search.high[open_])


def _may_be_zero(values: Interval) -> Booleans:
    return np.asarray(np.all((values.low <= 0.0) & (values.high >= 0.0), axis=-1))


def _may_be_open(search: _Search, values: Interval) -> Booleans:
    """Which boxes the rates along the axes that move do not exclude."""
    return _may_be_zero(Interval(values.low[:, search.moving], values.high[:, search.moving]))


def _round(search: _Search) -> _Search:
    """Drop boxes, prove zeros near the others, and halve what is left."""
    field = search.field
    low, high = search.low, search.high
    open_ = _may_be_open(search, changes(field, low, high))
    work = search.work + len(low) * field.work
    low, high = low[open_], high[open_]
    if not len(low):
        return replace(search, low=low, high=high, work=work)
    J = slopes(field, low, high)
    centre = 0.5 * (low + high)
    radius = np.nextafter(np.maximum(high - centre, centre - low), np.inf)
    at_centre = changes(field, centre, centre)
    open_ = _may_be_open(search, mean_value(at_centre, J, radius))
    if not np.all(search.moving):
        work += len(open_) * field.work * (2 + low.shape[1])
        search = replace(search, low=low[open_], high=high[open_], work=work)
        return _halved(search, Interval(J.low[open_], J.high[open_]))
    found = krawczyk(centre, radius, at_centre, J, inverses_of(J))
    low, high = narrowed(found, low, high)
    open_ &= np.all(low <= high, axis=-1)
    near = open_ & np.all(np.abs(found.newton) <= 3.0 * radius, axis=-1)
    work += len(open_) * field.work * (2 + low.shape[1])
    search = replace(search, low=low[open_], high=high[open_], work=work)
    if np.any(near):
        search = _with_regions(search, (centre + found.newton)[near], radius[near])
    return _halved(search, Interval(J.low[open_], J.high[open_]))


def _halved(search: _Search, J: Interval) -> _Search:
    """The open boxes outside the regions, halved along the axes that matter most."""
    inside = search.regions.contain(search.low, search.high)
    low, high = search.low[~inside], search.high[~inside]
    share = (high - low) / search.width
    small = np.all(share <= search.smallest, axis=-1)
    stuck = search.stuck
    if np.any(small):
        stuck = (*stuck, (low[small], high[small]))
    steep = np.maximum(np.abs(J.low), np.abs(J.high))[~inside]
    low, high, steep = low[~small], high[~small], steep[~small]
    halves = _halves(low, high, _worst_axes(search, high - low, steep))
    return replace(search, low=halves[0], high=halves[1], stuck=stuck)


def _worst_axes(search: _Search, size: Array, steep: Array) -> Booleans:
    """Up to two axes (B, m) along which a box lets the rates vary most, or is longest."""
    with np.errstate(all="ignore"):
        smear = steep * size[:, None, :]
        smear = smear / smear.max(axis=-1, keepdims=True)
        weight = np.nan_to_num(smear, nan=0.0).max(axis=1)
    share = size / search.width
    longest = share.max(axis=-1, keepdims=True)
    weight = np.where(
        share <= search.smallest, 0.0, np.maximum(weight, 1e-3) * (share > 0.02 * longest)
    )
    rank = np.argsort(np.argsort(-weight, axis=-1, kind="stable"), axis=-1)
    best = weight.max(axis=-1, keepdims=True)
    return np.asarray((rank < 2) & (weight >= 0.25 * best) & (weight > 0.0))


def _halves(low: Array, high: Array, axes: Booleans) -> tuple[Array, Array]:
    """Boxes cut in the middle along each of the `axes` (B, m) chosen for them."""
    for j in range(low.shape[1]):
        cut = axes[:, j]
        middle = 0.5 * (low[:, j] + high[:, j])
        upper_low, lower_high = low[cut].copy(), high[cut].copy()
        upper_low[:, j] = lower_high[:, j] = middle[cut]
        low, high, axes = (
            np.concatenate([low[~cut], low[cut], upper_low]),
            np.concatenate([high[~cut], lower_high, high[cut]]),
            np.concatenate([axes[~cut], axes[cut], axes[cut]]),
        )
    return low, high


def _with_regions(search: _Search, starts: Array, radius: Array) -> _Search:
    """The search with a region proved around each zero that Newton's method reaches."""
    points, radius = _polished(search, starts, radius)
    points, radius = _different(search, points, radius)
    regions = search.regions
    for size in SIZES:
        if not len(points):
            break
        proved = proved_regions(search.field, points, size * radius)
        if proved is not None:
            ok = np.asarray(np.isfinite(proved.radius).all(axis=-1))
            regions = joined(regions, proved, ok)
            points, radius = points[~ok], radius[~ok]
    return replace(search, regions=regions, work=search.work + 8 * len(starts) * search.field.work)


def _polished(search: _Search, points: Array, radius: Array) -> tuple[Array, Array]:
    """`points` after some steps of Newton's method; those that wander off are dropped."""
    start = points
    for _ in range(4):
        J = inverses_of(slopes(search.field, points, points))
        values = changes(search.field, points, points)
        with np.errstate(all="ignore"):
            f = 0.5 * (values.low + values.high)
            step = np.einsum("...ij,...j->...i", J, f)
        kept = np.all(np.abs(points - step - start) <= 4.0 * radius, axis=-1)
        points, start, radius = (points - step)[kept], start[kept], radius[kept]
        if np.all(np.abs(step[kept]) <= NEWTON_ENDS * radius):
            break
    return points, radius


def _different(search: _Search, points: Array, radius: Array) -> tuple[Array, Array]:
    """One of each group of points that are nearly the same, none from known regions."""
    new = ~search.regions.contain(points, points)
    points, radius = points[new], radius[new]
    scaled = np.round(points / (search.width * 1e-9))
    _, first = np.unique(scaled, axis=0, return_index=True)
    return points[first], radius[first]


def _stopped(search: _Search) -> _Search:
    rest = (search.low, search.high)
    nothing = np.empty((0, search.low.shape[1]))
    return replace(search, low=nothing, high=nothing, stuck=(*search.stuck, rest))


def _reported(view: Slice, search: _Search, about: str) -> Proof:
    """What the search shows of the domain."""
    regions = search.regions
    inside, partly = _in_domain(view, search)
    rows, doubtful = each_once(view, regions, inside)
    doubtful += partly
    regions = rows_of(regions, rows)
    zeros, radii = named(view, regions)
    order = [int(i) for i in np.lexsort(zeros.T[::-1])]
    zeros, radii, regions = zeros[order], radii[order], rows_of(regions, order)
    J = slopes(search.field, regions.low, regions.high)
    if view.is_map:
        ahead = add(J, exactly(np.eye(len(view.axes))))
        J = Interval(ahead.low, ahead.high)
    low, high = _outside(search.regions, list(search.stuck), len(view.axes))
    low = np.concatenate([low, search.regions.low[doubtful]])
    high = np.concatenate([high, search.regions.high[doubtful]])
    boxes = merged_boxes(view, low, high)
    return Proof(
        zeros=frozen(zeros),
        radii=frozen(radii),
        regions=frozen(regions.radius),
        slopes=J,
        unstable=unstable_directions(J, is_map=view.is_map),
        undecided=boxes,
        complete=not boxes,
        about=about,
    )


def _in_domain(view: Slice, search: _Search) -> tuple[list[int], list[int]]:
    """Which zeros lie in the domain for certain, and those of which that is open.

    A zero moves across the border where the controls are intervals. One on the upper end of a seam
    is one only if the rates are zero at the lower end, too: the field may jump there.
    """
    regions = search.regions
    slack = ROUNDING * view.width
    top = view.low + view.width
    within = (regions.low >= view.low - slack) & (regions.high <= top + slack)
    sure = np.all(within | view.periodic, axis=-1)
    dropped = np.zeros(len(sure), dtype=np.bool_)
    for j in np.flatnonzero(view.periodic):
        at_end = regions.high[:, j] >= top[j] - slack[j]
        turn = np.zeros(len(top))
        turn[j] = view.width[j]
        spare = np.where(turn > 0.0, slack, 0.0)
        low, high = regions.low - turn - spare, regions.high - turn + spare
        jumps = at_end & ~_may_be_zero(changes(search.field, low, high))
        dropped |= jumps & (regions.low[:, j] >= top[j] - slack[j])
        sure &= ~jumps
    rows = in_domain(view, regions)
    return [i for i in rows if sure[i]], [i for i in rows if not sure[i] and not dropped[i]]


def _outside(regions: Regions, boxes: list[tuple[Array, Array]], m: int) -> tuple[Array, Array]:
    """All open boxes, without those inside regions that were found later."""
    low = np.concatenate([np.empty((0, m)), *(low for low, _ in boxes)])
    high = np.concatenate([np.empty((0, m)), *(high for _, high in boxes)])
    left = ~regions.contain(low, high)
    return low[left], high[left]

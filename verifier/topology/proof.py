"""All zeros of a field on a slice, proved: branch and prune over interval bounds.

A box is dropped where some rate can't be zero in it. From what is left Newton's method leads to
approximate zeros; around each a box is sought in which Krawczyk's test proves exactly one zero
(epsilon-inflation: the box is centred on the zero, so that zeros in corners and on edges of the
search's boxes are decided, too). Boxes inside such a region are done; the others are halved, until
nothing is left, or they are too small or too many: they stay undecided (Neumaier 1990; Schichl and
Neumaier 2004 on the regions). m: axes; B: boxes; k: zeros.
"""

from dataclasses import dataclass, replace
from itertools import product
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, frozen
from runtime.enclosure import Enclosure, changes, enclosure_of, slopes
from runtime.flow import Source
from runtime.intervals import Interval, add, exactly
from verifier.topology.certificates import unstable_directions
from verifier.topology.contraction import (
    inverses_of,
    is_inside,
    krawczyk,
    mean_value,
    narrowed,
)
from verifier.topology.features import UndecidedBox
from verifier.topology.slices import Slice
from verifier.topology.undecided import merged_boxes

ROUNDING: Final = 1e-12
"""A zero this share of the domain outside of it counts as one on its border."""

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

CONTRACTIONS: Final = 12
"""So often is a box around a zero contracted at most; from a tenth of the domain it takes six."""

LEAST_START: Final = {1: 64, 2: 32, 3: 12, 4: 6}
"""Boxes per axis that a search begins with, for each number of axes."""

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


def prove(view: Slice, controls: Array | None = None, source: Source = Source.TABLES) -> Proof:
    """Every zero of the slice's field, with proof, or the boxes in which that was not possible.

    controls: (2, p) lowest and highest values; without them those of the slice. For an interval of
    controls "a zero" is one zero for each value of the controls, all of them within its radius.

    Raises:
        ValueError: the field has no formula, and `source` asks for it.
    """
    box = np.stack([view.u, view.u]) if controls is None else np.asarray(controls)
    names = tuple(axis.name for axis in view.axes)
    field = enclosure_of(view.program, names, view.x, box, source)
    search = _searched(view, field)
    formula = source is Source.FORMULA or not view.program.field.tables
    return _reported(view, search, "the formula" if formula else "the tables")


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Regions:
    """Regions centre +- radius (k, m) with one zero each, that lies in low to high (k, m)."""

    centre: Array
    radius: Array
    low: Array
    high: Array

    def contain(self, low: Array, high: Array) -> Booleans:
        """For each box low to high (B, m) whether it lies in one of the regions."""
        if not len(self.centre):
            return np.zeros(len(low), dtype=np.bool_)
        first, last = self.centre - self.radius, self.centre + self.radius
        inside = (low[:, None] >= first) & (high[:, None] <= last)
        return np.asarray(inside.all(axis=-1).any(axis=-1))


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Search:
    """A search under way: boxes low to high (B, m) that are still open, and what is done."""

    field: Enclosure
    width: Array
    low: Array
    high: Array
    regions: _Regions
    stuck: tuple[tuple[Array, Array], ...]
    work: int


def _searched(view: Slice, field: Enclosure) -> _Search:
    low, high = _start(view, field)
    m = low.shape[1]
    nothing = np.empty((0, m))
    search = _Search(
        field, view.width, low, high, _Regions(nothing, nothing, nothing, nothing), (), 0
    )
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
    open_ = _may_be_zero(changes(search.field, search.low, search.high, coarse=True))
    return replace(search, low=search.low[open_], high=search.high[open_])


def _may_be_zero(values: Interval) -> Booleans:
    return np.asarray(np.all((values.low <= 0.0) & (values.high >= 0.0), axis=-1))


def _round(search: _Search) -> _Search:
    """Drop boxes, prove zeros near the others, and halve what is left."""
    field = search.field
    low, high = search.low, search.high
    open_ = _may_be_zero(changes(field, low, high))
    work = search.work + len(low) * field.work
    low, high = low[open_], high[open_]
    if not len(low):
        return replace(search, low=low, high=high, work=work)
    J = slopes(field, low, high)
    centre = 0.5 * (low + high)
    radius = np.nextafter(np.maximum(high - centre, centre - low), np.inf)
    at_centre = changes(field, centre, centre)
    open_ = _may_be_zero(mean_value(at_centre, J, radius))
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
    small = np.all(share <= SMALLEST, axis=-1)
    stuck = search.stuck
    if np.any(small):
        stuck = (*stuck, (low[small], high[small]))
    steep = np.maximum(np.abs(J.low), np.abs(J.high))[~inside]
    low, high, steep = low[~small], high[~small], steep[~small]
    halves = _halves(low, high, _worst_axes(high - low, steep, search.width))
    return replace(search, low=halves[0], high=halves[1], stuck=stuck)


def _worst_axes(size: Array, steep: Array, width: Array) -> Booleans:
    """Up to two axes (B, m) along which a box lets the rates vary most, or is longest."""
    with np.errstate(all="ignore"):
        smear = steep * size[:, None, :]
        smear = smear / smear.max(axis=-1, keepdims=True)
        weight = np.nan_to_num(smear, nan=0.0).max(axis=1)
    share = size / width
    longest = share.max(axis=-1, keepdims=True)
    weight = np.where(share <= SMALLEST, 0.0, np.maximum(weight, 1e-3) * (share > 0.02 * longest))
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
        proved = _proved(search.field, points, size * radius)
        ok = proved is not None and np.isfinite(proved.radius).all(axis=-1)
        if proved is None:
            continue
        regions = _joined(regions, proved, np.asarray(ok))
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
    return points, radius


def _different(search: _Search, points: Array, radius: Array) -> tuple[Array, Array]:
    """One of each group of points that are nearly the same, none from known regions."""
    new = ~search.regions.contain(points, points)
    points, radius = points[new], radius[new]
    scaled = np.round(points / (search.width * 1e-9))
    _, first = np.unique(scaled, axis=0, return_index=True)
    return points[first], radius[first]


def _proved(field: Enclosure, points: Array, radius: Array) -> _Regions | None:
    """Regions around points (B, m) with exactly one zero each; radius NaN where not proved."""
    exact = changes(field, points, points)
    inverses = inverses_of(slopes(field, points, points))
    reach = np.nan_to_num(np.abs(krawczyk_step(exact, inverses)))
    radius = np.maximum(radius, 3.0 * reach + 1e-14 * np.abs(points))
    low, high = points - radius, points + radius
    radius = np.nextafter(np.maximum(high - points, points - low), np.inf)
    found = krawczyk(points, radius, exact, slopes(field, low, high), inverses)
    ok = is_inside(found, points, radius)
    if not np.any(ok):
        return None
    narrow = narrowed(found, low, high)
    narrow = _tightened(field, *narrow, inverses, ok)
    # A region must hold only points for which the test was made: not those that rounding added.
    return _Regions(points, np.where(ok[:, None], radius, np.nan), *narrow)


def krawczyk_step(values: Interval, inverses: Array) -> Array:
    """How far (B, m) a zero may be by bounds of f at a point: |Y| |f|."""
    size = np.maximum(np.abs(values.low), np.abs(values.high))
    with np.errstate(invalid="ignore"):
        step: Array = np.einsum("...ij,...j->...i", np.abs(inverses), size)
    return step


def _tightened(
    field: Enclosure, low: Array, high: Array, inverses: Array, ok: Booleans
) -> tuple[Array, Array]:
    """Boxes around proved zeros, contracted as far as it goes."""
    low, high = low.copy(), high.copy()
    for _ in range(CONTRACTIONS):
        centre = 0.5 * (low[ok] + high[ok])
        radius = np.nextafter(np.maximum(high[ok] - centre, centre - low[ok]), np.inf)
        values, J = changes(field, centre, centre), slopes(field, low[ok], high[ok])
        found = krawczyk(centre, radius, values, J, inverses[ok])
        first, last = narrowed(found, low[ok], high[ok])
        fine = np.all(first <= last, axis=-1, keepdims=True)
        low[ok], high[ok] = np.where(fine, first, low[ok]), np.where(fine, last, high[ok])
        if np.all(high[ok] - low[ok] > 1.8 * radius):
            break
    return low, high


def _joined(regions: _Regions, more: _Regions, ok: Booleans) -> _Regions:
    """Both, without those whose zero is that of a region before."""
    for i in np.flatnonzero(ok):
        if not regions.contain(more.low[i : i + 1], more.high[i : i + 1])[0]:
            regions = _Regions(
                *(
                    np.concatenate([getattr(regions, part), getattr(more, part)[i : i + 1]])
                    for part in ("centre", "radius", "low", "high")
                )
            )
    return regions


def _stopped(search: _Search) -> _Search:
    rest = (search.low, search.high)
    nothing = np.empty((0, search.low.shape[1]))
    return replace(search, low=nothing, high=nothing, stuck=(*search.stuck, rest))


def _reported(view: Slice, search: _Search, about: str) -> Proof:
    """What the search shows of the domain."""
    regions = search.regions
    rows, doubtful = _once(view, regions, _in_domain(view, regions))
    regions = _rows(regions, rows)
    zeros, radii = _named(view, regions)
    order = [int(i) for i in np.lexsort(zeros.T[::-1])]
    zeros, radii, regions = zeros[order], radii[order], _rows(regions, order)
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


def _rows(regions: _Regions, rows: list[int]) -> _Regions:
    return _Regions(
        regions.centre[rows], regions.radius[rows], regions.low[rows], regions.high[rows]
    )


def _in_domain(view: Slice, regions: _Regions) -> list[int]:
    """Which zeros lie in the domain, or outside by no more than rounding."""
    slack = ROUNDING * view.width
    first, last = view.low - slack, view.low + view.width + slack
    inside = np.all((regions.high >= first) & (regions.low <= last), axis=-1)
    return [int(i) for i in np.flatnonzero(inside)]


def _once(view: Slice, regions: _Regions, rows: list[int]) -> tuple[list[int], list[int]]:
    """Each zero once, also one on a seam; and those of which it is open whether they are new.

    Regions i and j speak of one zero if the zero of j lies in region i.
    """
    kept: list[int] = []
    doubtful: list[int] = []
    for j in rows:
        standings = [_standing(view, regions, i, j) for i in kept]
        if "same" in standings:
            continue
        (doubtful if "open" in standings else kept).append(j)
    return kept, doubtful


def _standing(view: Slice, regions: _Regions, i: int, j: int) -> str:
    """Whether zero j is zero i, seen from whichever side of a seam: same, other or open."""
    reach = [(-1.0, 0.0, 1.0) if around else (0.0,) for around in view.periodic]
    slack = ROUNDING * view.width * np.array(view.periodic)
    answer = "other"
    for turns in product(*reach):
        shift = np.array(turns) * view.width
        low, high = regions.low[j] + shift - slack, regions.high[j] + shift + slack
        first, last = (regions.centre[i] + side * regions.radius[i] for side in (-1.0, 1.0))
        if np.all((low >= first) & (high <= last)):
            return "same"
        if np.all((low <= regions.high[i]) & (high >= regions.low[i])):
            answer = "open"
    return answer


def _named(view: Slice, regions: _Regions) -> tuple[Array, Array]:
    """For each zero a point of the domain and how far the zero may be from it; a seam is low."""
    low, high = regions.low.copy(), regions.high.copy()
    top = view.low + view.width
    at_seam = np.array(view.periodic) & (high >= top - ROUNDING * view.width)
    low, high = (np.where(at_seam, end - view.width, end) for end in (low, high))
    zeros = np.clip(0.5 * (low + high), view.low, top)
    zeros = np.where(np.abs(zeros) <= (high - low) + 1e-15 * view.width, 0.0, zeros)
    radii = np.maximum(high - zeros, zeros - low) + 2.0**-52 * view.width * at_seam
    return zeros, np.nextafter(np.maximum(radii, 0.0), np.inf)


def _outside(regions: _Regions, boxes: list[tuple[Array, Array]], m: int) -> tuple[Array, Array]:
    """All open boxes, without those inside regions that were found later."""
    low = np.concatenate([np.empty((0, m)), *(low for low, _ in boxes)])
    high = np.concatenate([np.empty((0, m)), *(high for _, high in boxes)])
    left = ~regions.contain(low, high)
    return low[left], high[left]

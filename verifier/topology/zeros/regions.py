"""Regions with exactly one zero each: how they are proved, and which of them speak of one zero.

m: axes; B: boxes or points; k: regions.
"""

from dataclasses import dataclass
from itertools import product
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.enclosure import Enclosure, changes, slopes
from runtime.intervals import Interval
from verifier.topology.slices import Slice
from verifier.topology.zeros.contraction import inverses_of, is_inside, krawczyk, narrowed

ROUNDING: Final = 1e-12
"""A zero this share of the domain outside of it counts as one on its border."""

POINT: Final = 2.0**-60
"""A box of this share of a region's radius is as good as a point."""

CONTRACTIONS: Final = 12
"""So often is a box around a zero contracted at most; from a tenth of the domain it takes six."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Regions:
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


def proved_regions(field: Enclosure, points: Array, radius: Array) -> Regions | None:
    """Regions around points (B, m) with exactly one zero each; radius NaN where not proved."""
    exact = changes(field, points, points)
    inverses = inverses_of(slopes(field, points, points))
    reach = np.nan_to_num(_reach(exact, inverses))
    radius = np.maximum(radius, 3.0 * reach + 1e-14 * np.abs(points))
    low, high = points - radius, points + radius
    # The box low to high is rounded: the test is made with a radius around it, and for one inside.
    outer = np.nextafter(np.maximum(high - points, points - low), np.inf)
    inner = np.nextafter(np.minimum(high - points, points - low), 0.0)
    found = krawczyk(points, outer, exact, slopes(field, low, high), inverses)
    ok = is_inside(found, points, inner)
    if not np.any(ok):
        return None
    narrow = narrowed(found, low, high)
    small = np.minimum(3.0 * reach + 1e-14 * np.abs(points) + POINT * inner, inner)
    narrow = _around(field, points, exact, small, narrow)
    fine = 2.0**-52 * np.abs(points) + 4.0 * POINT * inner
    narrow = _tightened(
        field, *narrow, inverses, ok & np.any(narrow[1] - narrow[0] > fine, axis=-1)
    )
    return Regions(points, np.where(ok[:, None], inner, np.nan), *narrow)


def _around(
    field: Enclosure, points: Array, exact: Interval, radius: Array, known: tuple[Array, Array]
) -> tuple[Array, Array]:
    """The boxes `known`, replaced by small ones around the points where these hold a zero, too.

    Near a fold the test for a large box leaves nearly all of it, however often it is contracted:
    the slope at its far end is a multiple of that at the zero. A zero in a small box, of a radius
    (B, m) within that of the large one, is the only one of the large box.
    """
    low, high = points - radius, points + radius
    outer = np.nextafter(np.maximum(high - points, points - low), np.inf)
    inner = np.nextafter(np.minimum(high - points, points - low), 0.0)
    J = slopes(field, low, high)
    found = krawczyk(points, outer, exact, J, inverses_of(J))
    first, last = narrowed(found, low, high)
    better = is_inside(found, points, inner)[:, None]
    return (
        np.where(better, np.maximum(first, known[0]), known[0]),
        np.where(better, np.minimum(last, known[1]), known[1]),
    )


def _reach(values: Interval, inverses: Array) -> Array:
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
    for _ in range(CONTRACTIONS if np.any(ok) else 0):
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


def joined(regions: Regions, more: Regions, ok: Booleans) -> Regions:
    """Both, without those whose zero is that of a region before."""
    for i in np.flatnonzero(ok):
        if not regions.contain(more.low[i : i + 1], more.high[i : i + 1])[0]:
            regions = Regions(
                *(
                    np.concatenate([getattr(regions, part), getattr(more, part)[i : i + 1]])
                    for part in ("centre", "radius", "low", "high")
                )
            )
    return regions


def rows_of(regions: Regions, rows: list[int]) -> Regions:
    """Some of the regions, in the order of `rows`."""
    return Regions(
        regions.centre[rows], regions.radius[rows], regions.low[rows], regions.high[rows]
    )


def in_domain(view: Slice, regions: Regions) -> list[int]:
    """Which zeros lie in the domain, or outside by no more than rounding."""
    slack = ROUNDING * view.width
    first, last = view.low - slack, view.low + view.width + slack
    inside = np.all((regions.high >= first) & (regions.low <= last), axis=-1)
    return [int(i) for i in np.flatnonzero(inside)]


def each_once(view: Slice, regions: Regions, rows: list[int]) -> tuple[list[int], list[int]]:
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


def _standing(view: Slice, regions: Regions, i: int, j: int) -> str:
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


def named(view: Slice, regions: Regions) -> tuple[Array, Array]:
    """For each zero a point of the domain and how far the zero may be from it; a seam is low."""
    low, high = regions.low.copy(), regions.high.copy()
    top = view.low + view.width
    at_seam = np.array(view.periodic) & (high >= top - ROUNDING * view.width)
    low, high = (np.where(at_seam, end - view.width, end) for end in (low, high))
    zeros = np.clip(0.5 * (low + high), view.low, top)
    zeros = np.where(np.abs(zeros) <= (high - low) + 1e-15 * view.width, 0.0, zeros)
    radii = np.maximum(high - zeros, zeros - low) + 2.0**-52 * view.width * at_seam
    return zeros, np.nextafter(np.maximum(radii, 0.0), np.inf)

"""The mean error in each part of phase space and control domain in which the robot was.

A mean, because noise of the sensors and unrest of the robot average out and say nothing about the
spec; of parts, because errors of opposite signs would otherwise hide one another. Within a part
the mean may depend, on a straight line, on how far the variable was predicted to move, and on how
much faster at the end than at the start: it is told for short and for long moves, slowing down
and speeding up, so that a wrong gain and a late input show however few parts there are.

Errors of neighbouring windows depend on one another (they overlap, and unrest may last), so
windows are gathered in *clusters* of at least 1.5 horizons, longer where what the parts leave
unexplained stays correlated for longer (Geyer's initial positive sequence, 1992).
"""

from dataclasses import dataclass
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arrays import Array, Integers
from verifier.fidelity.judging.conditional_mean import Means, conditional_means
from verifier.fidelity.judging.departure import CONFIDENCE, correlation_time
from verifier.fidelity.judging.parts import LEAST, Condition, Part, parts_of
from verifier.fidelity.shooting.shooting import Errors
from verifier.report.report import Interval, Standing

CLUSTER_HORIZONS: Final = 1.5
WINDOWS_PER_HORIZON: Final = 2
ALIKE: Final = 0.25
"""Moves that differ by less than this share of the tolerance are of one length: even a variable
that does not move at all would depart by no more."""
CLUSTERS_PER_COLUMN: Final = 4
"""So many clusters for each number that is estimated in a part."""
LEANING: Final = 0.5
"""A slope is told from no single cluster: none has more than this share of what moves differ by."""
SHARP: Final = 0.2
"""Parts are so large that their means are known to this share of the tolerance,"""
STUDENT: Final = 3.0
"""at the ends of a slope: Student's t times the square root of two."""

Manner: TypeAlias = tuple[float | None, float | None]
"""How far a window moved, and how much it hurried; None where that is not told apart."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class PartMean:
    """The mean error in one part, for windows of one manner.

    moved, hurried: of windows that were predicted to move about so far, and so much farther in
    the last tenth of the horizon than in the first; None where that makes no difference.
    """

    part: Part
    moved: float | None
    hurried: float | None
    mean: float
    interval: Interval
    standing: Standing


@final
@dataclass(frozen=True, eq=False, slots=True)
class PartMeans:
    """The means in all parts, and what is left of the errors.

    shown: a mean beyond this is shown to be somewhere, at the given chance of error. scatter: how
    far single windows lie from the mean of their part, the noise of the sensors taken out.
    unjudged: windows in no part. clusters: (W,) which windows depend on one another.
    """

    means: tuple[PartMean, ...]
    shown: float
    scatter: float
    unjudged: int
    clusters: Integers


def part_means(
    errors: Errors, conditions: tuple[Condition, ...], tolerance: float, chance: float
) -> PartMeans:
    """The means of errors of W windows in order of time, none of them NaN.

    conditions: what each of the windows ran under. A mean counts as beyond the tolerance where
    that is shown after Bonferroni's correction for their number, with `chance` of being wrong;
    it decides as Holm's correction does whether there is any. That all means are within it needs
    no correction (Berger 1982).
    """
    clusters, parts = _parted(errors, conditions, tolerance)
    found = [_means(errors, part, clusters, tolerance) for part in parts]
    shared = chance / max(1, sum(len(means.value) for means, _ in found))
    lowest = [np.maximum(low, -high) for low, high in (m.bounds(shared) for m, _ in found)]
    return PartMeans(
        means=tuple(
            mean
            for part, (means, manners), beyond in zip(parts, found, lowest, strict=True)
            for mean in _told(part, means, manners, beyond, tolerance)
        ),
        shown=max((float(ends.max()) for ends in lowest), default=0.0),
        scatter=_scatter(errors, parts, found),
        unjudged=len(errors.mean) - int(np.sum([np.sum(part.members) for part in parts])),
        clusters=clusters,
    )


def clusters_of(residual: Array) -> Integers:
    """The cluster (W,) of each window, 0, 1, ...: long enough for these residuals."""
    least = CLUSTER_HORIZONS * WINDOWS_PER_HORIZON
    size = max(least, np.ceil(2.0 * correlation_time(residual)))
    count = max(1, int(len(residual) // size))
    return np.arange(len(residual)) * count // len(residual)


def _parted(
    errors: Errors, conditions: tuple[Condition, ...], tolerance: float
) -> tuple[Integers, tuple[Part, ...]]:
    """The clusters (W,), and the parts: as fine as the data can tell within the tolerance.

    What single windows scatter by is seen in the finest parts that there are, where the least of
    it is due to differences between places.
    """
    clusters = clusters_of(np.zeros(len(errors.mean)))
    fine = parts_of(conditions, clusters)
    residual = errors.mean - np.mean(errors.mean)
    for part in fine:
        residual[part.members] = _means(errors, part, clusters, tolerance)[0].residual
    clusters = clusters_of(residual)
    unrest = _unrest(residual, clusters, parts_of(conditions, clusters))
    wanted = (STUDENT * unrest / (SHARP * tolerance)) ** 2 if tolerance > 0.0 else np.inf
    least = int(np.clip(np.ceil(wanted), LEAST, len(errors.mean)))
    return clusters, parts_of(conditions, clusters, least)


def _unrest(residual: Array, clusters: Integers, parts: tuple[Part, ...]) -> float:
    """The standard deviation of a cluster's mean within a part, of all parts together."""
    squares, count = 0.0, 0
    for part in parts:
        _, place = np.unique(clusters[part.members], return_inverse=True)
        sums = np.bincount(place, weights=residual[part.members])
        squares += float(np.sum(sums**2)) * len(sums) / len(place) ** 2 * len(sums)
        count += len(sums)
    return float(np.sqrt(squares / max(count, 1)))


def _means(
    errors: Errors, part: Part, clusters: Integers, tolerance: float
) -> tuple[Means, list[Manner]]:
    """The means in one part, and of which manners of moving they are."""
    own, here = errors.mean[part.members], clusters[part.members]
    columns, manners = [np.ones(len(own))], []
    room = len(np.unique(here)) // CLUSTERS_PER_COLUMN - 1
    for which, values in enumerate((errors.moved[part.members], errors.hurried[part.members])):
        design = np.column_stack(columns)
        rest = values - design @ np.linalg.lstsq(design, values, rcond=None)[0]
        spread = float(np.std(rest))
        if len(columns) > room or spread <= ALIKE * tolerance or _leans(rest, here):
            continue
        columns.append(rest / spread)
        for side in (-1.0, 1.0):
            manner: list[float | None] = [None, None]
            manner[which] = float(np.mean(values)) + side * spread
            manners.append((side * np.eye(3)[len(columns) - 1], manner))
    design = np.column_stack(columns)
    if not manners:
        return conditional_means(own, design, here, np.ones((1, 1))), [(None, None)]
    at = np.array([np.eye(3)[0] + turned for turned, _ in manners])[:, : len(columns)]
    return conditional_means(own, design, here, at), [(m[0], m[1]) for _, m in manners]


def _leans(deviation: Array, clusters: Integers) -> bool:
    """Whether hardly more than one cluster tells short moves from long ones."""
    shares = np.bincount(clusters - clusters.min(), weights=deviation**2)
    return bool(shares.max() > LEANING * shares.sum())


def _told(
    part: Part, means: Means, manners: list[Manner], beyond: Array, tolerance: float
) -> list[PartMean]:
    low, high = means.bounds((1.0 - CONFIDENCE) / 2.0)
    found = []
    for k, value in enumerate(means.value):
        interval = Interval(float(low[k]), float(high[k]))
        is_inside = max(abs(interval.low), abs(interval.high)) <= tolerance
        standing = Standing.WITHIN if is_inside else Standing.UNDECIDED
        standing = Standing.EXCEEDED if beyond[k] > tolerance else standing
        found.append(PartMean(part, *manners[k], float(value), interval, standing))
    return found


def _scatter(
    errors: Errors, parts: tuple[Part, ...], found: list[tuple[Means, list[Manner]]]
) -> float:
    """Of all windows in parts, as a standard deviation."""
    squares, noise, free = 0.0, 0.0, 0
    for part, (means, manners) in zip(parts, found, strict=True):
        squares += float(np.sum(means.residual**2))
        noise += float(np.sum(errors.variance[part.members]))
        free += len(means.residual) - max(1, 1 + len(manners) // 2)
    if free <= 0:
        return 0.0
    judged = sum(len(means.residual) for means, _ in found)
    return float(np.sqrt(max(squares / free - noise / judged, 0.0)))

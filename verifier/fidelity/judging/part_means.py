"""The mean error in each part of phase space and control domain in which the robot was.

A mean, because noise of the sensors and unrest of the robot average out and say nothing about the
spec; of parts, because errors of opposite signs would otherwise hide one another. Beside the parts,
all windows together: there the mean may depend, on a straight line, on how far the variable was
predicted to move, and on how much faster at the end than at the start. It is told for short and
for long moves, slowing down and speeding up, so that a wrong gain and a late input show in short
recordings, too.

Errors of neighbouring windows depend on one another (they overlap, and unrest may last), so
windows are gathered in *clusters* of at least 1.5 horizons, longer where what the parts leave
unexplained stays correlated for longer (Geyer's initial positive sequence, 1992). No cluster
holds windows of two recordings.
"""

from dataclasses import dataclass
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arrays import Array, Integers
from verifier.fidelity.judging.conditional_mean import Means, conditional_means
from verifier.fidelity.judging.departure import CONFIDENCE
from verifier.fidelity.judging.neighbours import correlation_time, gathered, one_run
from verifier.fidelity.judging.parts import LEAST, Condition, Part, parts_of
from verifier.fidelity.shooting.shooting import Errors
from verifier.report.report import Interval, Standing

CLUSTER_HORIZONS: Final = 1.5
WINDOWS_PER_HORIZON: Final = 2
ALIKE: Final = 0.25
"""Moves that differ by less than this share of the tolerance are of one length: even a variable
that does not move at all would depart by no more."""
ROUNDING: Final = 1e-6
"""Less than this share of the tolerance is rounding, which has no correlation worth the name."""
CLUSTERS_PER_COLUMN: Final = 3
"""So many clusters for each number that is estimated in a part."""
MOSTLY: Final = 0.5
"""A quantity whose noise is this share of its spread tells no manners or situations apart."""
LEANING: Final = 0.8
"""A slope is told from no single cluster: none has more than this share of what moves differ by."""
SHARP: Final = 0.2
"""Parts are so large that their means are known to this share of the tolerance,"""
STUDENT: Final = 3.0
"""with so many standard errors."""

Manner: TypeAlias = tuple[float | None, float | None]
"""How far a window moved, and how much it hurried; None where that is not told apart."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class PartMean:
    """The mean error in one part, or everywhere for windows of one manner.

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

    means: everywhere, in the parts, and in finer ones where the tolerance is exceeded.
    shown: a mean beyond this is shown to be somewhere, at the given chance of error. scatter: how
    far single windows lie from the mean of their part, the noise of the sensors taken out.
    unjudged: windows in no part. clusters: (W,) which windows depend on one another.
    """

    means: tuple[PartMean, ...]
    shown: float
    scatter: float
    unjudged: int
    clusters: Integers


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Group:
    """The means of one part, and of which manner of moving each is."""

    part: Part
    means: Means
    manners: list[Manner]


def part_means(
    errors: Errors,
    conditions: tuple[Condition, ...],
    tolerance: float,
    chance: float,
    runs: Integers | None = None,
) -> PartMeans:
    """The means of errors of W windows in order of time, none of them NaN.

    conditions: what each of the windows ran under. runs: the recording (W,) of each, where they
    are of several. A mean counts as beyond the tolerance where
    that is shown after Bonferroni's correction for their number, with `chance` of being wrong;
    it decides as Holm's correction does whether there is any. That all means are within it needs
    no correction (Berger 1982).
    """
    runs = one_run(len(errors.mean)) if runs is None else runs
    clusters, fine, parts, residual = _parted(errors, conditions, tolerance, runs)
    told = [_manners(errors, clusters, tolerance)]
    if len(parts) > 1:
        told += [_plain(errors, part, clusters) for part in parts]
    sought = [_plain(errors, part, clusters) for part in fine] if len(fine) > len(parts) else []
    shared = chance / sum(len(group.means.value) for group in (*told, *sought))
    judged = np.any([part.members for part in parts], axis=0)
    free = max(int(np.sum(judged)) - len(parts) - len(told[0].manners) // 2, 1)
    noise = float(np.sum(errors.variance[judged])) / max(int(np.sum(judged)), 1)
    own = float(np.sum(residual[judged] ** 2)) / free - noise
    means = [mean for group in told for mean in _told(group, shared, tolerance)]
    finer = [mean for group in sought for mean in _told(group, shared, tolerance)]
    return PartMeans(
        means=(*means, *(mean for mean in finer if mean.standing is Standing.EXCEEDED)),
        shown=max(float(_beyond(group, shared).max()) for group in (*told, *sought)),
        scatter=float(np.sqrt(max(own, 0.0))),
        unjudged=int(np.sum(~judged)),
        clusters=clusters,
    )


def blur_of(errors: Errors) -> float:
    """The noise in how far a variable was predicted to move: that of the start, at both ends."""
    carried, unsure = (float(np.sqrt(np.mean(v))) for v in (errors.carried, errors.unsure))
    return carried + unsure


def clusters_of(residual: Array, runs: Integers) -> Integers:
    """The cluster (W,) of each window, 0, 1, ...: long enough for these residuals."""
    least = CLUSTER_HORIZONS * WINDOWS_PER_HORIZON
    return gathered(runs, max(least, np.ceil(2.0 * correlation_time(residual, runs))))


def _parted(
    errors: Errors, conditions: tuple[Condition, ...], tolerance: float, runs: Integers
) -> tuple[Integers, tuple[Part, ...], tuple[Part, ...], Array]:
    """The clusters (W,), fine parts, coarse ones, and what these leave of the errors (W,).

    The coarse parts are as fine as the data can tell within the tolerance: only there can a mean
    be shown to be within it. What windows scatter by is seen in the finest parts that there are,
    where the least of it is due to different places.
    """
    clusters = clusters_of(np.zeros(len(errors.mean)), runs)
    slopes = _manners(errors, clusters, tolerance).means.residual
    if np.max(np.abs(slopes)) <= ROUNDING * tolerance:
        slopes = np.zeros(len(slopes))
    clusters = clusters_of(_within(slopes, parts_of(conditions, clusters)), runs)
    fine = parts_of(conditions, clusters)
    unrest = _unrest(_within(slopes, fine), clusters, fine)
    wanted = (STUDENT * unrest / (SHARP * tolerance)) ** 2 if tolerance > 0.0 else np.inf
    least = int(np.clip(np.ceil(wanted), LEAST, len(errors.mean)))
    parts = parts_of(conditions, clusters, least)
    return clusters, fine, parts, _within(slopes, parts)


def _within(values: Array, parts: tuple[Part, ...]) -> Array:
    """Values (W,) less the mean of their part."""
    rest = values - np.mean(values)
    for part in parts:
        rest[part.members] -= np.mean(rest[part.members])
    return rest


def _unrest(residual: Array, clusters: Integers, parts: tuple[Part, ...]) -> float:
    """The standard deviation of a cluster's mean within a part, of all parts together."""
    squares, count = 0.0, 0
    for part in parts:
        _, place = np.unique(clusters[part.members], return_inverse=True)
        sums = np.bincount(place, weights=residual[part.members])
        squares += float(np.sum(sums**2)) * len(sums) / len(place) ** 2 * len(sums)
        count += len(sums)
    return float(np.sqrt(squares / max(count, 1)))


def _plain(errors: Errors, part: Part, clusters: Integers) -> _Group:
    """The mean of one part."""
    own = errors.mean[part.members]
    one = np.ones((1, 1))
    means = conditional_means(own, np.ones((len(own), 1)), clusters[part.members], one)
    return _Group(part, means, [(None, None)])


def _manners(errors: Errors, clusters: Integers, tolerance: float) -> _Group:
    """The means of short and of long moves, speeding up and slowing down, wherever they were."""
    columns, manners = [np.ones(len(errors.mean))], []
    blur = blur_of(errors)
    room = len(np.unique(clusters)) // CLUSTERS_PER_COLUMN - 1
    for which, values in enumerate((errors.moved, errors.hurried)):
        design = np.column_stack(columns)
        rest = values - design @ np.linalg.lstsq(design, values, rcond=None)[0]
        spread = float(np.std(rest))
        if spread <= max(ALIKE * tolerance, blur / MOSTLY) or _leans(rest, clusters):
            continue
        if len(columns) > room:
            break
        columns.append(rest / spread)
        for side in (-1.0, 1.0):
            manner: list[float | None] = [None, None]
            manner[which] = float(np.mean(values)) + side * spread
            manners.append((side * np.eye(3)[len(columns) - 1], manner))
    design, everywhere = np.column_stack(columns), Part(np.ones(len(errors.mean), dtype=bool))
    turns = [turned for turned, _ in manners] or [np.zeros(3)]
    at = np.array([np.eye(3)[0] + turned for turned in turns])[:, : len(columns)]
    means = conditional_means(errors.mean, design, clusters, at)
    return _Group(everywhere, means, [(m[0], m[1]) for _, m in manners] or [(None, None)])


def _leans(deviation: Array, clusters: Integers) -> bool:
    """Whether hardly more than one cluster tells short moves from long ones."""
    shares = np.bincount(clusters - clusters.min(), weights=deviation**2)
    return bool(shares.max() > LEANING * shares.sum())


def _beyond(group: _Group, chance: float) -> Array:
    """How far each mean is shown to be from zero; negative where it is not."""
    low, high = group.means.bounds(chance)
    return np.maximum(low, -high)


def _told(group: _Group, shared: float, tolerance: float) -> list[PartMean]:
    """The means with their intervals; `shared`: the chance of wrongly finding one exceeded."""
    low, high = group.means.bounds((1.0 - CONFIDENCE) / 2.0)
    beyond = _beyond(group, shared)
    found = []
    for k, value in enumerate(group.means.value):
        interval = Interval(float(low[k]), float(high[k]))
        is_inside = max(abs(interval.low), abs(interval.high)) <= tolerance
        standing = Standing.WITHIN if is_inside else Standing.UNDECIDED
        standing = Standing.EXCEEDED if beyond[k] > tolerance else standing
        found.append(PartMean(group.part, *group.manners[k], float(value), interval, standing))
    return found

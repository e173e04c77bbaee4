"""The state beside a switch: the fit of one mode's field to the samples on one side of it.

Gauss-Newton on the start, with derivatives by differences, as in multiple shooting. Every state may
also drift off the field at a constant rate, from where the switch is: a robot that is a little too
slow within a mode is not to be blamed for its jumps. Letters as in `setting`; m: samples of one
variable in a span.
"""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from verifier.fidelity.shooting.samples import edges, measured_states, turned
from verifier.fidelity.stretches.segments import on_circle
from verifier.fidelity.switching.setting import Setting, run

FITS = 3
NUDGE = 1e-5
"""The difference for derivatives, as a share of the domain."""
PRIOR = 0.1
"""The raw sample is known to at least this share of the domain: keeps the fit well posed."""
DRIFT = 10.0
"""A drift may carry a state so many tolerances away within a horizon."""
FLOOR = 1e-7
"""Noise is taken to be at least this share of the domain."""
LEAST = 2
"""So many samples of every variable make a fit."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Fit:
    """Starts (K, n) at the knots `first` (K,), in `modes` (K,), with covariances (K, D, D).

    is_good (K,): whether there were samples enough.
    """

    start: Array
    first: Integers
    modes: Array
    covariance: Array
    is_good: Booleans


def fitted(setting: Setting, first: Integers, spans: Array, at: Array, modes: Array) -> Fit:
    """The fits of starts at the knots `first` (K,) to the samples within `spans` (K, 2).

    at (K,): the time beside the switch, at which no drift has acted.
    """
    chosen = [_chosen(each.times, spans) for each in setting.samples]
    is_good = np.all([used.sum(axis=1) >= LEAST for _, used in chosen], axis=0)
    knots = [s.knots[index] for s, (index, _) in zip(setting.samples, chosen, strict=True)]
    ends = [
        np.max(np.where(used, knot, first[:, None]), axis=1)
        for knot, (_, used) in zip(knots, chosen, strict=True)
    ]
    path = knots_between(first, np.max(ends, axis=0))
    start = _raw(setting, first, spans)
    for _ in range(FITS):
        around = _fan(setting, start, path, modes)
        start, covariance = _improved(setting, start, around, (path, at, chosen))
    return Fit(start, first, modes, covariance, np.asarray(is_good))


def knots_between(first: Integers, last: Integers) -> Integers:
    """The knots (K, S + 1) from first to last (K,); the last one is repeated."""
    steps = int(np.max(last - first, initial=1))
    knots = first[:, None] + np.arange(steps + 1)
    return np.asarray(np.minimum(knots, np.maximum(last, first)[:, None]))


def fan(setting: Setting, fit: Fit, knots: Integers) -> tuple[Array, Array]:
    """Paths (1 + D, K, S + 1, n): from the fitted start, and from D nudged ones; nudges (K, D)."""
    return _fan(setting, fit.start, knots, fit.modes)


def _raw(setting: Setting, first: Integers, spans: Array) -> Array:
    """The measured states at the beginning of each span, with inputs as held at `first`."""
    start = measured_states(setting.model, setting.samples, first)
    for each in setting.samples:
        at = np.searchsorted(each.times, spans[:, 0] - 1e-9)
        value = each.values[np.minimum(at, len(each.times) - 1)]
        start[:, each.column] = on_circle(each.state, np.clip(value, *edges(each)))
    return start


def _chosen(times: Array, spans: Array) -> tuple[Integers, Booleans]:
    """The samples (K, m) within each span, real where used."""
    start = np.searchsorted(times, spans[:, 0] - 1e-9)
    stop = np.searchsorted(times, spans[:, 1] + 1e-9, side="right")
    index = start[:, None] + np.arange(int(np.max(stop - start, initial=1)))
    return np.minimum(index, len(times) - 1), index < stop[:, None]


def _fan(setting: Setting, start: Array, knots: Integers, modes: Array) -> tuple[Array, Array]:
    count = len(setting.samples) + 1
    middle = np.array([(s.state.low + s.state.high) / 2.0 for s in setting.samples])
    side = np.where(start[:, setting.columns] > middle, -1.0, 1.0)
    nudge = NUDGE * _widths(setting) * side
    copies = np.tile(start, (count, 1, 1))
    for i, column in enumerate(setting.columns):
        copies[i + 1, :, column] += nudge[:, i]
    flat = copies.reshape(-1, start.shape[1])
    paths = run(setting, flat, np.tile(knots, (count, 1)), np.tile(modes, count))
    return paths.reshape(count, len(start), -1, start.shape[1]), nudge


def _improved(
    setting: Setting,
    start: Array,
    around: tuple[Array, Array],
    where: tuple[Integers, Array, list[tuple[Integers, Booleans]]],
) -> tuple[Array, Array]:
    """One Gauss-Newton step: the start (K, n) and its covariance (K, D, D).

    The drift acts linearly, so that each step finds it anew. around: the paths from the start and
    from nudged ones, with the nudges. where: the knots of the paths, the times without drift, and
    the samples.
    """
    (paths, nudge), (knots, at, chosen) = around, where
    widths, size, rows = _widths(setting), len(setting.samples), np.arange(len(start))[:, None]
    steepest = DRIFT * np.minimum(setting.tolerance, widths) / setting.horizon
    known = np.concatenate([PRIOR * widths, steepest]) ** -2.0
    normal = np.tile(np.diag(known), (len(start), 1, 1))
    gradient = np.zeros((len(start), 2 * size))
    weights = np.maximum(setting.sigma, FLOOR * widths) ** -2.0
    for j, (each, (index, used)) in enumerate(zip(setting.samples, chosen, strict=True)):
        step = np.clip(each.knots[index] - knots[:, :1], 0, paths.shape[2] - 1)
        predicted = paths[:, rows, step, each.column]
        ahead = each.times[index] - at[:, None]
        slope = np.zeros((2 * size, *index.shape))
        slope[:size] = (predicted[1:] - predicted[0]) / nudge.T[:, :, None]
        slope[size + j] = ahead
        slope = np.where(used, np.nan_to_num(slope), 0.0)
        error = turned(each.values[index] - predicted[0], each.turn)
        error = np.where(used, np.nan_to_num(error), 0.0)
        normal += weights[j] * np.einsum("ikm,jkm->kij", slope, slope)
        gradient += weights[j] * np.einsum("ikm,km->ki", slope, error)
    covariance = np.linalg.inv(normal).astype(np.float64)
    change = np.einsum("kij,kj->ki", covariance, gradient)
    moved = np.array(start)
    for j, each in enumerate(setting.samples):
        moved[:, each.column] = np.clip(moved[:, each.column] + change[:, j], *edges(each))
    return moved, covariance[:, :size, :size]


def _widths(setting: Setting) -> Array:
    return np.array([each.state.high - each.state.low for each in setting.samples])

"""Multiple shooting: each window's start is estimated, not read off one noisy sample.

The start state of a window is the weighted least-squares fit of the model itself to the samples
in the short span around the window's start (Gauss-Newton, with sensitivities of the flow by
differences). Its covariance is carried to the horizon, so the noise's share of every error is
known: e = mean(n) - Phi (estimate - truth), hence var e = sigma^2 / m + Phi P Phi'.

Letters: W windows, n states, D predicted states, m samples in a span, Phi (D, D) the sensitivity
to the start, P (D, D) the covariance of the start estimate.
"""

from dataclasses import dataclass, fields
from typing import final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from verifier.fidelity.shooting.grid import early_inputs
from verifier.fidelity.shooting.noise import averaged
from verifier.fidelity.shooting.plan import Plan
from verifier.fidelity.shooting.prediction import Model, chunks, predict
from verifier.fidelity.shooting.samples import Samples, edges, measured_states, turned
from verifier.fidelity.shooting.windows import Chosen, chosen_samples, closest
from verifier.report.report import Noise

NUDGE = 1e-5
"""The difference for sensitivities, as a share of the domain."""
FLOOR = 1e-7
"""Noise is taken to be at least this share of the domain when samples are weighed."""
PRIOR = 0.1
"""The raw sample is known to at least this share of the domain: keeps the fit well posed."""
FITS = 2
EARLY = 0.05
"""By this share of the horizon inputs are moved, to see what a late one does."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Errors:
    """Errors of one variable after one horizon, per window (W,); NaN where there is none.

    plain: measured minus predicted of the one sample nearest to the horizon. mean: averaged over
    the span around it. variance: of `mean`, from measurement noise; `carried` is the part of it
    that came by way of the start, which is itself known with the variance `unsure`. moved: how
    far the variable was predicted to move. hurried: how much farther it would have moved had its
    inputs come a twentieth of the horizon earlier; without inputs that change, by how much it was
    predicted to move farther in the last twentieth of the horizon than in the first.
    """

    plain: Array
    mean: Array
    variance: Array
    carried: Array
    unsure: Array
    moved: Array
    hurried: Array

    def part(self, part: Booleans) -> "Errors":
        """Of some of the windows (W,)."""
        return Errors(*(getattr(self, each.name)[part] for each in fields(self)))


@final
@dataclass(frozen=True, eq=False, slots=True)
class Shots:
    """All windows, shot: `start` (W, n) at each window's first knot, `errors[horizon][variable]`.

    is_lost (W,): the prediction left the domain.
    """

    start: Array
    is_lost: Booleans
    errors: tuple[tuple[Errors, ...], ...]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Fit:
    """Start states (W, n) at the first knots; covariance (W, D, D) of the predicted ones."""

    start: Array
    covariance: Array


def shoot(plan: Plan, noise: tuple[Noise, ...]) -> Shots:
    """The errors of all windows at each horizon."""
    windows = plan.windows
    parts = [
        _shoot(plan.part(part), noise)
        for part in chunks(plan.model, windows.first, windows.last, len(plan.samples) + 1)
    ]
    errors = tuple(
        tuple(_joined([p.errors[h][j] for p in parts]) for j in range(len(plan.samples)))
        for h in range(len(plan.horizons))
    )
    start = np.concatenate([p.start for p in parts])
    return Shots(start, np.concatenate([p.is_lost for p in parts]), errors)


def _joined(parts: list[Errors]) -> Errors:
    names = [each.name for each in fields(Errors)]
    return Errors(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def _shoot(plan: Plan, noise: tuple[Noise, ...]) -> Shots:
    fit = _fitted(plan, noise)
    paths = _perturbed(plan, fit.start, plan.windows.last)
    is_lost = ~np.all(np.isfinite(paths), axis=(0, 2, 3))
    early = _early(plan, fit.start)
    errors = tuple(
        tuple(_errors(plan, (paths, early), fit, noise, (j, h)) for j in range(len(plan.samples)))
        for h in plan.horizons
    )
    return Shots(fit.start, is_lost, errors)


def _fitted(plan: Plan, noise: tuple[Noise, ...]) -> Fit:
    """The start states that fit the samples around the start best."""
    around = tuple(chosen_samples(each, plan.windows, 0.0) for each in plan.samples)
    knots = [np.max(s.knots[c.index], axis=1) for s, c in zip(plan.samples, around, strict=True)]
    end = np.max(knots, axis=0)
    start = measured_states(plan.model, plan.samples, plan.windows.first)
    fit = Fit(start, np.empty(0))
    for _ in range(FITS):
        paths = _perturbed(plan, fit.start, end)
        fit = _improved(plan, paths, around, fit.start, noise)
    return fit


def _improved(
    plan: Plan, paths: Array, around: tuple[Chosen, ...], start: Array, noise: tuple[Noise, ...]
) -> Fit:
    """One Gauss-Newton step from `start`."""
    widths = _widths(plan.samples)
    normal = np.tile(np.diag((PRIOR * widths) ** -2.0), (len(start), 1, 1))
    gradient = np.zeros((len(start), len(plan.samples)))
    deviation = [_deviation(n, chosen) for n, chosen in zip(noise, around, strict=True)]
    weights = np.maximum(deviation, FLOOR * widths) ** -2.0
    for j, (each, chosen) in enumerate(zip(plan.samples, around, strict=True)):
        at = _at(plan, paths, chosen, j)
        slope = np.where(chosen.used, np.nan_to_num(at[1:]), 0.0)
        residual = np.nan_to_num(_residuals(at[0], each, chosen))
        normal += weights[j] * np.einsum("iwm,kwm->wik", slope, slope)
        gradient += weights[j] * np.einsum("iwm,wm->wi", slope, residual)
    covariance = np.linalg.inv(normal).astype(np.float64)
    step = np.einsum("wik,wk->wi", covariance, gradient)
    moved = np.array(start)
    for j, each in enumerate(plan.samples):
        moved[:, each.column] = np.clip(moved[:, each.column] + step[:, j], *edges(each))
    return Fit(moved, covariance)


def _deviation(noise: Noise, chosen: Chosen) -> float:
    """The noise that as many independent samples as are chosen would need for the same mean."""
    count = np.atleast_1d(np.median(chosen.used.sum(axis=1)))
    return float(np.sqrt(averaged(noise, count)[0] * count[0]))


def _perturbed(plan: Plan, start: Array, last: Integers) -> Array:
    """The prediction and, per predicted state, its derivative by the start: (1 + D, W, S + 1, D).

    Entry [0] is the prediction itself, entry [1 + i, ..., j] is d x_j / d start_i.
    """
    columns = [each.column for each in plan.samples]
    count = len(columns) + 1
    # Nudge towards the middle of the domain, so that a start at its edge does not leave it.
    middle = np.array([(each.state.low + each.state.high) / 2.0 for each in plan.samples])
    nudge = NUDGE * _widths(plan.samples) * np.where(start[:, columns] > middle, -1.0, 1.0)
    copies = np.tile(start, (count, 1, 1))
    for i, column in enumerate(columns):
        copies[i + 1, :, column] += nudge[:, i]
    flat = copies.reshape(-1, plan.model.states)
    paths = predict(plan.model, flat, np.tile(plan.windows.first, count), np.tile(last, count))
    paths = paths.reshape(count, len(start), -1, plan.model.states)[..., columns]
    slopes = (paths[1:] - paths[:1]) / nudge.T[:, :, None, None]
    return np.concatenate([paths[:1], slopes])


def _widths(samples: tuple[Samples, ...]) -> Array:
    return np.array([each.state.high - each.state.low for each in samples])


def _at(plan: Plan, paths: Array, chosen: Chosen, j: int) -> Array:
    """Variable j of paths (K, W, S + 1, D) at the chosen samples: (K, W, m)."""
    step = plan.samples[j].knots[chosen.index] - plan.windows.first[:, None]
    step = np.clip(step, 0, paths.shape[2] - 1)
    return np.asarray(paths[:, np.arange(len(step))[:, None], step, j])


def _at_start(plan: Plan, paths: Array, j: int) -> Array:
    """Variable j as predicted at each window's start (W,), which is not its first knot."""
    chosen = chosen_samples(plan.samples[j], plan.windows, 0.0)
    one = closest(plan.samples[j], chosen, plan.windows.times)
    return np.asarray(_at(plan, paths[:1], chosen, j)[0, np.arange(len(one)), one])


def _residuals(predicted: Array, samples: Samples, chosen: Chosen) -> Array:
    """Measured minus predicted (W, m), 0 where no sample is chosen."""
    difference = turned(samples.values[chosen.index] - predicted, samples.turn)
    return np.where(chosen.used, difference, 0.0)


def _errors(
    plan: Plan,
    every: tuple[Array, Array | None],
    fit: Fit,
    noise: tuple[Noise, ...],
    which: tuple[int, float],
) -> Errors:
    """The errors of variable j after a horizon, `which` = (j, horizon).

    every: the predictions with their derivatives, and those from early inputs.
    """
    (paths, early), (j, horizon) = every, which
    chosen = chosen_samples(plan.samples[j], plan.windows, horizon)
    at = _at(plan, paths, chosen, j)
    residual = _residuals(at[0], plan.samples[j], chosen)
    count = np.maximum(chosen.used.sum(axis=1), 1)
    share = chosen.used / count[:, None]
    slope = np.einsum("iwm,wm->wi", np.where(chosen.used, at[1:], 0.0), share)
    of_start = np.einsum("wi,wik,wk->w", slope, fit.covariance, slope)
    rows = np.arange(len(count))
    one = closest(plan.samples[j], chosen, plan.windows.times + horizon)
    absent = np.where(np.any(chosen.used, axis=1), 0.0, np.nan)
    return Errors(
        plain=residual[rows, one] + absent,
        mean=np.sum(residual * share, axis=1) + absent,
        variance=averaged(noise[j], count) + of_start + absent,
        carried=of_start + absent,
        unsure=fit.covariance[:, j, j] + absent,
        moved=at[0][rows, one] - _at_start(plan, paths, j) + absent,
        hurried=_hurried(plan, paths[0, ..., j], early if early is None else early[..., j], horizon)
        + absent,
    )


def _early(plan: Plan, start: Array) -> Array | None:
    """The predictions (W, S + 1, D) if all inputs came early; None where no input changes."""
    mode, seconds = plan.model.flow.program.field.mode, EARLY * plan.windows.horizon
    grid = early_inputs(plan.model.grid, plan.needs, mode, seconds)
    if grid is None:
        return None
    paths = predict(Model(plan.model.flow, grid), start, plan.windows.first, plan.windows.last)
    return paths[..., [each.column for each in plan.samples]]


def _hurried(plan: Plan, path: Array, early: Array | None, horizon: float) -> Array:
    """What being early does to a variable, from its prediction and the one from early inputs.

    path, early: (W, S + 1) from each window's first knot.
    """
    knots, first, length = plan.model.grid.times, plan.windows.first, path.shape[1]
    moments = []
    for share in (0.0, EARLY, 1.0 - EARLY, 1.0):
        there = np.searchsorted(knots, plan.windows.times + share * horizon * (1.0 - 1e-9))
        moments.append(np.clip(there - first, 0, length - 1))
    rows = np.arange(len(path))
    if early is not None:
        return np.asarray(early[rows, moments[-1]] - path[rows, moments[-1]])
    begin, soon, late, end = (path[rows, step] for step in moments)
    return np.asarray((end - late) - (soon - begin))

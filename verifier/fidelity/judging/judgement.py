"""Each judged variable against its tolerance."""

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.program import Fidelity, Program
from verifier.fidelity.judging.departure import (
    Departure,
    blocks_of,
    departure_of,
    mean_of,
    standing_of,
)
from verifier.fidelity.judging.regions import region_means, worst_of
from verifier.fidelity.shooting.prediction import predict
from verifier.fidelity.shooting.samples import turned
from verifier.fidelity.shooting.shooting import Errors
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.needs import parts_of
from verifier.fidelity.stretches.segments import on_circle
from verifier.report.report import (
    CellAxis,
    HorizonFigure,
    Interval,
    Noise,
    RegionMean,
    Standing,
    VariableResult,
    WindowView,
)

VIEWS = 24
"""At most so many windows are kept for drawing."""
QUANTISED_DOUBT = 0.3
"""Relative doubt in the variance of a sensor whose rounding is its noise: it is not white."""


def results_of(
    program: Program, fidelity: Fidelity, study: Study, axes: tuple[CellAxis, ...]
) -> tuple[VariableResult, ...]:
    """The judgement of every driven state that has a tolerance."""
    places = places_of(program, study)
    where = np.stack([places[axis.name] for axis in axes], axis=-1)
    judged = {each.state.name for each in study.plan.samples}
    assert judged >= fidelity.tolerance.keys(), "only driven states have a tolerance"
    return tuple(
        _result(study, j, fidelity.tolerance[each.state.name], axes, where)
        for j, each in enumerate(study.plan.samples)
        if each.state.name in fidelity.tolerance
    )


def places_of(program: Program, study: Study) -> dict[str, Array]:
    """Where each window ran (W,): the measured start of a state, the mean of an input."""
    places = {}
    for name in parts_of(program):
        assumed = study.plan.model.flow.defaults[program.register.index(name)]
        places[name] = np.full(len(study.plan.windows.times), assumed)
    for each in study.plan.samples:
        start = np.interp(study.plan.windows.times, each.times, each.values)
        places[each.state.name] = on_circle(each.state, start)
    for column, given in enumerate(study.plan.needs.inputs):
        places[given.name] = _means(study, study.plan.model.grid.inputs[:, column])
    return places


def _means(study: Study, values: Array) -> Array:
    """The time average (W,) over each window of values held from knot to knot (G,)."""
    times, windows = study.plan.model.grid.times, study.plan.windows
    area = np.concatenate([[0.0], np.cumsum(values[:-1] * np.diff(times))])
    span = times[windows.last] - times[windows.first]
    return np.asarray((area[windows.last] - area[windows.first]) / np.maximum(span, 1e-300))


def _result(
    study: Study, j: int, tolerance: float, axes: tuple[CellAxis, ...], where: Array
) -> VariableResult:
    samples, noise = study.plan.samples[j], study.noise[j]
    figures = tuple(
        _figure(horizon, _departure(study, study.shots.errors[h][j], noise), tolerance)
        for h, horizon in enumerate(study.plan.horizons)
    )
    errors = study.shots.errors[-1][j]
    kept = _kept(study, errors)
    blocks = blocks_of(errors.mean[kept] ** 2) if np.any(kept) else np.zeros(0, np.int64)
    mean, interval = _mean(errors.mean[kept], blocks)
    regions = region_means(axes, where[kept], errors.mean[kept], blocks, tolerance)
    return VariableResult(
        name=samples.state.name,
        unit=samples.state.unit,
        period=samples.turn,
        tolerance=tolerance,
        standing=_standing(figures[-1], regions),
        noise=noise,
        horizons=figures,
        mean=mean,
        mean_interval=interval,
        regions=regions,
        worst=worst_of(regions),
        errors=errors.plain,
        views=_views(study, j, kept),
        origin=samples.state.origin,
    )


def _kept(study: Study, errors: Errors) -> Booleans:
    return np.asarray(np.isfinite(errors.mean) & ~study.shots.is_lost)


def _departure(study: Study, errors: Errors, noise: Noise) -> Departure:
    kept = _kept(study, errors)
    # The variance of a mean of squared second differences of white noise: 2 * 1.94 / N.
    doubt = float(np.sqrt(3.9 / max(noise.samples, 1)))
    if noise.quantum > 0.0:
        doubt = float(np.hypot(doubt, QUANTISED_DOUBT))
    return departure_of(errors.plain[kept], errors.mean[kept], errors.variance[kept], doubt)


def _figure(horizon: float, found: Departure, tolerance: float) -> HorizonFigure:
    return HorizonFigure(
        horizon=horizon,
        windows=found.windows,
        rmse=found.rmse,
        departure=found.departure,
        interval=found.interval,
        tolerance=tolerance,
        standing=standing_of(found.interval, tolerance),
    )


def _mean(errors: Array, blocks: Integers) -> tuple[float, Interval]:
    if len(errors) == 0:
        return 0.0, Interval(-np.inf, np.inf)
    return mean_of(errors, blocks)


def _standing(declared: HorizonFigure, regions: tuple[RegionMean, ...]) -> Standing:
    """A part of the region that exceeds the tolerance on its own exceeds it for the whole."""
    if any(region.standing is Standing.EXCEEDED for region in regions):
        return Standing.EXCEEDED
    return declared.standing


def _views(study: Study, j: int, kept: Booleans) -> tuple[WindowView, ...]:
    """Windows spread over the trace, those with the largest errors among them."""
    errors = study.shots.errors[-1][j]
    able = np.flatnonzero(kept)
    if len(able) == 0:
        return ()
    spread = able[np.unique(np.linspace(0, len(able) - 1, VIEWS - VIEWS // 4).astype(np.int64))]
    largest = able[np.argsort(-np.abs(errors.mean[able]), kind="stable")[: VIEWS // 4]]
    chosen = np.unique(np.concatenate([spread, largest]))
    windows, samples = study.plan.windows, study.plan.samples[j]
    first, last = windows.first[chosen], windows.last[chosen]
    paths = predict(study.plan.model, study.shots.start[chosen], first, last)[..., samples.column]
    views = []
    for row, (a, b) in enumerate(zip(first, last, strict=True)):
        here = np.flatnonzero((samples.knots >= a) & (samples.knots <= b))
        predicted = paths[row, samples.knots[here] - a]
        measured = predicted + turned(samples.values[here] - predicted, samples.turn)
        views.append(WindowView(samples.times[here], measured, predicted))
    return tuple(views)

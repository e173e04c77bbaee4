"""Each judged variable against its tolerance."""

from dataclasses import replace

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.program import Fidelity, Kind, Program
from verifier.fidelity.judging.departure import Departure, departure_of, standing_of
from verifier.fidelity.judging.part_means import PartMean
from verifier.fidelity.judging.parts import Condition
from verifier.fidelity.judging.standing import judge_errors
from verifier.fidelity.shooting.prediction import predict
from verifier.fidelity.shooting.samples import turned
from verifier.fidelity.shooting.shooting import Errors
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.needs import names_read, parts_of
from verifier.fidelity.stretches.segments import on_circle
from verifier.report.report import (
    HorizonFigure,
    Noise,
    RegionMean,
    VariableResult,
    WindowView,
)

VIEWS = 24
"""At most so many windows are kept for drawing."""
QUANTISED_DOUBT = 0.3
"""Relative doubt in the variance of a sensor whose rounding is its noise: it is not white."""


def results_of(program: Program, fidelity: Fidelity, study: Study) -> tuple[VariableResult, ...]:
    """The judgement of every driven state that has a tolerance."""
    conditions = _conditions(program, study, places_of(program, study))
    judged = {each.state.name for each in study.plan.samples}
    assert judged >= fidelity.tolerance.keys(), "only driven states have a tolerance"
    return tuple(
        _result(study, j, fidelity, conditions)
        for j, each in enumerate(study.plan.samples)
        if each.state.name in fidelity.tolerance
    )


def places_of(program: Program, study: Study) -> dict[str, Array]:
    """Where each window ran (W,): the measured start of a state, the mean of an input.

    Of a discrete input, its value at the start.
    """
    places = {}
    for name in parts_of(program):
        assumed = study.plan.model.flow.defaults[program.register.index(name)]
        places[name] = np.full(len(study.plan.windows.times), assumed)
    for each in study.plan.samples:
        start = np.interp(study.plan.windows.times, each.times, each.values)
        places[each.state.name] = on_circle(each.state, start)
    discrete = {state.name for state in program.states if state.kind is Kind.DISCRETE}
    for column, given in enumerate(study.plan.needs.inputs):
        values = study.plan.model.grid.inputs[:, column]
        is_discrete = given.name in discrete
        places[given.name] = _at_starts(study, values) if is_discrete else _means(study, values)
    return places


def _at_starts(study: Study, values: Array) -> Array:
    """What holds (W,) at each window's start: a mean of modes is none."""
    starts = np.searchsorted(study.plan.model.grid.times, study.plan.windows.times, side="right")
    return np.asarray(values[starts - 1])


def _means(study: Study, values: Array) -> Array:
    """The time average (W,) over each window of values held from knot to knot (G,)."""
    times, windows = study.plan.model.grid.times, study.plan.windows
    area = np.concatenate([[0.0], np.cumsum(values[:-1] * np.diff(times))])
    span = times[windows.last] - times[windows.first]
    return np.asarray((area[windows.last] - area[windows.first]) / np.maximum(span, 1e-300))


def _conditions(program: Program, study: Study, places: dict[str, Array]) -> tuple[Condition, ...]:
    """What the field reads, and where each window had it: parts are told apart by these."""
    read = names_read(program)
    discrete = {state.name for state in program.states if state.kind is Kind.DISCRETE}
    turns = {each.state.name: each.turn for each in study.plan.samples}
    samples = zip(study.plan.samples, study.noise, strict=True)
    sigmas = {each.state.name: noise.sigma for each, noise in samples}
    return tuple(
        Condition(
            name,
            _settled(study, name) if name in discrete else values,
            is_discrete=name in discrete,
            turn=turns.get(name, 0.0),
            noise=sigmas.get(name, 0.0),
        )
        for name, values in places.items()
        if name in read
    )


def _settled(study: Study, name: str) -> Array:
    """A discrete input at the start of each window (W,)."""
    names = [given.name for given in study.plan.needs.inputs]
    if name not in names:
        return np.zeros(len(study.plan.windows.times))
    inputs = study.plan.model.grid.inputs
    return np.asarray(inputs[study.plan.windows.first, names.index(name)])


def _result(
    study: Study, j: int, fidelity: Fidelity, conditions: tuple[Condition, ...]
) -> VariableResult:
    samples, noise = study.plan.samples[j], study.noise[j]
    name = samples.state.name
    tolerance, scatter = fidelity.tolerance[name], fidelity.scatter.get(name, 0.0)
    every = [errors[j] for errors in study.shots.errors]
    figures = tuple(
        _figure(horizon, _departure(study, errors, noise), _carried(study, errors), tolerance)
        for horizon, errors in zip(study.plan.horizons, every, strict=True)
    )
    kept = _kept(study, every[-1])
    own = tuple(replace(each, values=each.values[kept]) for each in conditions)
    judged = judge_errors(every[-1].part(kept), own, figures[-1].interval, (tolerance, scatter))
    program = study.plan.model.flow.program
    named = {s.name: s.values for s in program.states if s.kind is Kind.DISCRETE}
    regions = tuple(_region(mean, named) for mean in judged.parts.means)
    return VariableResult(
        name=name,
        unit=samples.state.unit,
        period=samples.turn,
        tolerance=tolerance,
        standing=judged.standing,
        noise=noise,
        horizons=figures,
        systematic=judged.systematic,
        scatter=judged.parts.scatter,
        allowed_scatter=scatter,
        unjudged=judged.parts.unjudged,
        mean=judged.mean,
        mean_interval=judged.mean_interval,
        regions=regions,
        worst=_worst(regions),
        errors=every[-1].plain,
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


def _carried(study: Study, errors: Errors) -> float:
    """The root mean square of what the noise of the sensors makes of an error."""
    variance = errors.variance[_kept(study, errors)]
    return float(np.sqrt(np.mean(variance))) if len(variance) else 0.0


def _figure(horizon: float, found: Departure, noise: float, tolerance: float) -> HorizonFigure:
    return HorizonFigure(
        horizon=horizon,
        windows=found.windows,
        rmse=found.rmse,
        noise=noise,
        departure=found.departure,
        interval=found.interval,
        tolerance=tolerance,
        standing=standing_of(found.interval, tolerance),
    )


def _region(found: PartMean, named: dict[str, tuple[str, ...]]) -> RegionMean:
    """The mean as the report tells it; `named`: the values of the discrete states."""
    bounds = found.part.bounds
    return RegionMean(
        bounds={name: ends for name, ends in bounds.items() if name not in named},
        values={name: named[name][int(low)] for name, (low, _) in bounds.items() if name in named},
        moved=found.moved,
        hurried=found.hurried,
        windows=int(np.sum(found.part.members)),
        mean=found.mean,
        interval=found.interval,
        standing=found.standing,
    )


def _worst(regions: tuple[RegionMean, ...]) -> RegionMean | None:
    """The part that departs most surely: the one whose interval stays furthest from zero.

    Where every interval holds zero, the one with the largest mean.
    """
    return max(
        regions,
        key=lambda r: (max(r.interval.low, -r.interval.high, 0.0), abs(r.mean)),
        default=None,
    )


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

"""Each judged variable against its tolerance."""

from dataclasses import replace

import numpy as np

from runtime.arrays import Array
from runtime.program import Fidelity, Kind
from verifier.fidelity.judging.departure import Departure, departure_of, standing_of
from verifier.fidelity.judging.evidence import Evidence, noise_of_all
from verifier.fidelity.judging.part_means import PartMean
from verifier.fidelity.judging.standing import judge_errors
from verifier.fidelity.shooting.shooting import Errors
from verifier.report.report import HorizonFigure, Noise, RegionMean, VariableResult

QUANTISED_DOUBT = 0.3
"""Relative doubt in the variance of a sensor whose rounding is its noise: it is not white."""


def results_of(fidelity: Fidelity, evidence: Evidence) -> tuple[VariableResult, ...]:
    """The judgement of every driven state that has a tolerance."""
    names = [state.name for state in evidence.states]
    assert set(names) >= fidelity.tolerance.keys(), "only driven states have a tolerance"
    return tuple(
        _result(evidence, j, fidelity) for j, name in enumerate(names) if name in fidelity.tolerance
    )


def _result(evidence: Evidence, j: int, fidelity: Fidelity) -> VariableResult:
    state = evidence.states[j]
    name = state.name
    tolerance, scatter = fidelity.tolerance[name], fidelity.scatter.get(name, 0.0)
    every = [errors[j] for errors in evidence.errors]
    figures = tuple(
        _figure(horizon, _departure(evidence, errors, j), _carried(evidence, errors), tolerance)
        for horizon, errors in zip(evidence.horizons, every, strict=True)
    )
    kept = evidence.kept(every[-1])
    own = tuple(replace(each, values=each.values[kept]) for each in evidence.conditions)
    judged = judge_errors(
        every[-1].part(kept),
        own,
        figures[-1].interval,
        (tolerance, scatter),
        evidence.runs[kept],
    )
    named = {s.name: s.values for s in evidence.program.states if s.kind is Kind.DISCRETE}
    regions = tuple(_region(mean, named) for mean in judged.parts.means)
    return VariableResult(
        name=name,
        unit=state.unit,
        period=evidence.turns[j],
        tolerance=tolerance,
        standing=judged.standing,
        noise=noise_of_all(evidence, j),
        horizons=figures,
        systematic=judged.systematic,
        scatter=judged.parts.scatter,
        allowed_scatter=scatter,
        unjudged=judged.parts.unjudged,
        moved=_moved(every[-1].mean[kept] + every[-1].moved[kept]),
        mean=judged.mean,
        mean_interval=judged.mean_interval,
        regions=regions,
        worst=_worst(regions),
        errors=every[-1].plain,
        views=evidence.views[j],
        origin=state.origin,
    )


def _moved(ways: Array) -> float:
    """The root mean square of how far it moved (W,); nothing is known where it was not seen."""
    return float(np.sqrt(np.mean(ways**2))) if ways.size else float("inf")


def _departure(evidence: Evidence, errors: Errors, j: int) -> Departure:
    kept = evidence.kept(errors)
    doubt = _noise_doubt(evidence, errors, j)
    mean, variance = errors.mean[kept], errors.variance[kept]
    return departure_of(errors.plain[kept], mean, variance, doubt, evidence.runs[kept])


def _noise_doubt(evidence: Evidence, errors: Errors, j: int) -> float:
    """The relative standard error of the noise's share of the mean square.

    Chance averages out over recordings, but not what rounding is taken for.
    """
    kept = evidence.kept(errors)
    noises = [noise[j] for noise in evidence.noise]
    sums = np.bincount(evidence.runs[kept], errors.variance[kept], len(noises))
    shares = sums / sums.sum() if sums.sum() > 0.0 else np.full(len(noises), 1.0 / len(noises))
    chance = float(np.sqrt(np.sum((shares * [_chance(noise) for noise in noises]) ** 2)))
    quantised = float(np.sum(shares * [noise.quantum > 0.0 for noise in noises]))
    return float(np.hypot(chance, QUANTISED_DOUBT * quantised))


def _chance(noise: Noise) -> float:
    """The variance of a mean of squared second differences of white noise is 2 * 1.94 / N."""
    return float(np.sqrt(3.9 / max(noise.samples, 1)))


def _carried(evidence: Evidence, errors: Errors) -> float:
    """The root mean square of what the noise of the sensors makes of an error."""
    variance = errors.variance[evidence.kept(errors)]
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

"""The scores of a trace against its spec: measured and predicted, laid end to end.

What is compared is what the verdict compares: predictions of one horizon each, from starts that
were fitted to the trace, under the measured inputs; windows that overlap are left out.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array, Integers
from verifier.fidelity.shooting.prediction import chunks, predict
from verifier.fidelity.shooting.samples import Samples, turned
from verifier.fidelity.shooting.study import Study
from verifier.report.report import Report, Standing
from verifier.report.scores import IsoRating, Scores, VariableScores
from verifier.scores.iso18571 import iso_rating

MOST: Final = 1000
"""Longer signals are thinned to so many points for the ISO rating, whose cost is quadratic."""
FINE: Final = 0.8
"""What ISO/TS 18571 grades as good begins here (excellent: 0.94)."""
WARNING: Final = (
    "These scores are for comparison only. They rate how alike two curves look: they know no"
    " tolerance and no noise, and stay high for a robot that is plainly wrong."
)


def scores_of(study: Study, report: Report) -> Scores:
    """The scores of every variable that `report` judges."""
    chosen = _end_to_end(study)
    judged = {result.name for result in report.variables}
    found = tuple(
        _scored(study, chosen, each) for each in study.plan.samples if each.state.name in judged
    )
    return Scores(found, (WARNING, *_contradictions(found, report)))


def _end_to_end(study: Study) -> Integers:
    """Windows (K,) that do not overlap and whose prediction stayed in the domain."""
    times, horizon = study.plan.windows.times, study.plan.windows.horizon
    chosen: list[int] = []
    free_from = -np.inf
    for k in np.flatnonzero(~study.shots.is_lost):
        if times[k] >= free_from - 1e-6 * horizon:
            chosen.append(int(k))
            free_from = times[k] + horizon
    return np.array(chosen, np.int64)


def _scored(study: Study, chosen: Integers, samples: Samples) -> VariableScores:
    measured, predicted = _curves(study, chosen, samples)
    name, count = samples.state.name, len(measured)
    if count < 2 or np.ptp(measured) == 0.0:
        return VariableScores(name, count, None, np.nan, np.nan)
    error = measured - predicted
    spread = measured - measured.mean()
    return VariableScores(
        name=name,
        samples=count,
        iso=_rated(measured, predicted),
        nrmse=float(np.sqrt(np.mean(error**2)) / np.ptp(measured)),
        r_squared=float(1.0 - np.dot(error, error) / np.dot(spread, spread)),
    )


def _rated(measured: Array, predicted: Array) -> IsoRating | None:
    every = -(-len(measured) // MOST)
    return iso_rating(measured[::every], predicted[::every])


def _curves(study: Study, chosen: Integers, samples: Samples) -> tuple[Array, Array]:
    """Measured and predicted (N,) at the samples inside the windows, in order of time."""
    windows, model = study.plan.windows, study.plan.model
    measured, predicted = [np.zeros(0)], [np.zeros(0)]
    for part in chunks(model, windows.first[chosen], windows.last[chosen], 1):
        rows = chosen[part]
        first, last = windows.first[rows], windows.last[rows]
        paths = predict(model, study.shots.start[rows], first, last)[..., samples.column]
        ends = windows.times[rows] + windows.horizon
        low = np.searchsorted(samples.times, windows.times[rows])
        high = np.searchsorted(samples.times, ends)
        for row, (a, b) in enumerate(zip(low, high, strict=True)):
            here = np.arange(a, b)
            here = here[(samples.knots[here] >= first[row]) & (samples.knots[here] <= last[row])]
            at = paths[row, samples.knots[here] - first[row]]
            values = samples.values[here]
            measured.append(values)
            predicted.append(values - turned(values - at, samples.turn))
    return np.concatenate(measured), np.concatenate(predicted)


def _contradictions(found: tuple[VariableScores, ...], report: Report) -> tuple[str, ...]:
    """Where a good score stands beside a variable that exceeds its tolerance."""
    exceeded = {r.name for r in report.variables if r.standing is Standing.EXCEEDED}
    return tuple(
        f"{each.name} exceeds its tolerance, and yet scores {each.iso.overall:.2f} of 1 by"
        f" ISO/TS 18571, with R² {each.r_squared:.2f}."
        for each in found
        if each.name in exceeded and each.iso is not None and each.iso.overall >= FINE
    )

"""A few windows for drawing: what was measured, and what was predicted."""

import numpy as np

from verifier.fidelity.shooting.prediction import predict
from verifier.fidelity.shooting.samples import turned
from verifier.fidelity.shooting.study import Study
from verifier.report.report import WindowView

VIEWS = 24
"""At most so many windows are kept for drawing."""


def views_of(study: Study, j: int) -> tuple[WindowView, ...]:
    """Windows of state j spread over the trace, those with the largest errors among them."""
    errors = study.shots.errors[-1][j]
    able = np.flatnonzero(np.isfinite(errors.mean) & ~study.shots.is_lost)
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

"""The part of a long trace that the self-test plants its faults into."""

from dataclasses import replace
from typing import Final

import numpy as np

from runtime.arrays import Array
from runtime.program import Fidelity
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.needs import Needs
from verifier.report.wording import seconds
from verifier.traces.trace import Series, Trace

MOST_HORIZONS: Final = 40.0
"""Longer traces catch hardly smaller faults: what is shown must exceed the tolerance anyway."""
MOST_SAMPLES: Final = 10_000
"""Of all series together, unless that would be less than the fewest horizons."""
FEWEST_HORIZONS: Final = 20.0


def excerpt_of(trace: Trace, fidelity: Fidelity, study: Study) -> tuple[Trace, str]:
    """The part of the trace with the most motion, and a sentence on it; empty if it is all."""
    first, last = study.segments.whole
    kept = _duration(study.plan.needs, fidelity.horizon, last - first)
    if kept >= last - first:
        return trace, ""
    start = _liveliest(fidelity, study, kept)
    series = {name: _part(each, start, start + kept) for name, each in trace.series.items()}
    told = (
        f"faults were planted into {seconds(kept)} of the {seconds(last - first)} only"
        f" (from {seconds(start - first)} on, where most moves); the whole trace may show"
        " smaller ones"
    )
    return replace(trace, series=series), told


def _duration(needs: Needs, horizon: float, whole: float) -> float:
    series = [*needs.series, *(each.series for each in needs.inputs if each.series is not None)]
    rate = sum(len(each.times) for each in series) / max(whole, 1e-300)
    affordable = max(MOST_SAMPLES / max(rate, 1e-300), FEWEST_HORIZONS * horizon)
    return float(min(affordable, MOST_HORIZONS * horizon))


def _liveliest(fidelity: Fidelity, study: Study, kept: float) -> float:
    """Where the windows of the next `kept` seconds move most, in tolerances."""
    times = study.plan.windows.times
    way = np.zeros(len(times))
    for j, each in enumerate(study.plan.samples):
        if each.state.name in fidelity.tolerance:
            moved = np.abs(study.shots.errors[-1][j].moved)
            way += np.minimum(np.nan_to_num(moved) / fidelity.tolerance[each.state.name], 10.0)
    total = np.concatenate([[0.0], np.cumsum(way)])
    ends = np.searchsorted(times, times + kept)
    best = int(np.argmax(total[ends] - total[:-1]))
    return float(min(times[best], study.segments.whole[1] - kept))


def _part(series: Series, start: float, end: float) -> Series:
    """The samples from the last one before `start`, which is held, to `end`."""
    a = max(int(np.searchsorted(series.times, start, side="right")) - 1, 0)
    b = int(np.searchsorted(series.times, end, side="right"))
    times: Array = series.times[a:b]
    return replace(series, times=times, values=series.values[a:b])

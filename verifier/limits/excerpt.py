"""The part of a long trace that the self-test plants its faults into."""

from dataclasses import replace
from typing import Final

import numpy as np

from runtime.arrays import Array
from runtime.program import Fidelity
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.spans import contains
from verifier.report.wording import seconds
from verifier.traces.trace import Series, Trace

WHOLE_WINDOWS: Final = 320
WHOLE_SAMPLES: Final = 60_000
"""Of all series together. A trace with no more is taken whole: then what is said to be caught
fails, and what is said not to be does not, if it is planted into the recording itself."""
MOST_WINDOWS: Final = 79
"""Of 40 horizons: what is taken of longer traces."""
MOST_SAMPLES: Final = 10_000
"""Likewise, unless that would be less than the fewest windows."""
FEWEST_WINDOWS: Final = 39
MOVED: Final = 10.0


def excerpt_of(trace: Trace, fidelity: Fidelity, study: Study) -> tuple[Trace, str]:
    """The part of the trace with the most motion, and a sentence on it; empty if it is all.

    It is as long as it takes to hold enough windows: those of a robot that is judged now and then
    only are far apart.
    """
    windows, samples = study.plan.windows, _samples(study)
    kept = _affordable(study, samples)
    is_short = len(windows.times) <= WHOLE_WINDOWS and samples <= WHOLE_SAMPLES
    if is_short or kept >= len(windows.times):
        return trace, ""
    first = _liveliest(fidelity, study, kept)
    start, end = windows.times[first], windows.times[first + kept - 1] + windows.horizon
    series = {name: _part(each, start, end) for name, each in trace.series.items()}
    begin, finish = study.segments.whole
    told = (
        f"all sizes are those that a recording of {seconds(end - start)} would show: of this one,"
        f" {seconds(finish - begin)} long, only the part from {seconds(start - begin)} on, where"
        " most moves, was taken; the whole may show smaller faults, or not all of these"
    )
    return replace(trace, series=series), told


def _samples(study: Study) -> int:
    """How many samples of all series are judged."""
    needs, spans = study.plan.needs, study.segments.spans
    series = [*needs.series, *(each.series for each in needs.inputs if each.series is not None)]
    return sum(int(np.sum(contains(spans, each.times))) for each in series)


def _affordable(study: Study, samples: int) -> int:
    """How many windows."""
    share = MOST_SAMPLES / max(samples, 1)
    return min(max(int(share * len(study.plan.windows.times)), FEWEST_WINDOWS), MOST_WINDOWS)


def _liveliest(fidelity: Fidelity, study: Study, kept: int) -> int:
    """The first of the `kept` windows in which states move and inputs change most, in tolerances.

    No window counts for more than ten tolerances of way, or than one that a late input would make.
    """
    way = np.zeros(len(study.plan.windows.times))
    for j, each in enumerate(study.plan.samples):
        if each.state.name in fidelity.tolerance:
            errors, allowed = study.shots.errors[-1][j], fidelity.tolerance[each.state.name]
            for effect, most in ((errors.moved, MOVED), (errors.hurried, 1.0)):
                there = np.abs(np.nan_to_num(effect)) / allowed
                way += np.minimum(there, most) / most
    total = np.concatenate([[0.0], np.cumsum(way)])
    return int(np.argmax(total[kept:] - total[:-kept]))


def _part(series: Series, start: float, end: float) -> Series:
    """The samples from the last one before `start`, which is held, to `end`."""
    a = max(int(np.searchsorted(series.times, start, side="right")) - 1, 0)
    b = int(np.searchsorted(series.times, end, side="right"))
    times: Array = series.times[a:b]
    return replace(series, times=times, values=series.values[a:b])

"""Sensors that read the very same number for long, though they change with every sample elsewhere.

A robot at rest under a sensor without noise looks the same, so nothing is left out: it is told
where the verdict is no PASS, before anything else that may explain it.
"""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.program import Kind, Program
from verifier.fidelity.stretches.needs import Needs, needs_of
from verifier.report.report import Report, Verdict
from verifier.report.wording import number
from verifier.traces.trace import Series, Trace

LONG: Final = 40
"""So many samples in a row, at least."""
LIVELY: Final = 0.05
"""Elsewhere no more than this share of samples repeats the one before."""


@final
@dataclass(frozen=True, slots=True)
class Stuck:
    """A sensor that reads one number from `start` to `stop` (s), `samples` times."""

    name: str
    start: float
    stop: float
    samples: int


def stuck_of(needs: Needs) -> tuple[Stuck, ...]:
    """The driven states whose sensors seem stuck for a while."""
    driven = {state.name for state in needs.driven if state.kind is not Kind.DISCRETE}
    found = (_longest(series) for series in needs.series if series.name in driven)
    return tuple(each for each in found if each is not None)


def with_stuck(report: Report, program: Program, trace: Trace) -> Report:
    """The report, with what stuck sensors may explain said first; a PASS as it is."""
    found = () if report.verdict is Verdict.PASS else stuck_of(needs_of(program, trace))
    if not found:
        return report
    said = tuple(_told(each) for each in found)
    names = " and ".join(each.name for each in found)
    advice = (
        f"look whether the sensor of {names} was stuck; if it was, leave that time out with"
        " `judge_when`, or cut the log there"
    )
    return replace(report, notes=(*said, *report.notes), advice=(advice, *report.advice))


def _longest(series: Series) -> Stuck | None:
    """The longest stretch of one number, where that is odd."""
    repeats = np.diff(series.values) == 0.0
    edges = np.diff(np.concatenate([[0], repeats.astype(np.int64), [0]]))
    starts, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    if len(starts) == 0:
        return None
    k = int(np.argmax(ends - starts))
    inside, others = int(ends[k] - starts[k]), len(repeats) - int(ends[k] - starts[k])
    elsewhere = int(np.sum(repeats)) - inside
    if inside + 1 < LONG or others < LONG or elsewhere > LIVELY * others:
        return None
    return Stuck(
        series.name, float(series.times[starts[k]]), float(series.times[ends[k]]), inside + 1
    )


def _told(each: Stuck) -> str:
    return (
        f"{each.name} reads the very same number {each.samples} times, from {number(each.start)} to"
        f" {number(each.stop)} s, though it changes with nearly every sample elsewhere"
    )

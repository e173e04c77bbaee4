"""What the changes of mode do to a verdict, and to the times at which the mode is taken to change.

They can only make a verdict worse: a PASS needs them in time and with the right jumps, a switch
that is shown to be wrong is a FAIL of its own, and where an input is missing nothing is decided.
"""

from dataclasses import replace

import numpy as np

from runtime.arrays import Array
from runtime.program import Program
from verifier.fidelity.stretches.changes import changes_in
from verifier.fidelity.stretches.needs import Input, Needs
from verifier.report.report import Report, Standing, Verdict
from verifier.report.switching import Switching, SwitchSort

INSIDE = 1e-3
"""A change stays this share of its doubt away from the sample before."""


def with_switching(report: Report, switching: Switching, needs: Needs) -> Report:
    """The report, its verdict no better than the changes of mode allow."""
    if needs.unknown:
        is_untold = any(each.name == switching.mode for each in needs.unknown)
        return _told(report, switching, report.verdict, first=False) if is_untold else report
    match switching.standing, report.verdict:
        case Standing.EXCEEDED, verdict:
            return _told(report, switching, Verdict.FAIL, first=verdict is not Verdict.FAIL)
        case Standing.UNDECIDED, Verdict.PASS:
            return _told(report, switching, Verdict.INCONCLUSIVE, first=True)
        case Standing.WITHIN, Verdict.FAIL | Verdict.INCONCLUSIVE:
            return report
        case _:
            return _told(report, switching, report.verdict, first=False)


def with_told_times(program: Program, needs: Needs, switching: Switching) -> Needs:
    """The needs, with the mode changing when the states tell that it did."""
    found = [s for s in switching.switches if s.sort is not SwitchSort.MISSED]
    changed = np.array([s.time for s in found if s.source != s.target])
    leaped = np.array([s.time for s in found if s.source == s.target])
    inputs = tuple(_told_times(each, program.field.mode, changed) for each in needs.inputs)
    return replace(needs, inputs=inputs, leaps=replace(needs.leaps, times=leaped))


def _told_times(given: Input, mode: str, times: Array) -> Input:
    if given.name != mode or given.series is None or len(times) == 0:
        return given
    changes, series = changes_in(given.series), given.series
    moved = np.array(series.times)
    found = np.flatnonzero(np.diff(series.values) != 0.0) + 1
    margin = INSIDE * changes.doubt
    moved[found] = np.clip(times, changes.since + margin, changes.until - margin)
    return replace(given, series=replace(series, times=moved))


def _told(report: Report, switching: Switching, verdict: Verdict, *, first: bool) -> Report:
    own, others = switching.reasons, report.reasons
    if verdict is not report.verdict and report.verdict is Verdict.PASS:
        others = ()
    reasons = (*own, *others) if first else (*others, *own)
    advice = (*switching.advice, *report.advice) if first else (*report.advice, *switching.advice)
    return replace(report, verdict=verdict, reasons=reasons, advice=tuple(dict.fromkeys(advice)))

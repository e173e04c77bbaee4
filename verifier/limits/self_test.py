"""The self-test: the smallest known faults that the verdict would have caught in this trace.

A fault counts as caught where the copy with it FAILs in either direction (too much and too
little). Its sizes stand on a ladder, which is searched. Only the verdict itself decides.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Final, TypeAlias, final

import numpy as np

from runtime.program import Program
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.needs import Needs, needs_of
from verifier.fidelity.verify import judged, verify
from verifier.limits.excerpt import excerpt_of
from verifier.limits.faults import RATIO, Planned, faults_of
from verifier.limits.lanes import Lane
from verifier.limits.planting import Plantings, copy_of, plant
from verifier.limits.saying import said
from verifier.limits.search import turning
from verifier.report.limits import Caught, Trial
from verifier.report.report import Report, Standing, Verdict
from verifier.report.wording import listed, number
from verifier.traces.trace import Trace

Judge: TypeAlias = Callable[[Program, Trace], Report]

SEED: Final = 7_020
"""For rounding to the steps of quantised sensors: the same trace gives the same limits."""
SIDES: Final = (1.0, -1.0)
"""Each size is planted as too much and as too little."""


def smallest_caught(
    program: Program, trace: Trace, report: Report, judge: Judge = verify
) -> tuple[tuple[Caught, ...], tuple[str, ...]]:
    """What each planted fault would have to be to be caught, and on what that rests.

    report: the verdict on the trace as it is. Empty with the reason where that is FAIL, or where
    there is nothing to judge.
    """
    if report.verdict is Verdict.FAIL:
        return (), (
            "no fault was planted: the trace fails as it is, so there is nothing left to catch",
        )
    assert program.fidelity is not None, "a report needs a tolerance"
    known, notes = _declared(trace, needs_of(program, trace))
    base, study = judged(program, known)
    part = known
    if study is not None:
        part, told = excerpt_of(known, program.fidelity, study)
        if told:
            notes.append(told)
            base, study = judged(program, part)
    if study is None:
        return (), ("no fault was planted: too little of this trace can be judged",)
    if base.verdict is Verdict.FAIL:
        return (), (*notes, "no fault was planted after all: that fails as it is")
    planned = faults_of(program, program.fidelity, study)
    return _searched(program, part, study, planned, judge), tuple(notes)


def _declared(trace: Trace, needs: Needs) -> tuple[Trace, list[str]]:
    """The trace with the inputs that it does not tell declared constant, as the spec assumes."""
    assumed = {each.name: each.value for each in needs.inputs if not each.is_known}
    if not assumed:
        return trace, []
    values = listed([f"{name} = {number(value)} (SI)" for name, value in assumed.items()])
    note = f"faults were planted as if {values} were known, which this trace does not tell"
    return replace(trace, constants=trace.constants | assumed), [note]


def _searched(
    program: Program, trace: Trace, study: Study, planned: tuple[Planned, ...], judge: Judge
) -> tuple[Caught, ...]:
    acting = [each for each in planned if each.can_act]
    lanes = tuple(
        Lane(each, side * size) for each in acting for size in each.sizes for side in SIDES
    )
    plantings = plant(study, lanes)
    found, first = [], 0
    for each in planned:
        trials = _Trials(program, trace, plantings, judge, first)
        found.append(_caught(each, trials) if each.can_act else said(each, (None, None), (), ()))
        first += len(SIDES) * len(each.sizes) if each.can_act else 0
    return tuple(found)


@final
class _Trials:
    """The copies of one fault, judged when they are asked for, and remembered."""

    def __init__(
        self, program: Program, trace: Trace, plantings: Plantings, judge: Judge, first: int
    ) -> None:
        self._program, self._trace, self._judge = program, trace, judge
        self._plantings, self._first = plantings, first
        self.reports: dict[int, Report] = {}

    def is_caught(self, rung: int) -> bool:
        """Whether a fault of this size FAILs, planted in either direction."""
        first = self._first + len(SIDES) * rung
        return all(self._fails(first + side) for side in range(len(SIDES)))

    def sides(self, rung: int) -> tuple[Verdict, Verdict]:
        """The verdicts on a fault of this size, planted as too much and as too little."""
        first = self._first + len(SIDES) * rung
        for lane in (first, first + 1):
            self._fails(lane)
        return self.reports[first].verdict, self.reports[first + 1].verdict

    def expected(self, rung: int) -> int:
        """Where the verdict should turn, from the figures at a rung that was judged.

        A departure grows with the fault, and must exceed its tolerance by its own doubt.
        """
        first = self._first + len(SIDES) * rung
        reports = [self.reports[i] for i in range(first, first + len(SIDES)) if i in self.reports]
        factors = [
            (figure.tolerance + figure.departure - figure.interval.low) / figure.departure
            for report in reports
            for figure in (result.declared for result in report.variables)
            if figure.departure > 0.0
        ]
        usable = [factor for factor in factors if 0.0 < factor < np.inf]
        return rung + int(np.rint(np.log(min(usable)) / np.log(RATIO))) if usable else rung

    def tried(self) -> tuple[Trial, ...]:
        """All sizes that were judged, ascending."""
        trials = [
            Trial(self._plantings.lanes[lane].size, report.verdict)
            for lane, report in self.reports.items()
        ]
        return tuple(sorted(trials, key=lambda trial: trial.size))

    def shown_by(self, rung: int) -> tuple[str, ...]:
        """The variables that gave a fault of this size away, one or the other way."""
        first = self._first + len(SIDES) * rung
        lanes = range(first, first + len(SIDES))
        return tuple(dict.fromkeys(name for i in lanes for name in exceeded(self.reports[i])))

    def _fails(self, lane: int) -> bool:
        if lane not in self.reports:
            rng = np.random.default_rng([SEED, lane])
            copy = copy_of(self._trace, self._plantings, lane, rng)
            self.reports[lane] = self._judge(self._program, copy)
        return self.reports[lane].verdict is Verdict.FAIL and bool(exceeded(self.reports[lane]))


def exceeded(report: Report) -> list[str]:
    """The variables that are shown to exceed their tolerance."""
    return [each.name for each in report.variables if each.standing is Standing.EXCEEDED]


def _caught(planned: Planned, trials: _Trials) -> Caught:
    last = len(planned.sizes) - 1
    rungs = turning(trials.is_caught, trials.expected, planned.guess, last + 1)
    if rungs[1] is None:
        sides = trials.sides(last)
        return said(planned, rungs, trials.tried(), (), sides)
    return said(planned, rungs, trials.tried(), trials.shown_by(rungs[1]))

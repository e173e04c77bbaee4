"""The copies of a trace with a fault in each, judged when they are asked for, and remembered."""

from collections.abc import Callable
from typing import Final, TypeAlias, final

import numpy as np

from runtime.program import Program
from verifier.fidelity.shooting.study import Study
from verifier.limits.faults import RATIO, Planned
from verifier.limits.lanes import Lane
from verifier.limits.planting import Plantings, copy_of, plant
from verifier.report.limits import Trial
from verifier.report.report import Report, Standing, VariableResult, Verdict
from verifier.traces.trace import Trace

Judge: TypeAlias = Callable[[Program, Trace], Report]

SEED: Final = 7_020
"""For rounding to the steps of quantised sensors: the same trace gives the same limits."""
SIDES: Final = (1.0, -1.0)
"""Each size is planted as too much and as too little."""
BELOW: Final = 1
ABOVE: Final = 4
"""Rungs around the guess that are planted for all faults at once, which costs hardly more."""


@final
class Copies:
    """The copies of one trace, made when they are asked for. base: the verdict on it as it is."""

    def __init__(
        self,
        program: Program,
        trace: Trace,
        study: Study,
        base: Report,
        judge: Judge,
    ) -> None:
        self._program, self._trace, self._study, self._judge = program, trace, study, judge
        self._base = {result.name: result for result in base.variables}
        self._planted: dict[Lane, tuple[Plantings, int]] = {}
        self._reports: dict[Lane, Report] = {}

    def plant(self, lanes: tuple[Lane, ...]) -> None:
        """Integrate the robots of some lanes, all at once."""
        wanted = tuple(dict.fromkeys(lanes))
        plantings = plant(self._study, wanted)
        self._planted |= {lane: (plantings, place) for place, lane in enumerate(wanted)}

    def is_caught(self, planned: Planned, rung: int) -> bool:
        """Whether a fault of this size FAILs, planted in either direction."""
        return all(
            self.report(lane).verdict is Verdict.FAIL for lane in self._weaker_first(planned, rung)
        )

    def sides(self, planned: Planned, rung: int) -> tuple[Report, Report]:
        """The verdicts on a fault of this size, planted as too much and as too little."""
        much, little = _both(planned, rung)
        return self.report(much), self.report(little)

    def expected(self, planned: Planned, rung: int) -> int:
        """Where the verdict should turn, from the figures at a rung that was judged.

        What is shown to come back grows in proportion to the fault, and stays behind it by what
        chance may do.
        """
        known = [lane for lane in _both(planned, rung) if lane in self._reports]
        factors = [self._factor(self._reports[lane]) for lane in known]
        usable = [factor for factor in factors if 0.0 < factor < np.inf]
        return rung + int(np.ceil(np.log(max(usable)) / np.log(RATIO) - 0.01)) if usable else rung

    def tried(self, planned: Planned) -> tuple[Trial, ...]:
        """All sizes of a fault that were judged, ascending."""
        trials = [
            Trial(lane.size, report.verdict)
            for lane, report in self._reports.items()
            if lane.planned is planned
        ]
        return tuple(sorted(trials, key=lambda trial: trial.size))

    def report(self, lane: Lane) -> Report:
        """The verdict on one copy."""
        if lane not in self._reports:
            if lane not in self._planted:
                self.plant(_beside(lane))
            plantings, place = self._planted[lane]
            rng = np.random.default_rng([SEED, place])
            self._reports[lane] = self._judge(
                self._program, copy_of(self._trace, plantings, place, rng)
            )
        return self._reports[lane]

    def _weaker_first(self, planned: Planned, rung: int) -> tuple[Lane, ...]:
        """Both directions, first that in which less was shown of the sizes tried so far."""
        shown = [
            max(
                (
                    _shown(report) / abs(lane.size)
                    for lane, report in self._reports.items()
                    if lane.planned is planned and lane.size * side > 0.0
                ),
                default=0.0,
            )
            for side in SIDES
        ]
        much, little = _both(planned, rung)
        return (much, little) if shown[0] <= shown[1] else (little, much)

    def _factor(self, report: Report) -> float:
        """How many times as large a fault must be for this verdict to turn."""
        factors = [self._own_factor(result) for result in report.variables if result.tolerance > 0]
        return min(factors, default=np.inf)

    def _own_factor(self, result: VariableResult) -> float:
        before = self._base.get(result.name)
        unrest = 0.0 if before is None else before.declared.departure
        effect = float(np.sqrt(max(result.declared.departure**2 - unrest**2, 0.0)))
        behind = max(effect - result.systematic, 0.0)
        return (result.tolerance + behind) / effect if effect > 0.0 else np.inf


def copies_of(
    program: Program,
    trace: Trace,
    study: Study,
    base: Report,
    planned: tuple[Planned, ...],
    judge: Judge,
) -> Copies:
    """The copies of one trace; those around the guesses of all faults are planted at once."""
    copies = Copies(program, trace, study, base, judge)
    copies.plant(tuple(lane for each in planned for lane in _around(each)))
    return copies


def exceeded(report: Report) -> list[str]:
    """The variables that are shown to exceed their tolerance."""
    return [each.name for each in report.variables if each.standing is Standing.EXCEEDED]


def _shown(report: Report) -> float:
    return max((each.systematic / each.tolerance for each in report.variables), default=0.0)


def _both(planned: Planned, rung: int) -> tuple[Lane, Lane]:
    size = float(planned.sizes[rung])
    return Lane(planned, SIDES[0] * size), Lane(planned, SIDES[1] * size)


def _beside(lane: Lane) -> tuple[Lane, ...]:
    """A lane and those that are likely to be asked for next."""
    sizes = lane.planned.sizes
    rung = int(np.searchsorted(sizes, abs(lane.size)))
    near = sizes[max(rung - 1, 0) : rung + ABOVE]
    return tuple(Lane(lane.planned, side * float(size)) for size in near for side in SIDES)


def _around(planned: Planned) -> tuple[Lane, ...]:
    low, high = planned.guess - BELOW, planned.guess + ABOVE + 1
    sizes = planned.sizes[max(low, 0) : high]
    return tuple(Lane(planned, side * float(size)) for size in sizes for side in SIDES)

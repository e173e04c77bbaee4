"""The constants of an arbiter that has to run (weights, a competition), found from decisions.

Such an arbiter has no thresholds to take out of its conditions. Its constants are moved one by one,
each by factors of its own value, and the arbiter is run again over all that was read. A constant
of 0 has no scale of its own, and is left as it is.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arbiter import Arbiter, Paradigm
from runtime.arrays import Array, Booleans
from verifier.arbitration.choosing import Chooser, stepwise
from verifier.arbitration.decisions import Decisions
from verifier.arbitration.refitting import Scales, is_better
from verifier.arbitration.shares import FEW, slowness_of
from verifier.report.arbitration import Threshold, ThresholdStanding
from verifier.report.report import Interval

Decide: TypeAlias = Callable[[Array, float], Array]
"""One tick of an arbiter that runs: what it reads and the time, to a number per choice."""
Running: TypeAlias = Callable[[Arbiter], Decide]
"""What makes a fresh one that runs."""

MOVABLE: Final = frozenset({Paradigm.WEIGHTS, Paradigm.COMPETITION})
"""A plan's numbers stand in its behavior, a module's in its code."""
FACTORS: Final = np.geomspace(0.4, 2.5, 15)
CLOSER: Final = 7
"""How often the best value is looked for more closely."""
ENDS: Final = 9
"""How often an end of the interval is halved."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Numbers:
    """What decisions say of an arbiter's constants: the best of them moved.

    chooser: with that one moved; None where none explains more.
    """

    thresholds: tuple[Threshold, ...]
    chooser: Chooser | None
    agrees: Booleans


def chooser_of(arbiter: Arbiter, running: Running) -> Chooser:
    """The choice of each tick of the arbiter, run anew."""
    inputs = len(arbiter.reads) + len(arbiter.controls)

    def choose(decisions: Decisions) -> "np.ndarray[tuple[int], np.dtype[np.int64]]":
        return stepwise(running(arbiter), inputs, arbiter.choices)(decisions)

    return choose


def numbers_of(
    arbiter: Arbiter, running: Running, decisions: Decisions, agrees: Booleans, scales: Scales
) -> Numbers:
    """Each constant fitted by itself; the one that explains most is what is told as moved."""
    lines = [_Line(arbiter, i, running, decisions) for i in _movable(arbiter)]
    fits = [line.best() for line in lines]
    found = [line.agrees(fit) for line, fit in zip(lines, fits, strict=True)]
    best = max(range(len(lines)), key=lambda i: int(found[i].sum()), default=None)
    if best is None or not is_better(found[best], agrees, scales):
        return Numbers((), None, agrees)
    threshold = lines[best].told(fits[best], found[best], scales)
    return Numbers((threshold,), lines[best].chooser(fits[best]), found[best])


def slowness_of_numbers(
    arbiter: Arbiter, running: Running, decisions: Decisions, required: float
) -> float:
    """The greatest autocorrelation time of what one moved constant changes, near the limit.

    Infinite where none changes so many decisions: then nothing is known of it.
    """
    wanted = max((1.0 - required) * float(decisions.judged.sum()), FEW)
    expected = chooser_of(arbiter, running)(decisions)
    times = []
    for place in _movable(arbiter):
        line = _Line(arbiter, place, running, decisions)
        for side in (FACTORS[FACTORS < 0.999][::-1], FACTORS[FACTORS > 1.001]):
            for factor in side:
                chosen = line.chooser(float(factor) * line.own)(decisions)
                changed = (chosen != expected)[decisions.judged]
                if changed.sum() >= wanted:
                    times.append(slowness_of(changed.astype(float)))
                    break
    return max(times, default=np.inf)


def _movable(arbiter: Arbiter) -> list[int]:
    """The places of the constants that factors move."""
    return [place for place, each in enumerate(arbiter.constants) if each.value != 0.0]


@final
class _Line:
    """One constant, at any value."""

    def __init__(
        self, arbiter: Arbiter, place: int, running: Running, decisions: Decisions
    ) -> None:
        self._arbiter, self._place = arbiter, place
        self._running, self._decisions = running, decisions
        self.own = arbiter.constants[place].value
        self._known: dict[float, Booleans] = {}

    def chooser(self, value: float) -> Chooser:
        """The arbiter with the constant at that value."""
        constants = list(self._arbiter.constants)
        constants[self._place] = replace(constants[self._place], value=value)
        return chooser_of(replace(self._arbiter, constants=tuple(constants)), self._running)

    def agrees(self, value: float) -> Booleans:
        """Which judged decisions agree then."""
        if value not in self._known:
            chosen = self.chooser(value)(self._decisions)
            self._known[value] = (chosen == self._decisions.chosen) & self._decisions.judged
        return self._known[value]

    def best(self) -> float:
        """The value with which most agree; of several the nearest to the spec's."""
        values = [float(factor) * self.own for factor in FACTORS]
        best = self._most(values)
        step = float(FACTORS[1] / FACTORS[0])
        for _ in range(CLOSER):
            step = step**0.5
            best = self._most([best / step, best, best * step])
        return best

    def _most(self, values: Sequence[float]) -> float:
        return max(values, key=lambda v: (int(self.agrees(v).sum()), -abs(v - self.own)))

    def told(self, fitted: float, agrees: Booleans, scales: Scales) -> Threshold:
        """What the log says of the constant, the others as they are."""
        ends = [self._end(fitted, factor, agrees, scales) for factor in (FACTORS[0], FACTORS[-1])]
        low, high = sorted(ends)
        constant = self._arbiter.constants[self._place]
        kept = low <= self.own <= high
        return Threshold(
            name=constant.name,
            comparison=constant.name,
            unit=constant.unit,
            value=self.own,
            fitted=fitted,
            interval=Interval(low, high),
            agreeing=int(agrees.sum()),
            standing=ThresholdStanding.KEPT if kept else ThresholdStanding.MOVED,
            origin=constant.origin,
        )

    def _end(self, fitted: float, factor: float, agrees: Booleans, scales: Scales) -> float:
        """The value farthest that way which is not shown to be worse."""
        near, far = fitted, fitted * float(factor)
        for _ in range(ENDS):
            middle = 0.5 * (near + far)
            if is_better(agrees, self.agrees(middle), scales):
                far = middle
            else:
                near = middle
        return far

"""Which samples of several deciders can be in effect at one instant: exactly, in whole steps."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Final, final

from compiler.architecture.exclusion.question import Question
from compiler.architecture.times import common, exact

MOST: Final = 4000
"""Instants that are looked at."""


@final
@dataclass(frozen=True, slots=True)
class Timing:
    """The clocks of a question in whole steps of `step` seconds.

    ends: the first instant that repeats an earlier one. is_whole: whether all up to there are
    looked at.
    """

    step: Fraction
    periods: tuple[int, ...]
    responses: tuple[int, ...]
    rates: tuple[int, ...]
    delays: tuple[int, ...]
    firsts: tuple[int, ...]
    ends: int
    is_whole: bool

    def seconds(self, steps: int) -> float:
        """An instant in seconds."""
        return float(steps * self.step)

    def sample(self, decider: int, instant: int) -> int | None:
        """When the decision was sampled that is in effect at an instant; None for not yet."""
        since = instant - self.responses[decider]
        period = self.periods[decider]
        return None if since < 0 else since // period * period

    def version(self, signal: int, instant: int) -> int:
        """Which version of a signal can be read at an instant.

        A sensor's first one, 0, can from the beginning on; before a node's there is none, -1.
        """
        rate = self.rates[signal]
        if rate == 0:
            return instant
        return max((instant - self.delays[signal]) // rate, self.firsts[signal])


@final
@dataclass(frozen=True, slots=True)
class Instant:
    """An instant at which decisions are in effect, and when each of them was sampled."""

    at: int
    samples: tuple[int | None, ...]


def timing_of(question: Question) -> Timing:
    """The clocks of a question, in whole steps."""
    periods = [exact(d.period) for d in question.deciders]
    responses = [exact(d.response_time) for d in question.deciders]
    rates = [exact(s.every) for s in question.signals]
    delays = [exact(s.delay) for s in question.signals]
    step = common([*periods, *responses, *rates, *delays]) or Fraction(1)
    steps = [tuple(int(n / step) for n in many) for many in (periods, responses, rates, delays)]
    turn = math.lcm(*(n for n in (*steps[0], *steps[2]) if n > 0), 1)
    # One turn later everything comes again; until then first versions differ from later ones.
    ends = 2 * turn + max((*steps[1], 0)) + max((*steps[3], 0))
    instants = sum(2 * ends // period + 1 for period in steps[0])
    return Timing(
        step=step,
        periods=steps[0],
        responses=steps[1],
        rates=steps[2],
        delays=steps[3],
        firsts=tuple(-1 if signal.told else 0 for signal in question.signals),
        ends=ends,
        is_whole=instants <= MOST,
    )


def instants(question: Question, timing: Timing) -> Iterator[Instant]:
    """The instants at which what is in effect changes, one for each way in which samples agree.

    Those with most in common first: at one instant, if there is such a one.
    """
    places = range(len(question.deciders))
    seen: dict[tuple[int, ...], Instant] = {}
    for at in _changes(timing):
        samples = tuple(timing.sample(place, at) for place in places)
        seen.setdefault(_pattern(question, timing, samples), Instant(at, samples))
    ranked = sorted(seen.items(), key=lambda item: (len(set(item[0])), item[1].at))
    yield from (instant for _, instant in ranked)


def _changes(timing: Timing) -> list[int]:
    ends = timing.ends
    if not timing.is_whole:
        ends = MOST * min(timing.periods) // (2 * max(1, len(timing.periods)))
    return sorted(
        {
            tick + response
            for period, response in zip(timing.periods, timing.responses, strict=True)
            for tick in range(0, ends, period)
        }
    )


def _pattern(
    question: Question, timing: Timing, samples: tuple[int | None, ...]
) -> tuple[int, ...]:
    """Which names the deciders' formulas share: numbers in the order of their first place."""
    numbers: dict[tuple[int, int, int], int] = {}
    found = []
    for place, (decider, sample) in enumerate(zip(question.deciders, samples, strict=True)):
        if sample is None:
            found.append(-1)
            continue
        for entry in decider.entries:
            if entry.signal >= 0:
                key = (0, entry.signal, timing.version(entry.signal, sample))
            else:
                key = (1, place, 0)
            found.append(numbers.setdefault(key, len(numbers)))
    return tuple(found)

"""How a state in which both act was come to: the decisions that count, and the inputs."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import final

from compiler.architecture.exclusion.answer import Moment
from compiler.architecture.exclusion.conditions import Taken, remembers
from compiler.architecture.exclusion.memory import Memory
from compiler.architecture.exclusion.overlap import Timing
from compiler.architecture.exclusion.question import Outcome, Question
from compiler.architecture.exclusion.witness import Decision, moments


@final
@dataclass(frozen=True, slots=True)
class Tick:
    """What a decider took, what it remembers after it, and the outcomes that hold, as bits."""

    taken: Taken
    memory: Memory
    outcomes: int


@final
@dataclass(frozen=True, slots=True)
class Step:
    """A state that was reached: from which (-1: the beginning), when, and who ticked there."""

    parent: int
    at: int
    ticks: Mapping[int, Tick] = field(default_factory=dict)


@final
@dataclass(frozen=True, slots=True)
class Reached:
    """Both act at an instant, by these decisions, after these inputs."""

    at: int
    decisions: list[Decision]
    inputs: tuple[Moment, ...]


def course_to(question: Question, timing: Timing, steps: list[Step]) -> Reached:
    """How the last of the steps was come to."""
    ticks: dict[tuple[int, int], Tick] = {}
    place = len(steps) - 1
    while place >= 0:
        step = steps[place]
        ticks |= {(step.at, d): tick for d, tick in step.ticks.items()}
        place = step.parent
    course = _Course(question, timing, steps[-1].at, ticks)
    counting = (key for key in sorted(ticks) if course.counts(*key))
    taken = [(time, d, ticks[time, d].taken) for time, d in counting]
    return Reached(course.at, list(course.decisions()), moments(question, timing, taken))


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Course:
    """The ticks, by instant and decider, that end where both act at `at`."""

    question: Question
    timing: Timing
    at: int
    ticks: Mapping[tuple[int, int], Tick]

    def counts(self, time: int, place: int) -> bool:
        """Whether a tick comes early enough for what is in effect at the end."""
        sampled = self.timing.sample(place, self.at)
        return sampled is not None and time <= sampled

    def decisions(self) -> Iterator[Decision]:
        """What lets both act, and of each combined behavior why it does not act instead."""
        for outcome in self._counting():
            yield from self._decision(outcome)
        for actor in self.question.unless:
            missed = next(n for n in actor.needs if not any(map(self._holds, n)))
            for place, which in missed:
                tick = self.timing.sample(place, self.at)
                if tick is not None:
                    taken = self.ticks[tick, place].taken
                    yield Decision(place, which, tick, taken, is_denied=True)

    def _holds(self, outcome: Outcome) -> bool:
        """Whether an outcome is in effect."""
        place, which = outcome
        tick = self.timing.sample(place, self.at)
        return tick is not None and bool(self.ticks[tick, place].outcomes >> which & 1)

    def _counting(self) -> list[Outcome]:
        """Of each need an outcome that holds."""
        actors = (self.question.first, self.question.second)
        needs = (need for actor in actors for need in actor.needs)
        return sorted({next(filter(self._holds, need)) for need in needs})

    def _decision(self, outcome: Outcome) -> Iterator[Decision]:
        """The decision that is in effect, and where its rule began to hold, if that was before."""
        place, which = outcome
        sampled = self.timing.sample(place, self.at)
        assert sampled is not None, "what is in effect was sampled"
        began = self._began(outcome, sampled)
        if began < sampled:
            yield Decision(place, which, began, self.ticks[began, place].taken, begins=True)
        yield Decision(place, which, sampled, self.ticks[sampled, place].taken)

    def _began(self, outcome: Outcome, sampled: int) -> int:
        """Since which tick the rule that gives an outcome has held, if it remembers."""
        place, which = outcome
        decider = self.question.deciders[place]
        if not decider.rules:
            return sampled
        rule = next(
            i
            for i, given in enumerate(decider.rules)
            if given.choice == which and self.ticks[sampled, place].memory[i] >= 0
        )
        if not remembers(decider.rules[rule], decider):
            return sampled
        began, period = sampled, self.timing.periods[place]
        while began >= period and self.ticks[began - period, place].memory[rule] >= 0:
            began -= period
        return began

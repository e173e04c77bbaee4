"""Whether a state in which both act is ever reached, where rules remember what held before.

Every rule holds or not, and has held for so many ticks: finitely many states, which are visited one
by one, in the order of time, with everything that can be read at each tick (inputs of successive
ticks are free).
"""

import math
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, final

from compiler.architecture.exclusion.answer import Proof, Undecided
from compiler.architecture.exclusion.course import Reached, Step, Tick, course_to
from compiler.architecture.exclusion.memory import Memory, decided
from compiler.architecture.exclusion.overlap import Timing
from compiler.architecture.exclusion.question import Actor, Question
from compiler.architecture.exclusion.readable import Pattern, patterns
from compiler.architecture.exclusion.witness import help_of
from spec_schema.wording import listed

MOST_TRIED: Final = 100_000
MOST_UNTOLD: Final = 100
"""Ways to an end that need more readings than sensors tell, before no other is looked for."""


@final
@dataclass(frozen=True, slots=True)
class _One:
    """A decider between ticks. waiting: outcomes that take effect in so many steps.

    Outcomes are a number whose bits they are; held: those in effect, 0 where there are none yet.
    """

    memory: Memory
    waiting: tuple[tuple[int, int], ...] = ()
    held: int = 0


def reached(question: Question, timing: Timing) -> Reached | Proof | Undecided:
    """The earliest instant at which both act; a proof where there is none."""
    return _Visit(question, timing).run()


@final
class _Visit:
    def __init__(self, question: Question, timing: Timing) -> None:
        self._question, self._timing = question, timing
        actors = (question.first, question.second, *question.unless)
        self._used = sorted({d for actor in actors for need in actor.needs for d, _ in need})
        self._patterns: dict[tuple[int, ...], list[Pattern]] = {}
        self._is_open = False
        self._tried = 0
        self._steps: list[Step] = []
        self._untold: list[Reached] = []

    def run(self) -> Reached | Proof | Undecided:
        """Visit all states."""
        phases = self._phases()
        turn = math.lcm(*(self._timing.periods[d] for d in self._used))
        start = tuple(_One((-1,) * len(self._question.deciders[d].rules)) for d in self._used)
        seen = {(0, start)}
        queue = deque([(0, start, -1)])
        while queue:
            at, before, parent = queue.popleft()
            phase = phases.index(at % turn)
            lasts = (phases[phase + 1] if phase + 1 < len(phases) else phases[0] + turn) - at % turn
            for after, step in self._after(at, before, parent):
                self._tried += 1
                if self._both_act(after):
                    found = course_to(self._question, self._timing, [*self._steps, step])
                    if self._is_told(found):
                        return found
                    self._untold.append(found)
                    if len(self._untold) == MOST_UNTOLD:
                        return self._slow(self._untold[0])
                key = ((phase + 1) % len(phases), _waited(after, lasts))
                if key not in seen:
                    seen.add(key)
                    self._steps.append(step)
                    queue.append((at + lasts, key[1], len(self._steps) - 1))
            if self._tried > MOST_TRIED or self._is_open:
                return self._slow(self._untold[0]) if self._untold else self._open()
        if self._untold:
            return self._slow(self._untold[0])
        names = [self._question.deciders[d].name for d in self._used]
        reason = (
            f"of all that {listed(names, last='and')} can remember, nothing that is ever reached "
            f"lets both {self._question.first.name} and {self._question.second.name} act"
        )
        return Proof(reason, len(seen))

    def _phases(self) -> list[int]:
        """The instants of one turn at which somebody ticks or something takes effect."""
        turn = math.lcm(*(self._timing.periods[d] for d in self._used))
        found = {0}
        for d in self._used:
            for tick in range(0, turn, self._timing.periods[d]):
                found |= {tick, (tick + self._timing.responses[d]) % turn}
        return sorted(found)

    def _after(
        self, at: int, before: tuple[_One, ...], parent: int
    ) -> Iterator[tuple[tuple[_One, ...], Step]]:
        """What the state can become at an instant, by what is read there."""
        now = [_in_effect(one) for one in before]
        due = tuple(i for i, d in enumerate(self._used) if at % self._timing.periods[d] == 0)
        if not due:
            yield tuple(now), Step(parent, at)
            return
        for pattern in self._known(due):
            after, ticks = list(now), {}
            for i, row, taken in zip(due, pattern.rows, pattern.taken, strict=True):
                place = self._used[i]
                memory, outcomes = decided(self._question.deciders[place], now[i].memory, row)
                waiting = (*now[i].waiting, (self._timing.responses[place], outcomes))
                after[i] = _in_effect(_One(memory, waiting, now[i].held))
                ticks[place] = Tick(taken, memory, outcomes)
            yield tuple(after), Step(parent, at, ticks)

    def _known(self, due: tuple[int, ...]) -> list[Pattern]:
        if due not in self._patterns:
            found, is_all = patterns(self._question, tuple(self._used[i] for i in due))
            self._is_open |= not is_all
            self._patterns[due] = found
        return self._patterns[due]

    def _both_act(self, now: tuple[_One, ...]) -> bool:
        held = {d: one.held for d, one in zip(self._used, now, strict=True)}

        def acts(actor: Actor) -> bool:
            return all(any(held[d] >> o & 1 for d, o in need) for need in actor.needs)

        question = self._question
        replaced = any(map(acts, question.unless))
        return acts(question.first) and acts(question.second) and not replaced

    def _is_told(self, found: Reached) -> bool:
        """Whether no slow signal changed between ticks that see the same version of it."""
        known: dict[tuple[int, int], float] = {}
        for moment in found.inputs:
            instant = round(moment.time / float(self._timing.step))
            for place, (_, value) in enumerate(moment.signals):
                key = (place, self._timing.version(place, instant))
                if known.setdefault(key, value) != value:
                    return False
        return True

    def _slow(self, found: Reached) -> Undecided:
        names = [signal.name for signal in self._question.signals if signal.every > 0.0]
        verb = "does" if len(names) == 1 else "do"
        return Undecided(
            "both would act if what they sense changed between any two ticks, which "
            f"{listed(names, last='and')} {verb} not",
            help_of(self._question, found.decisions)
            or "give both the same period and response_time, or let one arbiter choose",
        )

    def _open(self) -> Undecided:
        names = [self._question.deciders[d].name for d in self._used]
        return Undecided(
            f"what {listed(names, last='and')} can remember has too many states to visit",
            "let one arbiter of `rules` choose between them, or let rules remember less",
        )


def _in_effect(one: _One) -> _One:
    """What was waiting for now, in effect."""
    held = one.held
    for due, outcomes in one.waiting:
        held = outcomes if due == 0 else held
    return _One(one.memory, tuple(w for w in one.waiting if w[0] > 0), held)


def _waited(now: tuple[_One, ...], steps: int) -> tuple[_One, ...]:
    return tuple(
        _One(one.memory, tuple((due - steps, what) for due, what in one.waiting), one.held)
        for one in now
    )

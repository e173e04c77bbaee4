"""Whether a state in which both act is ever reached, where rules remember what held before.

Every rule holds or not, and has held for so many ticks: finitely many states, which are visited one
by one, in the order of time, with everything that can be read at each tick (inputs of successive
ticks are free). What can be read is known beforehand, as the combinations of conditions that some
numbers fulfil.
"""

import math
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final, final

from compiler.architecture.exclusion.answer import Moment, Proof, Undecided
from compiler.architecture.exclusion.conditions import Sampled, remembers
from compiler.architecture.exclusion.formula import Formula, both, denied, holds
from compiler.architecture.exclusion.memory import Memory, conditions_of, decided, outcomes_of
from compiler.architecture.exclusion.overlap import Timing
from compiler.architecture.exclusion.question import Actor, Outcome, Question
from compiler.architecture.exclusion.search import Found, Open, solve
from compiler.architecture.exclusion.witness import Decision, moments
from spec_schema.wording import listed

MOST_TRIED: Final = 100_000
MOST_PATTERNS: Final = 256
BUDGET: Final = 300


@final
@dataclass(frozen=True, slots=True)
class Reached:
    """Both act at an instant, by these decisions, after these inputs."""

    at: int
    decisions: list[Decision]
    inputs: tuple[Moment, ...]


@final
@dataclass(frozen=True, slots=True)
class _Pattern:
    """Which conditions of some deciders hold together (one row each), and numbers where they do."""

    rows: tuple[tuple[bool, ...], ...]
    values: tuple[Mapping[str, float], ...]


@final
@dataclass(frozen=True, slots=True)
class _One:
    """A decider between ticks. waiting: outcomes that take effect in so many steps.

    Outcomes are a number whose bits they are; held: those in effect, 0 where there are none yet.
    """

    memory: Memory
    waiting: tuple[tuple[int, int], ...] = ()
    held: int = 0


@final
@dataclass(frozen=True, slots=True)
class _Step:
    """A state that was reached: from which, when, and what was read there, by decider."""

    parent: int
    at: int
    read: Mapping[int, Mapping[str, float]] = field(default_factory=dict)
    memories: Mapping[int, Memory] = field(default_factory=dict)


def reached(question: Question, timing: Timing) -> Reached | Proof | Undecided:
    """The earliest instant at which both act; a proof where there is none."""
    return _Visit(question, timing).run()


@final
class _Visit:
    def __init__(self, question: Question, timing: Timing) -> None:
        self._question, self._timing = question, timing
        actors = (question.first, question.second, *question.unless)
        self._used = sorted({d for actor in actors for need in actor.needs for d, _ in need})
        self._patterns: dict[tuple[int, ...], list[_Pattern]] = {}
        self._is_open = False
        self._tried = 0
        self._steps: list[_Step] = []

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
                    self._steps.append(step)
                    found = self._told(at)
                    return found if self._is_told(found) else self._slow()
                key = ((phase + 1) % len(phases), _waited(after, lasts))
                if key not in seen:
                    seen.add(key)
                    self._steps.append(step)
                    queue.append((at + lasts, key[1], len(self._steps) - 1))
            if self._tried > MOST_TRIED or self._is_open:
                return self._open()
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
    ) -> Iterator[tuple[tuple[_One, ...], _Step]]:
        """What the state can become at an instant, by what is read there."""
        now = [_in_effect(one) for one in before]
        due = tuple(i for i, d in enumerate(self._used) if at % self._timing.periods[d] == 0)
        if not due:
            yield tuple(now), _Step(parent, at)
            return
        for pattern in self._known(due):
            after, read = list(now), {}
            memories = {}
            for i, row, values in zip(due, pattern.rows, pattern.values, strict=True):
                decider = self._question.deciders[self._used[i]]
                memory, outcomes = decided(decider, now[i].memory, row)
                waiting = (*now[i].waiting, (self._timing.responses[self._used[i]], outcomes))
                after[i] = _in_effect(_One(memory, waiting, now[i].held))
                read[self._used[i]] = values
                memories[self._used[i]] = memory
            yield tuple(after), _Step(parent, at, read, memories)

    def _known(self, due: tuple[int, ...]) -> list[_Pattern]:
        if due not in self._patterns:
            self._patterns[due] = list(self._readable(due))
        return self._patterns[due]

    def _readable(self, due: tuple[int, ...]) -> Iterator[_Pattern]:
        """All that deciders that tick together can find."""
        many = [Sampled(self._question, self._used[i], 0, lambda _signal: 0) for i in due]
        rows = [list(conditions_of(sampled)) for sampled in many]
        flat = [formula for row in rows for formula in row]
        variables = {k: v for sampled in many for k, v in sampled.variables().items()}
        waiting: list[tuple[tuple[bool, ...], Found | None]] = [((), None)]
        count = 0
        while waiting:
            bits, found = waiting.pop()
            if found is None or not holds(_together(flat, bits), found.values):
                answer = solve(_together(flat, bits), variables, BUDGET)
                self._is_open |= isinstance(answer, Open)
                if not isinstance(answer, Found):
                    continue
                found = answer
            if len(bits) < len(flat):
                waiting += [((*bits, bit), found) for bit in (False, True)]
                continue
            count += 1
            if count > MOST_PATTERNS:
                self._is_open = True
                return
            yield _Pattern(_split(bits, [len(row) for row in rows]), _read(many, found.values))

    def _both_act(self, now: tuple[_One, ...]) -> bool:
        held = {d: one.held for d, one in zip(self._used, now, strict=True)}

        def acts(actor: Actor) -> bool:
            return all(any(held[d] >> o & 1 for d, o in need) for need in actor.needs)

        question = self._question
        replaced = any(map(acts, question.unless))
        return acts(question.first) and acts(question.second) and not replaced

    def _told(self, at: int) -> Reached:
        path: list[_Step] = []
        place = len(self._steps) - 1
        while place >= 0:
            path.append(self._steps[place])
            place = self._steps[place].parent
        path.reverse()
        by_tick = {(step.at, d): values for step in path for d, values in step.read.items()}
        memories = {(step.at, d): memory for step in path for d, memory in step.memories.items()}
        held = self._held_at(at)
        decisions = [
            one
            for outcome in self._counting(held)
            for one in self._decision(outcome, at, by_tick, memories)
        ]
        for place, which in self._denied(held):
            tick = self._timing.sample(place, at)
            assert tick is not None, "what is held was sampled"
            decisions.append(Decision(place, which, tick, by_tick[tick, place], is_denied=True))
        ticks = [(time, d, values) for (time, d), values in by_tick.items()]
        return Reached(at, decisions, moments(self._question, self._timing, ticks))

    def _held_at(self, at: int) -> dict[int, int]:
        """The outcomes in effect of each decider that has any by then."""
        place = len(self._steps) - 1
        held: dict[int, int] = {}
        # The state itself is not kept; what each decider decided is worked out again.
        path = []
        while place >= 0:
            path.append(self._steps[place])
            place = self._steps[place].parent
        for step in path:
            for d in step.read:
                sampled = self._timing.sample(d, at)
                if d not in held and sampled == step.at:
                    held[d] = self._outcomes_at(step, d)
        return held

    def _denied(self, held: Mapping[int, int]) -> Iterator[Outcome]:
        """Of each combined behavior the outcomes of a need of which none holds."""
        for actor in self._question.unless:
            missed = next(
                need for need in actor.needs if not any(held.get(d, 0) >> o & 1 for d, o in need)
            )
            yield from (outcome for outcome in missed if outcome[0] in held)

    def _counting(self, held: Mapping[int, int]) -> list[Outcome]:
        """Of each need an outcome that holds."""
        actors = (self._question.first, self._question.second)
        chosen = {
            next((d, o) for d, o in need if held.get(d, 0) >> o & 1)
            for actor in actors
            for need in actor.needs
        }
        return sorted(chosen)

    def _outcomes_at(self, step: _Step, decider: int) -> int:
        sampled = Sampled(self._question, decider, 0, lambda _signal: 0)
        given = self._question.deciders[decider]
        names = {sampled.name_of(i): e.name for i, e in enumerate(given.entries)}
        values = {
            key: step.read[decider][name]
            for key, name in names.items()
            if name in step.read[decider]
        }
        row = tuple(holds(formula, values) for formula in conditions_of(sampled))
        return outcomes_of(given, step.memories[decider], row)

    def _decision(
        self,
        outcome: Outcome,
        at: int,
        by_tick: Mapping[tuple[int, int], Mapping[str, float]],
        memories: Mapping[tuple[int, int], Memory],
    ) -> Iterator[Decision]:
        """The decision that is in effect, and where its rule began to hold, if that was before."""
        place, which = outcome
        sampled = self._timing.sample(place, at)
        assert sampled is not None, "what is in effect was sampled"
        decider = self._question.deciders[place]
        began = sampled
        if decider.rules:
            rule = next(
                i
                for i, given in enumerate(decider.rules)
                if given.choice == which and memories[sampled, place][i] >= 0
            )
            period = self._timing.periods[place]
            forgets = not remembers(decider.rules[rule], decider)
            while (
                not forgets and began - period >= 0 and memories[began - period, place][rule] >= 0
            ):
                began -= period
        if began < sampled:
            yield Decision(place, which, began, by_tick[began, place], begins=True)
        yield Decision(place, which, sampled, by_tick[sampled, place])

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

    def _slow(self) -> Undecided:
        names = [signal.name for signal in self._question.signals if signal.every > 0.0]
        return Undecided(
            "both would act if what they sense changed between any two ticks, which "
            f"{listed(names, last='and')} does not",
            "give both the same period and response_time, or let one arbiter choose",
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


def _together(formulas: list[Formula], bits: tuple[bool, ...]) -> Formula:
    pairs = zip(formulas, bits, strict=False)
    return both(formula if bit else denied(formula) for formula, bit in pairs)


def _split(bits: tuple[bool, ...], sizes: list[int]) -> tuple[tuple[bool, ...], ...]:
    found, start = [], 0
    for size in sizes:
        found.append(bits[start : start + size])
        start += size
    return tuple(found)


def _read(many: list[Sampled], values: Mapping[str, float]) -> tuple[Mapping[str, float], ...]:
    return tuple(
        {
            entry.name: values[sampled.name_of(i)]
            for i, entry in enumerate(sampled.decider.entries)
            if sampled.name_of(i) in values
        }
        for sampled in many
    )

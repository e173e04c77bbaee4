"""Do two nodes ever act at one instant? The passes, from what needs no numbers to what does.

1. Structure: an arbiter that holds one choice at a time, and no choice that lets both act.
2. Conditions: of all ways in which samples can be in effect at once (`overlap`), each a search for
   numbers that were sampled (`search`). What rules held before is taken to be anything.
3. Where a state is found that way, and rules have a memory, whether it is ever reached (`reach`).
"""

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final, TypeAlias, final

from compiler.architecture.exclusion.answer import Answer, Proof, Undecided, Witness
from compiler.architecture.exclusion.conditions import Sampled, has_memory
from compiler.architecture.exclusion.course import Reached
from compiler.architecture.exclusion.formula import Formula, both, denied, either, holds
from compiler.architecture.exclusion.overlap import Instant, Timing, instants, timing_of
from compiler.architecture.exclusion.question import Actor, How, Outcome, Question
from compiler.architecture.exclusion.reach import reached
from compiler.architecture.exclusion.search import BUDGET, Found, Open, Variable, solve
from compiler.architecture.exclusion.witness import Decision, is_plain, moments, told
from spec_schema.wording import listed, number

ONE_AT_A_TIME: Final = frozenset({How.FIRST, How.ONE})

FURTHER: Final = 200
"""The budget of a search once another is left open."""

Picks: TypeAlias = Mapping[int, int]
"""For deciders that hold one outcome at a time the one that they hold, -1 for another."""


def decide(question: Question) -> Answer:
    """A proof that the two never act at once, a state in which they do, or what is open."""
    answer = _decided(question)
    if isinstance(answer, Witness) and not answer.help:
        return replace(answer, help=_mend(question))
    return answer


def _decided(question: Question) -> Answer:
    """The answer; nothing is proved by a combined behavior that may not act when it should."""
    ways = list(_ways(question))
    if not ways:
        return Proof(_structure(question))
    answer = _searched(question, ways)
    doubtful = [actor for actor in question.unless if actor.doubt]
    if not isinstance(answer, Proof) or not doubtful:
        return answer
    firm = tuple(actor for actor in question.unless if not actor.doubt)
    alone = _searched(replace(question, unless=firm), ways)
    if isinstance(alone, Proof):
        return alone
    names = listed([actor.name for actor in doubtful])
    return Undecided(
        f"only {names} would act in their place, and may not act then: {doubtful[0].doubt}",
        "let all that a combined behavior reads and gives be finite over all domains, such as "
        "sqrt(max(x, 0)), or let one arbiter of `rules` choose",
    )


def _mend(question: Question) -> str:
    """What would do: the same times, if that is proved; else what always helps."""
    first = question.deciders[0]
    together = tuple(
        replace(one, period=first.period, response_time=first.response_time)
        for one in question.deciders
    )
    differs = together != question.deciders
    if differs and isinstance(_decided(replace(question, deciders=together)), Proof):
        return APART
    if any(question.deciders[d].how is How.ALL for d, _ in _outcomes(question)):
        return "resolve it by `priority`, where the higher layer has its way"
    return "write conditions that never hold together, or let one arbiter choose by `rules`"


def _searched(question: Question, ways: list[Picks]) -> Answer:
    unknown = _unknown(question)
    timing = timing_of(question)
    open_: Undecided | None = None
    boxes = 0
    for instant in instants(question, timing):
        for way in ways:
            case = _Case(question, timing, instant, way)
            budget = BUDGET if open_ is None else FURTHER
            answer = solve(case.formula(), case.variables(), budget)
            if isinstance(answer, Found):
                return unknown or _from_memory(question, timing) or case.witness(answer)
            if isinstance(answer, Open):
                open_ = open_ or case.left(answer)
            else:
                boxes += answer.boxes
    if open_ is not None:
        return open_
    if not timing.is_whole:
        return Undecided(
            "their periods and response times have no short common multiple",
            "give them periods that divide one another",
        )
    return Proof(_conditions(question), boxes)


def _ways(question: Question) -> Iterator[Picks]:
    """All ways in which deciders of one outcome at a time can let both act."""
    used = _outcomes(question)
    strict = sorted({d for d, _ in used if question.deciders[d].how in ONE_AT_A_TIME})
    options = [[*sorted({o for d, o in used if d == one}), -1] for one in strict]
    for combination in itertools.product(*options):
        picks = dict(zip(strict, combination, strict=True))
        if all(
            any(picks.get(d, o) == o for d, o in need)
            for actor in (question.first, question.second)
            for need in actor.needs
        ):
            yield picks


def _outcomes(question: Question) -> set[Outcome]:
    actors = (question.first, question.second, *question.unless)
    return {outcome for actor in actors for need in actor.needs for outcome in need}


def _structure(question: Question) -> str:
    strict = [
        decider.name
        for place, decider in enumerate(question.deciders)
        if decider.how in ONE_AT_A_TIME and any(d == place for d, _ in _outcomes(question))
    ]
    first, second = question.first.name, question.second.name
    holds = "holds" if len(strict) == 1 else "hold"
    return (
        f"{listed(strict, last='and')} {holds} one choice at a time, "
        f"and none lets both {first} and {second} act"
    )


def _conditions(question: Question) -> str:
    first, second = question.first.name, question.second.name
    if question.unless:
        instead = listed([one.name for one in question.unless])
        return f"where {first} and {second} would both act, {instead} acts in their place"
    who = listed([d.name for d in question.deciders if not is_plain(question, d)], last="and")
    return f"by the conditions of {who}, {first} and {second} never act at once"


def _unknown(question: Question) -> Undecided | None:
    """What is said where a decider's outcomes are nobody's to know."""
    for place, _ in sorted(_outcomes(question)):
        decider = question.deciders[place]
        if decider.how is How.ANY:
            return Undecided(
                f"{decider.name} is {decider.what}, whose choices may hold at once",
                "resolve the channel by `priority` or `blend`, or decide by `rules`",
            )
    return None


def _from_memory(question: Question, timing: Timing) -> Answer | None:
    """Whether such a state is reached; None where nothing of before matters."""
    if not any(has_memory(question.deciders[d]) for d, _ in _outcomes(question)):
        return None
    found = reached(question, timing)
    if isinstance(found, Reached):
        return told(question, timing, found.at, found.decisions, found.inputs)
    return found


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Case:
    """One instant, and one way in which both may be let act there."""

    question: Question
    timing: Timing
    instant: Instant
    picks: Picks

    def sampled(self, place: int) -> Sampled | None:
        """A decider at the sample that is in effect; None for none yet."""
        at = self.instant.samples[place]
        if at is None:
            return None
        return Sampled(self.question, place, at, lambda signal: self.timing.version(signal, at))

    def formula(self) -> Formula:
        """Where both act."""
        held = [self._picked(place, outcome) for place, outcome in self.picks.items()]
        both_act = self._acts(self.question.first), self._acts(self.question.second)
        return both((*held, *both_act, *(denied(self._acts(one)) for one in self.question.unless)))

    def variables(self) -> dict[str, Variable]:
        """What all names may be."""
        found: dict[str, Variable] = {}
        for place in range(len(self.question.deciders)):
            sampled = self.sampled(place)
            if sampled is not None:
                found |= sampled.variables()
        return found

    def left(self, answer: Open) -> Undecided:
        """What the search could not settle."""
        parts = []
        for sampled in filter(None, map(self.sampled, range(len(self.question.deciders)))):
            for i, entry in enumerate(sampled.decider.entries):
                ends = answer.box.get(sampled.name_of(i))
                if ends is not None and entry.signal >= 0:
                    signal = self.question.signals[entry.signal]
                    low, high = (number(float(f"{e / signal.unit.scale:.4g}")) for e in ends)
                    parts.append(f"{signal.name} from {low} to {high} {signal.unit.text}")
        where = listed(list(dict.fromkeys(parts)), last="and")
        return Undecided(
            f"whether their conditions ever hold together is open, such as at {where}",
            "compare the same expression in both, leave a gap between them, "
            "or let one arbiter choose by `rules`",
        )

    def witness(self, found: Found) -> Witness:
        """The state, in words."""
        decisions = [
            *(self._decision(outcome, found) for outcome in sorted(self._decided(found))),
            *(self._decision(outcome, found, is_denied=True) for outcome in self._denied(found)),
        ]
        ticks = [(one.sampled, one.decider, one.taken) for one in decisions]
        run = moments(self.question, self.timing, ticks)
        return told(self.question, self.timing, self.instant.at, decisions, run)

    def _decision(self, outcome: Outcome, found: Found, *, is_denied: bool = False) -> Decision:
        sampled = self.sampled(outcome[0])
        assert sampled is not None, "what is decided was sampled"
        taken = sampled.taken(found.values)
        return Decision(*outcome, sampled.stamp, taken, is_denied=is_denied)

    def _denied(self, found: Found) -> Iterator[Outcome]:
        """Of each combined behavior the outcomes of a need of which none holds."""
        for actor in self.question.unless:
            missed = next(n for n in actor.needs if not any(self._holds(o, found) for o in n))
            yield from (o for o in missed if self.sampled(o[0]) is not None)

    def _decided(self, found: Found) -> set[Outcome]:
        """Of each need one outcome that holds."""
        chosen = set()
        for actor in (self.question.first, self.question.second):
            for need in actor.needs:
                chosen.add(next(o for o in need if self._holds(o, found)))
        return chosen

    def _holds(self, outcome: Outcome, found: Found) -> bool:
        return holds(self._outcome(outcome), found.values)

    def _acts(self, actor: Actor) -> Formula:
        return both(either(self._outcome(o) for o in need) for need in actor.needs)

    def _outcome(self, outcome: Outcome) -> Formula:
        place, which = outcome
        sampled = self.sampled(place)
        if sampled is None:
            return False
        if place in self.picks:
            return self.picks[place] == which
        return sampled.outcome(which)

    def _picked(self, place: int, outcome: int) -> Formula:
        sampled = self.sampled(place)
        if sampled is None:
            return True
        if outcome >= 0:
            return sampled.outcome(outcome)
        used = sorted(o for d, o in _outcomes(self.question) if d == place)
        return both(denied(sampled.outcome(o)) for o in used if sampled.decider.how is How.FIRST)


APART: Final = (
    "give all that decides here the same period and response_time, which would do, "
    "or let one arbiter choose"
)

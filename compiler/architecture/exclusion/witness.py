"""A state in which both act, put into the user's words and units."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import final

from compiler.architecture.codes import tree_of
from compiler.architecture.exclusion.answer import Moment, Reading, Sample, Witness
from compiler.architecture.exclusion.conditions import Taken, may_inhibit
from compiler.architecture.exclusion.overlap import Timing
from compiler.architecture.exclusion.question import Decider, Entry, How, Question
from compiler.architecture.exclusion.search import round_between
from runtime.code import Code
from spec_schema.expressions.rewrite import names_in
from spec_schema.wording import listed, number


@final
@dataclass(frozen=True, slots=True)
class Decision:
    """What a decider decided at a tick: the outcome that counts, and what its entries were.

    taken: what its entries were. begins: it is where a rule began to hold, which holds on.
    is_denied: it is that the outcome does not hold, so that a combined behavior does not act in the
    place of both.
    """

    decider: int
    outcome: int
    sampled: int
    taken: Taken
    begins: bool = False
    is_denied: bool = False


def told(
    question: Question,
    timing: Timing,
    at: int,
    decisions: list[Decision],
    inputs: tuple[Moment, ...],
) -> Witness:
    """The witness that these decisions are, both acting at the instant `at`."""
    times = sorted({one.sampled for one in decisions})
    samples = tuple(
        _sample(question, timing, at, time, [one for one in decisions if one.sampled == time])
        for time in times
    )
    return Witness(
        first=question.first.name,
        second=question.second.name,
        at=timing.seconds(at),
        samples=tuple(sample for sample in samples if sample.effects),
        assumed=tuple(dict.fromkeys(_assumed(question, decisions))),
        inputs=inputs,
        help=help_of(question, decisions),
    )


def moments(
    question: Question, timing: Timing, ticks: Iterable[tuple[int, int, Taken]]
) -> tuple[Moment, ...]:
    """A run of the signals: each has, from a tick on, the value that a decider sampled there.

    ticks: instant, decider, and what it took.
    """
    now = [round_between(s.low, s.high, s.unit.scale) for s in question.signals]
    for i, signal in enumerate(question.signals):
        now[i] = signal.low if signal.values else now[i]
    by_time: dict[int, list[tuple[int, Mapping[str, float]]]] = {0: []}
    for time, decider, taken in ticks:
        by_time.setdefault(time, []).append((decider, taken.readings))
    found = []
    for time in sorted(by_time):
        for decider, values in by_time[time]:
            for entry in question.deciders[decider].entries:
                if entry.signal >= 0 and entry.name in values:
                    now[entry.signal] = values[entry.name]
        names = (signal.name for signal in question.signals)
        found.append(Moment(timing.seconds(time), tuple(zip(names, now, strict=True))))
    return tuple(found)


def _sample(
    question: Question, timing: Timing, at: int, time: int, decisions: list[Decision]
) -> Sample:
    readings: dict[str, Reading] = {}
    effects = []
    for one in decisions:
        decider = question.deciders[one.decider]
        if is_plain(question, decider):
            continue
        used = names_used(question, decider, one.outcome)
        for entry in decider.entries:
            if entry.name in used and entry.name in one.taken.readings and entry.signal >= 0:
                reading = _reading(question, entry, one.taken.readings[entry.name])
                readings[reading.name] = reading
        effects.append(_effect(timing, at, one, _all_of(one, decisions), decider))
    return Sample(timing.seconds(time), tuple(readings.values()), tuple(dict.fromkeys(effects)))


def _all_of(one: Decision, decisions: list[Decision]) -> list[int]:
    """The outcomes that the same decision has."""
    kind = (one.decider, one.begins, one.is_denied)
    return [o.outcome for o in decisions if (o.decider, o.begins, o.is_denied) == kind]


def _effect(timing: Timing, at: int, one: Decision, outcomes: list[int], decider: Decider) -> str:
    if one.begins:
        return f"where {decider.name} begins to hold {decider.outcomes[one.outcome]}"
    starts = one.sampled + timing.responses[one.decider]
    ends = starts + timing.periods[one.decider]
    when = f"until {number(timing.seconds(ends))} s"
    if starts == at:
        when = f"from {number(timing.seconds(starts))} s"
    what = _said_not(decider, outcomes) if one.is_denied else said(decider, outcomes)
    return f"{what} {when}"


def _said_not(decider: Decider, outcomes: list[int]) -> str:
    """What is not decided, in words."""
    if decider.how is How.CONDITION:
        return f"{decider.name} does not act"
    names = listed([decider.outcomes[outcome] for outcome in outcomes], last="or")
    verb = "choose" if decider.how in {How.FIRST, How.ONE} else "let"
    return f"{decider.name} does not {verb} {names}" + (" hold" if verb == "let" else "")


def said(decider: Decider, outcomes: list[int]) -> str:
    """What is decided, in words."""
    names = listed([decider.outcomes[outcome] for outcome in outcomes], last="and")
    match decider.how:
        case How.CONDITION:
            return f"{decider.name} acts"
        case How.FIRST | How.ONE:
            return f"{decider.name} chooses {names}"
    return f"{decider.name} lets {names} hold"


def _reading(question: Question, entry: Entry, value: float) -> Reading:
    signal = question.signals[entry.signal]
    label = ""
    if signal.values:
        label = "none of its choices" if value < 0.0 else signal.values[round(value)]
    return Reading(signal.name, value, signal.unit, label)


def is_plain(question: Question, decider: Decider) -> bool:
    """Whether it always holds."""
    is_sure = decider.how is How.CONDITION and all(code.text == "1" for code in decider.codes)
    return is_sure and not any(may_inhibit(question, entry) for entry in decider.entries)


def names_used(question: Question, decider: Decider, outcome: int) -> set[str]:
    """What an outcome depends on, by name; what may keep the node from acting, too."""
    codes: list[Code] = [decider.codes[outcome]] if decider.codes else []
    places = [i for i, rule in enumerate(decider.rules) if rule.choice == outcome]
    if decider.how is How.FIRST and places:
        places = list(range(places[-1] + 1))
    for place in places:
        rule = decider.rules[place]
        codes += [code for code in (rule.when, rule.until) if code is not None]
    inhibiting = {entry.name for entry in decider.entries if may_inhibit(question, entry)}
    return inhibiting.union(*(names_in(tree_of(code)) for code in codes))


def _assumed(question: Question, decisions: list[Decision]) -> Iterable[str]:
    """What nobody outside decides, and so may never be."""
    for actor in (question.first, question.second):
        if actor.doubt:
            yield f"{actor.name} can act then ({actor.doubt})"
    for one in decisions:
        decider = question.deciders[one.decider]
        if decider.how is How.ONE:
            mode = decider.outcomes[one.outcome]
            yield f"{decider.name} is ever {'not ' if one.is_denied else ''}in {mode}"
        used = names_used(question, decider, one.outcome)
        for entry in decider.entries:
            if entry.name in used:
                yield from _assumed_of_setting(decider, entry, one.taken)
                yield from _assumed_of_reading(question, decider, entry, one.taken)


def _assumed_of_setting(decider: Decider, entry: Entry, taken: Taken) -> Iterable[str]:
    """Whether a choice sets it then, where one may."""
    name = f"{decider.name}'s {entry.name}"
    if entry.name in taken.settings:
        value = taken.settings[entry.name]
        yield f"a choice sets {Reading(name, value, entry.unit).text.replace(' is ', ' to ', 1)}"
    elif entry.sets:
        yield f"no choice sets {name} then"


def _assumed_of_reading(
    question: Question, decider: Decider, entry: Entry, taken: Taken
) -> Iterable[str]:
    """What a node tells, or keeps by itself."""
    value = taken.readings.get(entry.name)
    if value is None:
        return
    if entry.signal >= 0 and question.signals[entry.signal].told:
        yield f"{_reading(question, entry, value).text} at times"
    elif entry.signal < 0 and len(entry.values) != 1:
        label = entry.labels[round(value)] if entry.labels else ""
        yield Reading(f"{decider.name}'s {entry.name}", value, entry.unit, label).text


def help_of(question: Question, decisions: list[Decision]) -> str:
    """What would mend it; empty where that is not seen from the decisions."""
    if question.unless:
        who = listed([actor.name for actor in question.unless])
        parts = f"{question.first.name} and {question.second.name}"
        return f"let {who} act at all times that {parts} do, and answer no later than both"
    free = [
        actor.name
        for actor in (question.first, question.second)
        if all(is_plain(question, question.deciders[d]) for need in actor.needs for d, _ in need)
    ]
    if free:
        return f"nothing keeps {' or '.join(free)} from acting: name it in a choice of the arbiter"
    shared = [
        one
        for one in decisions
        if all(
            any((one.decider, one.outcome) in need for need in actor.needs)
            for actor in (question.first, question.second)
        )
    ]
    if shared:
        decider = question.deciders[shared[0].decider]
        choice = decider.outcomes[shared[0].outcome]
        return (
            f"let choice {choice} of {decider.name} name one of them, or resolve it by `priority`"
        )
    return ""

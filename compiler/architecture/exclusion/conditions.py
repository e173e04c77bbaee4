"""A question as formulas: what must hold of the numbers that are sampled for an outcome to hold.

Every number is named by what it is and by when: `s2@5` is signal 2 as it was last told at version
5, so that two deciders that see the same version share one name. What a node keeps by itself, and
which rules were holding before, are names of one decider's sample: `e0.1@3`, `h0.1@3`.

A choice may set what is wired to a signal. At each tick the node then has either the reading, whose
domain may keep it from acting, or one of the numbers that choices set: `c0.1@3` says which, 0 for
the reading. It is free, whatever the arbiters choose, so all that can happen is among the cases,
for nodes that act and for a combined behavior that does not; what is proved of all of them holds.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias, final

from compiler.architecture.codes import tree_of
from compiler.architecture.exclusion.formula import (
    EQUAL,
    LESS,
    MORE,
    ZERO,
    Formula,
    both,
    compared,
    denied,
    either,
    truth,
)
from compiler.architecture.exclusion.question import Decider, Entry, How, Limit, Question
from compiler.architecture.exclusion.search import Variable
from runtime.arbiter import Rule
from runtime.code import Code
from spec_schema.expressions.rewrite import substitute
from spec_schema.expressions.tree import Apply, Expr, Name, Number

FLAG: Final = Variable(0.0, 1.0, (0.0, 1.0))
SHORT: Final = 1.0 - 1e-9
"""A hair less than `lasts`, as in `runtime.arbitration.rules`."""


@final
@dataclass(frozen=True, slots=True)
class Taken:
    """What a decider's entries were at a tick, by name.

    readings: of the signal, or own value, of each entry. settings: what a choice had set.
    """

    readings: Mapping[str, float]
    settings: Mapping[str, float]


Version: TypeAlias = Callable[[int], int]
"""The version of a signal, by its place, that a sample sees."""


@final
@dataclass(frozen=True, slots=True)
class Sampled:
    """One decider at one of its ticks. stamp: tells ticks apart. version: of signals, there."""

    question: Question
    place: int
    stamp: int
    version: Version

    @property
    def decider(self) -> Decider:
        """Who decides."""
        return self.question.deciders[self.place]

    def name_of(self, entry: int) -> str:
        """What stands for an entry's signal, or own value."""
        signal = self.decider.entries[entry].signal
        if signal >= 0:
            return f"s{signal}@{self.version(signal)}"
        return f"e{self.place}.{entry}@{self.stamp}"

    def variables(self) -> dict[str, Variable]:
        """Every name that its formulas may hold, and what it may be."""
        found = {
            self.name_of(i): variable_of(self.question, entry)
            for i, entry in enumerate(self.decider.entries)
            if len(entry.values) != 1
        }
        for i, entry in enumerate(self.decider.entries):
            if entry.sets:
                ways = tuple(map(float, range(len(entry.sets) + 1)))
                found[self._way(i)] = Variable(ways[0], ways[-1], ways)
        for i, rule in enumerate(self.decider.rules):
            if remembers(rule, self.decider):
                found |= {self._flag("h", i): FLAG, self._flag("r", i): FLAG}
        return found

    def taken(self, values: Mapping[str, float]) -> Taken:
        """What its entries are where names have these values."""
        readings, settings = {}, {}
        for i, entry in enumerate(self.decider.entries):
            way = round(values.get(self._way(i), 0.0))
            if way > 0:
                settings[entry.name] = entry.sets[way - 1]
            elif self.name_of(i) in values:
                readings[entry.name] = values[self.name_of(i)]
        return Taken(readings, settings)

    def outcome(self, outcome: int) -> Formula:
        """Where an outcome holds, whatever rules held before."""
        return both((self.inside(), self._outcome(outcome)))

    def _outcome(self, outcome: int) -> Formula:
        decider = self.decider
        rules = [i for i, rule in enumerate(decider.rules) if rule.choice == outcome]
        match decider.how:
            case How.ONE | How.ANY:
                return True
            case How.NUMBERS:
                return compared(self.tree(decider.codes[outcome]), ZERO, MORE)
            case How.CONDITION:
                return self.truth(decider.codes[outcome])
            case How.ALL:
                return either(map(self.holding, rules))
            case How.FIRST:
                return either(map(self._first, rules))

    def holding(self, rule: int) -> Formula:
        """Where a rule holds, as `runtime.arbitration.rules.Latches` has it."""
        given = self.decider.rules[rule]
        starts = self.truth(given.when) if given.when is not None else True
        if not remembers(given, self.decider):
            return starts
        runs = given.lasts * SHORT > self.decider.period
        goes_on = either(
            (
                denied(self.truth(given.until)) if given.until is not None else False,
                truth(Name(self._flag("r", rule))) if runs else False,
            )
        )
        return either((starts, both((truth(Name(self._flag("h", rule))), goes_on))))

    def truth(self, code: Code) -> Formula:
        """Where code is true at this tick."""
        return truth(self.tree(code))

    def tree(self, code: Code) -> Expr:
        """The code, with what each name is at this tick."""
        known = {e.name: self._entry(i, e) for i, e in enumerate(self.decider.entries)}
        return substitute(tree_of(code), known)

    def _first(self, rule: int) -> Formula:
        return both((*(denied(self.holding(j)) for j in range(rule)), self.holding(rule)))

    def _entry(self, place: int, entry: Entry) -> Expr:
        if len(entry.values) == 1:
            return Number(entry.values[0])
        found = self._reading(place, entry)
        for way, value in enumerate(entry.sets, start=1):
            number = Number(min(max(value, entry.low), entry.high))
            found = Apply("where", (self._is_way(place, way), number, found))
        return found

    def _reading(self, place: int, entry: Entry) -> Expr:
        raw = self._raw(place, entry)
        if entry.signal < 0 or not leaves(self.question, entry):
            return raw
        if entry.limit is Limit.WRAPS:
            return wrapped(raw, entry.low, entry.high)
        return Apply("clip", (raw, Number(entry.low), Number(entry.high)))

    def _raw(self, place: int, entry: Entry) -> Expr:
        name = Name(self.name_of(place))
        if entry.signal < 0 or entry.scale == 1.0:
            return name
        if entry.scale == -1.0:
            return Apply("neg", (name,))
        return Apply("mul", (name, Number(entry.scale)))

    def inside(self) -> Formula:
        """Where nothing outside its domain keeps the node from acting, or deciding."""
        return both(
            either((self._is_read_inside(i, entry), *self._are_set_inside(i, entry)))
            for i, entry in enumerate(self.decider.entries)
            if may_inhibit(self.question, entry)
        )

    def _is_read_inside(self, place: int, entry: Entry) -> Formula:
        raw = self._raw(place, entry)
        parts = [truth(self._is_way(place, 0))] if entry.sets else []
        parts.append(compared(raw, Number(entry.low), EQUAL | MORE))
        parts.append(compared(raw, Number(entry.high), EQUAL | LESS))
        return both(parts)

    def _are_set_inside(self, place: int, entry: Entry) -> Iterator[Formula]:
        for way, value in enumerate(entry.sets, start=1):
            if entry.low <= value <= entry.high:
                yield truth(self._is_way(place, way))

    def _is_way(self, place: int, way: int) -> Expr:
        return Apply("eq", (Name(self._way(place)), Number(float(way))))

    def _way(self, entry: int) -> str:
        return f"c{self.place}.{entry}@{self.stamp}"

    def _flag(self, letter: str, rule: int) -> str:
        return f"{letter}{self.place}.{rule}@{self.stamp}"


def wrapped(raw: Expr, low: float, high: float) -> Expr:
    """A number turned into a range, in the very steps in which a node that samples does it."""
    first, last, turn = Number(low), Number(high), Number(high - low)
    turns = Apply("floor", (Apply("div", (Apply("sub", (raw, first)), turn)),))
    inside = Apply("and", (Apply("ge", (raw, first)), Apply("le", (raw, last))))
    turned = Apply("sub", (raw, Apply("mul", (turn, turns))))
    return Apply("where", (inside, raw, Apply("clip", (turned, first, last))))


def leaves(question: Question, entry: Entry) -> bool:
    """Whether the signal of an entry can be outside the entry's domain."""
    signal = question.signals[entry.signal]
    ends = sorted((signal.low * entry.scale, signal.high * entry.scale))
    return not (entry.low <= ends[0] and ends[1] <= entry.high)


def may_inhibit(question: Question, entry: Entry) -> bool:
    """Whether what an entry is can keep its node from acting, or deciding."""
    if entry.signal < 0 or entry.limit is not Limit.INHIBITS:
        return False
    is_set_outside = any(not entry.low <= value <= entry.high for value in entry.sets)
    return is_set_outside or leaves(question, entry)


def remembers(rule: Rule, decider: Decider) -> bool:
    """Whether it matters if the rule held before."""
    return rule.until is not None or rule.lasts * SHORT > decider.period


def has_memory(decider: Decider) -> bool:
    """Whether what it decides depends on what it read before."""
    return any(remembers(rule, decider) for rule in decider.rules)


def variable_of(question: Question, entry: Entry) -> Variable:
    """What an entry's signal, or own value, may be."""
    if entry.signal >= 0:
        signal = question.signals[entry.signal]
        options: tuple[float, ...] = ()
        if signal.values:
            options = tuple(map(float, range(round(signal.low), round(signal.high) + 1)))
        return Variable(signal.low, signal.high, options, signal.unit.scale)
    values = tuple(sorted(set(entry.values))) or tuple(map(float, range(len(entry.labels))))
    if values:
        return Variable(values[0], values[-1], values, entry.unit.scale)
    return Variable(entry.low, entry.high, (), entry.unit.scale)

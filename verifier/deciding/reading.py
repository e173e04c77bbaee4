"""The rules of an arbiter as they read, each in the light of those before it.

A rule decides only where no earlier one holds, so what that says anyway need not be said again.
"""

from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, final

from runtime.arbiter import Arbiter, Paradigm, Rule
from verifier.deciding.boxes import Box, boxes_of, is_covered
from verifier.deciding.conditions import (
    ALWAYS,
    All,
    Compared,
    Condition,
    Values,
    condition_of,
    denied,
    joined,
)

NOTHING_SET: Final[Values] = MappingProxyType({})


@final
@dataclass(frozen=True, slots=True)
class ReadRule:
    """A rule, or a layer, as it reads.

    place: from 0. when: what it says, without what follows from the rest and from no earlier rule
    holding. until: of hysteresis, else None. is_shorter: whether something was left out. decides:
    False where earlier rules cover all of it, so that it never does.
    """

    place: int
    choice: int
    when: Condition
    until: Condition | None
    lasts: float
    is_shorter: bool
    decides: bool
    origin: str


def values_of(arbiter: Arbiter, set_to: Values = NOTHING_SET) -> dict[str, float]:
    """SI values of constants, and of controls: those of `set_to`, else their defaults."""
    values = {control.name: control.default for control in arbiter.controls}
    return values | dict(set_to) | {each.name: each.value for each in arbiter.constants}


def read_rules(arbiter: Arbiter, set_to: Values = NOTHING_SET) -> tuple[ReadRule, ...]:
    """The rules of an arbiter in their order.

    Of a subsumption each layer is read by itself: one that is suppressed on a channel may act on
    another. A rule that latches (`until`, `lasts`) keeps all of its `when`: it begins to hold while
    an earlier rule decides, too, so that nothing of it is said twice. Numbers are taken for
    granted: a read that is none (NaN) fulfils no comparison, whatever is left out.
    """
    values = values_of(arbiter, set_to)
    # A control that another module sets is a quantity like those that are read.
    is_exclusive = arbiter.paradigm is Paradigm.RULES
    before: list[Box] = []
    found = []
    for place, rule in enumerate(arbiter.rules):
        found.append(_read(rule, place, values, before if is_exclusive else []))
        boxes = boxes_of(condition_of(rule.when), values)
        before += boxes or ()
    return tuple(found)


def _read(rule: Rule, place: int, values: Values, before: list[Box]) -> ReadRule:
    whole = condition_of(rule.when)
    latches = rule.until is not None or rule.lasts > 0.0
    short = whole if latches else shortened(whole, values, before)
    own = boxes_of(whole, values)
    decides = own is None or any(not is_covered(box, before) for box in own)
    until = None if rule.until is None else condition_of(rule.until)
    is_shorter = short != whole
    return ReadRule(place, rule.choice, short, until, rule.lasts, is_shorter, decides, rule.origin)


def shortened(condition: Condition, values: Values, before: list[Box]) -> Condition:
    """The condition without parts that hold wherever the others do and no box before does."""
    parts = list(condition.parts) if isinstance(condition, All) else [condition]
    for part in reversed(list(parts)):
        rest = [each for each in parts if each is not part]
        against = boxes_of(joined(All, [*rest, denied(part)]), values)
        if against is not None and all(is_covered(box, before) for box in against):
            parts = rest
    return joined(All, parts) if parts else ALWAYS


def comparisons_in(condition: Condition) -> tuple[Compared, ...]:
    """All comparisons, from left to right."""
    if isinstance(condition, Compared):
        return (condition,)
    return tuple(each for part in condition.parts for each in comparisons_in(part))

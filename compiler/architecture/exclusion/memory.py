"""What the rules of a decider remember from tick to tick, and what it decides by that."""

import math
from collections.abc import Iterator
from typing import TypeAlias

from compiler.architecture.exclusion.conditions import SHORT, Sampled
from compiler.architecture.exclusion.formula import Formula
from compiler.architecture.exclusion.question import Decider, How

Memory: TypeAlias = tuple[int, ...]
"""For each rule how many ticks it has held, -1 where it does not; no further than matters."""


def conditions_of(sampled: Sampled) -> Iterator[Formula]:
    """All that a decider's decision depends on, but its memory."""
    decider = sampled.decider
    yield sampled.inside()
    if decider.how in {How.FIRST, How.ALL}:
        for rule in decider.rules:
            yield sampled.truth(rule.when) if rule.when is not None else True
            yield sampled.truth(rule.until) if rule.until is not None else False
    elif decider.how is not How.ONE:
        for outcome in range(len(decider.outcomes)):
            yield sampled.outcome(outcome)


def decided(decider: Decider, memory: Memory, row: tuple[bool, ...]) -> tuple[Memory, int]:
    """The rules' new memory, and the outcomes that hold, as bits."""
    after = tuple(
        _held(decider, i, age, when=row[2 * i + 1], until=row[2 * i + 2])
        for i, age in enumerate(memory)
    )
    return after, _outcomes(decider, after, row)


def _outcomes(decider: Decider, memory: Memory, row: tuple[bool, ...]) -> int:
    """The outcomes that hold, as bits, where rules remember `memory` and conditions are `row`."""
    if not row[0]:
        return 0
    match decider.how:
        case How.FIRST:
            first = next((i for i, age in enumerate(memory) if age >= 0), None)
            return 0 if first is None else 1 << decider.rules[first].choice
        case How.ALL:
            found = 0
            for rule, age in zip(decider.rules, memory, strict=True):
                found |= (1 << rule.choice) if age >= 0 else 0
            return found
        case How.ONE:
            return (1 << len(decider.outcomes)) - 1
    return sum(1 << i for i, bit in enumerate(row[1:]) if bit)


def _held(decider: Decider, rule: int, age: int, *, when: bool, until: bool) -> int:
    """For how many ticks a rule holds after one more, as `runtime.arbitration.rules` has it."""
    given = decider.rules[rule]
    needed = math.ceil(given.lasts * SHORT / decider.period) if given.lasts > 0.0 else 0
    if age < 0:
        return 0 if when else -1
    age = min(age + 1, needed)
    is_released = not when and (given.until is None or until)
    return -1 if is_released and age >= needed else age

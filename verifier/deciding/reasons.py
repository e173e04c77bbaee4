"""What held a rule at a moment: the quantities in the parts of its condition that were true."""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arbiter import Arbiter
from runtime.arrays import Array
from runtime.code import Code
from runtime.machine import evaluate
from verifier.deciding.boxes import as_bound
from verifier.deciding.conditions import (
    All,
    Compared,
    Condition,
    Values,
    condition_of,
    open_extremes,
)
from verifier.deciding.reading import comparisons_in, values_of

NOBODY: Final = ""


@final
@dataclass(frozen=True, slots=True)
class Watched:
    """A quantity that conditions compare with numbers: its code, and those numbers in SI."""

    code: Code
    numbers: tuple[float, ...]


def held_by(arbiter: Arbiter, place: int, point: Array) -> tuple[str, ...] | None:
    """The reads and controls in what was true of a rule's `when` at a point (r,) of the register.

    None where it did not hold: then the rule went on from before.
    """
    names = arbiter.register[: len(arbiter.reads) + len(arbiter.controls)]
    found = _true_parts(condition_of(arbiter.rules[place].when), arbiter, point)
    if found is None:
        return None
    tokens = [t for part in found for code in (part.left, part.right) for t in code.tokens]
    return tuple(dict.fromkeys(token for token in tokens if token in names))


def _true_parts(condition: Condition, arbiter: Arbiter, point: Array) -> list[Compared] | None:
    """The comparisons that make it true; None where it is not."""
    if isinstance(condition, Compared):
        opened = open_extremes(condition)
        if not isinstance(opened, Compared):
            return _true_parts(opened, arbiter, point)
        code = Code(f"{condition.left.text} {condition.right.text} {condition.word}")
        return [condition] if evaluate([code], arbiter.register, point)[0] else None
    each = [_true_parts(part, arbiter, point) for part in condition.parts]
    true = [part for found in each if found is not None for part in found]
    holds = all if isinstance(condition, All) else any
    return true if holds(found is not None for found in each) else None


def watched_in(arbiter: Arbiter, set_to: Values) -> tuple[Watched, ...]:
    """The quantities that its rules compare with numbers, in the order in which they come.

    Of an arbiter without rules what it reads, with no numbers.
    """
    if not arbiter.rules:
        return tuple(Watched(Code(read.name), ()) for read in arbiter.reads)
    values = values_of(arbiter, set_to)
    found: dict[str, dict[float, None]] = {}
    for rule in arbiter.rules:
        for code in (rule.when, rule.until):
            condition = open_extremes(condition_of(code))
            for compared in comparisons_in(condition):
                bound = as_bound(compared, values)
                if bound is not None and bound[0] != NOBODY:
                    found.setdefault(bound[0], {})[bound[2]] = None
    return tuple(Watched(Code(text), tuple(numbers)) for text, numbers in found.items())


def course_of(arbiter: Arbiter, watched: Watched, register: Array) -> Array:
    """The quantity (T,) along a register (T, r)."""
    return np.asarray(evaluate([watched.code], arbiter.register, register)[:, 0])

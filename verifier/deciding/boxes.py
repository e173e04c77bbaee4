"""Boxes: what comparisons of quantities with numbers leave, and whether others cover it.

A quantity is whatever is compared with a number: a read, or an expression of several, which counts
as a quantity of its own. So "this box is covered" is true where it is said, and may go unsaid where
two expressions depend on one another.

A cut parts the line of numbers: (v, 0) just below v, (v, 1) just above it. An interval runs from a
cut to a later one, so that open and closed ends need no case of their own.
"""

from collections.abc import Iterator, Mapping, Sequence
from math import inf
from typing import Final, TypeAlias

import numpy as np

from runtime.code import Code
from runtime.machine import evaluate
from verifier.deciding.conditions import (
    TURNED,
    All,
    Compared,
    Condition,
    Some,
    Values,
    open_extremes,
)

Cut: TypeAlias = tuple[float, int]
Interval: TypeAlias = tuple[Cut, Cut]
Box: TypeAlias = Mapping[str, Interval]
"""By the text of a quantity's code the interval that it is in; others may be anything."""

LOWEST: Final[Cut] = (-inf, 0)
HIGHEST: Final[Cut] = (inf, 1)
NO_NAME: Final = " "
"""An entry of the register that no code can read."""
MOST_BOXES: Final = 400
"""A condition of more is not looked through."""
MOST_STEPS: Final = 4000
"""So many boxes may be cut before "covered" is no longer said."""


def boxes_of(condition: Condition, values: Values) -> tuple[Box, ...] | None:
    """The boxes of which a condition is the union; None where it is none, or of too many.

    values: SI, of the names that stand for a number.
    """
    found = _boxes(open_extremes(condition), values)
    return None if found is None else tuple(found)


def _boxes(condition: Condition, values: Values) -> list[Box] | None:
    match condition:
        case Compared():
            return _of_comparison(condition, values)
        case Some(parts):
            each = [_boxes(part, values) for part in parts]
            if any(one is None for one in each):
                return None
            union = [box for one in each if one is not None for box in one]
            return union if len(union) <= MOST_BOXES else None
        case All(parts):
            met: list[Box] = [{}]
            for part in parts:
                other = _boxes(part, values)
                if other is None or len(met) * len(other) > MOST_BOXES:
                    return None
                pairs = (common(a, b) for a in met for b in other)
                met = [box for box in pairs if box is not None]
            return met


def _of_comparison(compared: Compared, values: Values) -> list[Box] | None:
    known = as_bound(compared, values)
    if known is None:
        return None
    name, word, number = known
    if not name:
        return [{}] if word == "gt" else []
    return [{name: interval} for interval in intervals_of(word, number)]


def as_bound(compared: Compared, values: Values) -> tuple[str, str, float] | None:
    """A comparison as quantity, word and number; None where both sides read.

    Where neither reads, the quantity is empty and the word says whether it holds: gt for yes.
    """
    sides = [value_of(side, values) for side in (compared.left, compared.right)]
    match sides:
        case [float(left), float(right)]:
            names: tuple[str, ...] = ("a", "b")
            code = Code(f"a b {compared.word}")
            is_true = bool(evaluate([code], names, np.array([left, right]))[0])
            return "", "gt" if is_true else "lt", 0.0
        case [None, float(right)]:
            return compared.left.text, compared.word, right
        case [float(left), None]:
            return compared.right.text, TURNED[compared.word], left
        case _:
            return None


def value_of(code: Code, values: Values) -> float | None:
    """What code is worth that reads nothing; None where it does."""
    # The machine wants at least one entry: an arbiter may have no constant at all.
    names = (NO_NAME, *values)
    register = np.array([0.0, *values.values()])
    try:
        return float(evaluate([code], names, register)[0])
    except ValueError:  # it reads
        return None


def intervals_of(word: str, number: float) -> list[Interval]:
    """Where a comparison with a number holds."""
    below, above = (number, 0), (number, 1)
    match word:
        case "lt":
            return [(LOWEST, below)]
        case "le":
            return [(LOWEST, above)]
        case "gt":
            return [(above, HIGHEST)]
        case "ge":
            return [(below, HIGHEST)]
        case "eq":
            return [(below, above)]
        case _:
            return [(LOWEST, below), (above, HIGHEST)]


def common(a: Box, b: Box) -> Box | None:
    """What two boxes have in common; None for nothing."""
    found = dict(a)
    for name, (low, high) in b.items():
        own = found.get(name, (LOWEST, HIGHEST))
        met = max(own[0], low), min(own[1], high)
        if met[0] >= met[1]:
            return None
        found[name] = met
    return found


def is_covered(box: Box, others: Sequence[Box]) -> bool:
    """Whether every point of the box lies in one of the others; False where that took too long."""
    left = [box]
    for other in others:
        rest: list[Box] = []
        for one in left:
            rest += _without(one, other)
            if len(rest) > MOST_STEPS:
                return False
        left = rest
    return not left


def _without(box: Box, other: Box) -> Iterator[Box]:
    """The box without another one, in pieces."""
    if common(box, other) is None:
        yield box
        return
    inner = dict(box)
    for name, (low, high) in other.items():
        own = inner.get(name, (LOWEST, HIGHEST))
        if own[0] < low:
            yield {**inner, name: (own[0], low)}
        if high < own[1]:
            yield {**inner, name: (high, own[1])}
        inner[name] = max(own[0], low), min(own[1], high)

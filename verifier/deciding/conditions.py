"""Conditions as trees: comparisons, put together by `and` and `or`; code is postfix text.

`not` is worked into the comparisons, which is exact for numbers: not (a < b) is a >= b.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, TypeAlias, final

from runtime.code import ARITY, Code

OPPOSITE: Final = MappingProxyType(
    {"lt": "ge", "le": "gt", "gt": "le", "ge": "lt", "eq": "ne", "ne": "eq"}
)
TURNED: Final = MappingProxyType(
    {"lt": "gt", "le": "ge", "gt": "lt", "ge": "le", "eq": "eq", "ne": "ne"}
)
ZERO: Final = Code("0")


@final
@dataclass(frozen=True, slots=True)
class Compared:
    """`left` compared with `right`; word: lt, le, gt, ge, eq or ne."""

    left: Code
    word: str
    right: Code


@final
@dataclass(frozen=True, slots=True)
class All:
    """Every one of `parts` holds; without parts it always does."""

    parts: tuple["Condition", ...]


@final
@dataclass(frozen=True, slots=True)
class Some:
    """At least one of `parts` holds; without parts none ever does."""

    parts: tuple["Condition", ...]


Condition: TypeAlias = Compared | All | Some
ALWAYS: Final = All(())


def condition_of(code: Code | None) -> Condition:
    """The tree of a condition; None is what always holds.

    >>> condition_of(Code("ahead near lt not"))
    Compared(left=Code(text='ahead'), word='ge', right=Code(text='near'))
    """
    if code is None:
        return ALWAYS
    return _tree(parsed(code), is_denied=False)


@final
@dataclass(frozen=True, slots=True)
class Step:
    """A word of code with what it is applied to."""

    word: str
    operands: tuple["Step", ...]

    @property
    def code(self) -> Code:
        """As postfix text again."""
        return Code(" ".join([*(each.code.text for each in self.operands), self.word]))


def parsed(code: Code) -> Step:
    """Postfix code as a tree."""
    stack: list[Step] = []
    for word in code.tokens:
        start = len(stack) - ARITY.get(word, 0)
        operands = tuple(stack[start:])
        del stack[start:]
        stack.append(Step(word, operands))
    return stack[0]


def _tree(step: Step, *, is_denied: bool) -> Condition:
    if step.word in OPPOSITE:
        left, right = step.operands
        return Compared(left.code, OPPOSITE[step.word] if is_denied else step.word, right.code)
    if step.word == "not":
        return _tree(step.operands[0], is_denied=not is_denied)
    if step.word in {"and", "or"}:
        parts = [_tree(each, is_denied=is_denied) for each in step.operands]
        return joined(All if (step.word == "and") != is_denied else Some, parts)
    number = _number(step.word)
    if number is not None:
        return ALWAYS if (number != 0.0) != is_denied else Some(())
    return Compared(step.code, "eq" if is_denied else "ne", ZERO)


def joined(sort: type[All] | type[Some], parts: Sequence[Condition]) -> Condition:
    """Parts of one sort in one; a single part is itself."""
    flat: list[Condition] = []
    for part in parts:
        flat += part.parts if isinstance(part, sort) else (part,)
    return flat[0] if len(flat) == 1 else sort(tuple(flat))


def denied(condition: Condition) -> Condition:
    """What holds where the condition does not."""
    match condition:
        case Compared(left, word, right):
            return Compared(left, OPPOSITE[word], right)
        case All(parts):
            return joined(Some, [denied(part) for part in parts])
        case Some(parts):
            return joined(All, [denied(part) for part in parts])


def open_extremes(condition: Condition) -> Condition:
    """The same without `min` and `max` as a side: min(a, b) < c is a < c or b < c."""
    match condition:
        case Compared():
            return _opened(condition)
        case All(parts):
            return joined(All, [open_extremes(part) for part in parts])
        case Some(parts):
            return joined(Some, [open_extremes(part) for part in parts])


def _opened(compared: Compared) -> Condition:
    left, right, word = parsed(compared.left), parsed(compared.right), compared.word
    if word in {"eq", "ne"}:
        return compared
    if left.word not in {"min", "max"}:
        if right.word not in {"min", "max"}:
            return compared
        left, right, word = right, left, TURNED[word]
    is_below = word in {"lt", "le"}
    sort = Some if (left.word == "min") == is_below else All
    return joined(sort, [_opened(Compared(each.code, word, right.code)) for each in left.operands])


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def with_each(condition: Condition, change: Callable[[Compared], Condition]) -> Condition:
    """The condition with each comparison changed."""
    match condition:
        case Compared():
            return change(condition)
        case All(parts):
            return joined(All, [with_each(part, change) for part in parts])
        case Some(parts):
            return joined(Some, [with_each(part, change) for part in parts])


Values: TypeAlias = Mapping[str, float]
"""Of names that stand for one number, in SI: constants, and controls as they are set."""

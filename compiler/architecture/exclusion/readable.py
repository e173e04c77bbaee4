"""What deciders that tick together can find: which of their conditions hold at once.

What can be read is known beforehand, as the combinations of conditions that some numbers fulfil.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final, TypeAlias, final

from compiler.architecture.exclusion.conditions import Sampled, Taken
from compiler.architecture.exclusion.formula import Formula, both, denied, holds
from compiler.architecture.exclusion.memory import conditions_of
from compiler.architecture.exclusion.question import Question
from compiler.architecture.exclusion.search import Found, Open, solve

MOST_PATTERNS: Final = 256
BUDGET: Final = 300

Row: TypeAlias = tuple[bool, ...]
"""Which of a decider's conditions hold (`memory.conditions_of`)."""


@final
@dataclass(frozen=True, slots=True)
class Pattern:
    """Which conditions of some deciders hold together (one row each), and what they took there."""

    rows: tuple[Row, ...]
    taken: tuple[Taken, ...]


def patterns(question: Question, deciders: tuple[int, ...]) -> tuple[list[Pattern], bool]:
    """What deciders that tick together can find, and whether that is all."""
    many = [Sampled(question, d, 0, lambda _signal: 0) for d in deciders]
    rows = [list(conditions_of(sampled)) for sampled in many]
    flat = [formula for row in rows for formula in row]
    variables = {k: v for sampled in many for k, v in sampled.variables().items()}
    found: list[Pattern] = []
    is_all = True
    waiting: list[tuple[Row, Found | None]] = [((), None)]
    while waiting:
        bits, point = waiting.pop()
        if point is None or not holds(_together(flat, bits), point.values):
            answer = solve(_together(flat, bits), variables, BUDGET)
            is_all &= not isinstance(answer, Open)
            if not isinstance(answer, Found):
                continue
            point = answer
        if len(bits) < len(flat):
            waiting += [((*bits, bit), point) for bit in (False, True)]
            continue
        if len(found) == MOST_PATTERNS:
            return found, False
        taken = tuple(sampled.taken(point.values) for sampled in many)
        found.append(Pattern(tuple(_split(bits, map(len, rows))), taken))
    return found, is_all


def _together(formulas: list[Formula], bits: Row) -> Formula:
    pairs = zip(formulas, bits, strict=False)
    return both(formula if bit else denied(formula) for formula, bit in pairs)


def _split(bits: Row, sizes: Iterable[int]) -> Iterator[Row]:
    start = 0
    for size in sizes:
        yield bits[start : start + size]
        start += size

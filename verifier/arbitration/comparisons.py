"""The thresholds in an arbiter's conditions: comparisons of what is read with what is not.

A condition is postfix code. Each comparison one side of which reads nothing is a threshold: that
side is taken out, and put in again as an entry of the register whose value may be moved.
"""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final, final

from runtime.arbiter import Arbiter, Rule
from runtime.code import ARITY, Code

COMPARING: Final = {"lt": "<", "le": "<=", "gt": ">", "ge": ">="}
TURNED: Final = {"lt": "gt", "le": "ge", "gt": "lt", "ge": "le"}
SIGNS: Final = {"add": "+", "sub": "-", "mul": "*", "div": "/"}


@final
@dataclass(frozen=True, slots=True)
class Comparison:
    """`reading` compared with the value of `side`, which reads nothing.

    entry: the name that stands for the side's value. word: lt, le, gt or ge, `reading` first.
    origin: of the rule.
    """

    reading: Code
    word: str
    side: Code
    entry: str
    origin: str

    @property
    def text(self) -> str:
        """As a person writes it: `left < near`."""
        return f"{infix(self.reading)} {COMPARING[self.word]} {infix(self.side)}"


@final
@dataclass(frozen=True, slots=True)
class Opened:
    """Rules whose thresholds are entries, which `comparisons` name.

    Equal sides share one; those that are bare numbers do where they meet the same reading.
    """

    rules: tuple[Rule, ...]
    comparisons: tuple[Comparison, ...]

    @property
    def entries(self) -> tuple[str, ...]:
        """Of the thresholds, each once."""
        return tuple(dict.fromkeys(each.entry for each in self.comparisons))


def opened(arbiter: Arbiter, moving: Collection[str] = ()) -> Opened:
    """The arbiter's rules with their thresholds taken out.

    moving: the controls that others set meanwhile; what depends on them is no threshold.
    """
    reads = frozenset((*(read.name for read in arbiter.reads), *moving))
    entries: dict[str, str] = {}
    found: list[Comparison] = []
    rules = []
    for rule in arbiter.rules:
        codes = []
        for code in (rule.when, rule.until):
            made = None if code is None else _opened(code, reads, entries, found, rule.origin)
            codes.append(made)
        rules.append(replace(rule, when=codes[0], until=codes[1]))
    return Opened(tuple(rules), tuple(found))


def _opened(
    code: Code,
    reads: frozenset[str],
    entries: dict[str, str],
    found: list[Comparison],
    origin: str,
) -> Code:
    stack: list[str] = []
    for word, operands in _steps(code, stack):
        if word in COMPARING:
            sides = _compared(word, operands, reads, entries, found, origin)
            stack.append(" ".join([*sides, word]))
        else:
            stack.append(" ".join([*operands, word]))
    return Code(stack[0])


def _compared(
    word: str,
    operands: Sequence[str],
    reads: frozenset[str],
    entries: dict[str, str],
    found: list[Comparison],
    origin: str,
) -> Sequence[str]:
    """The operands, with the side that reads nothing as an entry of its own."""
    does_read = [bool(reads & set(side.split(" "))) for side in operands]
    if does_read == [True, False]:
        reading, side = operands
        entry = _entry(reading, side, entries)
        found.append(Comparison(Code(reading), word, Code(side), entry, origin))
        return reading, entry
    if does_read == [False, True]:
        side, reading = operands
        entry = _entry(reading, side, entries)
        found.append(Comparison(Code(reading), TURNED[word], Code(side), entry, origin))
        return entry, reading
    return operands


def _entry(reading: str, side: str, entries: dict[str, str]) -> str:
    """The entry of a threshold: that 0.5 stands in two rules does not make it one number."""
    key = f"{reading} {side}" if is_number(side) else side
    return entries.setdefault(key, f"threshold.{len(entries)}")


def is_number(text: str) -> bool:
    """Whether a side of a comparison is a bare number, without a name."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def _steps(code: Code, stack: list[str]) -> Iterator[tuple[str, Sequence[str]]]:
    """Each token with its operands, taken from the stack."""
    for word in code.tokens:
        count = ARITY.get(word, 0)
        operands = stack[len(stack) - count :]
        del stack[len(stack) - count :]
        yield word, operands


def infix(code: Code) -> str:
    """Code as a person writes it.

    >>> infix(Code("near margin add"))
    'near + margin'
    """
    stack: list[str] = []
    for word, operands in _steps(code, stack):
        if word in SIGNS:
            left, right = (f"({o})" if " " in o else o for o in operands)
            stack.append(f"{left} {SIGNS[word]} {right}")
        elif word == "neg":
            stack.append(f"-{operands[0]}")
        elif operands:
            stack.append(f"{word}({', '.join(operands)})")
        else:
            stack.append(word)
    return stack[0]

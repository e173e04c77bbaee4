"""The sentences of `require:`, signal temporal logic in words (Maler, Nickovic 2004).

`always (r.clearance > 1 cm)`, `eventually within 60 s r.lamp.light > 5 lx`, `if r.bumper.hit == 1
then eventually within 2 s r.speed < 0`. A prefix reaches over the one thing that follows it; where
`and`, `or` or `until` could be meant to be inside, brackets are asked for.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final, TypeAlias, final

from spec_schema.expressions.printers.numerals import numeral
from spec_schema.expressions.printers.text import to_text
from spec_schema.expressions.tree import COMPARISONS, FUNCTIONS, Apply, Expr, Name, walk
from spec_schema.faults import Fault, UnitFault
from spec_schema.requirement_comparisons import compared, moved
from spec_schema.requirement_words import (
    KEYWORDS,
    TEMPORAL,
    WINDOWS,
    RequirementError,
    Word,
    words_of,
)
from spec_schema.suggest import did_you_mean
from spec_schema.units import parse_unit, quantity_in
from spec_schema.wording import quoted

SECOND: Final = parse_unit("s")
DEEPEST: Final = 40
"""Formulas within formulas."""
IF: Final = "write e.g. `if r.x > 1 m then r.speed == 0 m/s`"
FROM: Final = "write e.g. `from 5 s to 60 s`"


@final
@dataclass(frozen=True, slots=True)
class Predicate:
    """A comparison; its names may be dotted (`r.lamp.light`) or quantities (`5 cm`)."""

    condition: Expr
    start: int = field(default=0, compare=False)
    end: int = field(default=0, compare=False)


@final
@dataclass(frozen=True, slots=True)
class Compound:
    """`not and or implies always eventually until` over one or two sentences.

    first, last: the window of a temporal operator, in seconds; None for the rest of the run.
    """

    operator: str
    parts: tuple["Sentence", ...]
    first: float = 0.0
    last: float | None = None


Sentence: TypeAlias = Predicate | Compound


def read_requirement(text: str) -> Sentence:
    """What a sentence says.

    Raises:
        RequirementError: a word that does not belong where it stands, or a comparison that can't
            be read.

    >>> read_requirement("always within 5 s r.x > 2").operator
    'always'
    """
    reading = _Reading(text)
    sentence = reading.formula(0)
    reading.end()
    return sentence


def is_quantity(name: str) -> bool:
    """Whether a name of a predicate is a number with its unit."""
    return name[:1].isdigit() or name[:1] == "."


def predicates_of(sentence: Sentence) -> Iterator[Predicate]:
    """The comparisons of a sentence, from left to right."""
    waiting = [sentence]
    while waiting:
        part = waiting.pop()
        if isinstance(part, Predicate):
            yield part
        else:
            waiting.extend(reversed(part.parts))


def names_of(sentence: Sentence) -> tuple[Name, ...]:
    """Every name that is no quantity, where it stands."""
    return tuple(
        node
        for predicate in predicates_of(sentence)
        for node in walk(predicate.condition)
        if isinstance(node, Name) and not is_quantity(node.name)
    )


def to_sentence(sentence: Sentence) -> str:
    """The sentence as text that reads back as the same.

    >>> to_sentence(read_requirement("not (a.x>1 and (b.x) < 2)"))
    'not (a.x > 1 and b.x < 2)'
    """
    if isinstance(sentence, Predicate):
        return to_text(sentence.condition)
    parts = [_in_brackets(part) for part in sentence.parts]
    match sentence.operator:
        case "implies":
            return f"if {parts[0]} then {parts[1]}"
        case "not":
            return f"not {parts[0]}"
        case "and" | "or" as word:
            return f"{parts[0]} {word} {parts[1]}"
        case "until":
            return f"{parts[0]} until {_window(sentence)}{parts[1]}"
    return f"{sentence.operator} {_window(sentence)}{parts[0]}"


def _in_brackets(sentence: Sentence) -> str:
    text = to_sentence(sentence)
    return text if isinstance(sentence, Predicate) else f"({text})"


def _window(sentence: Compound) -> str:
    if sentence.last is None:
        return f"after {numeral(sentence.first)} s " if sentence.first else ""
    if sentence.first == 0.0:
        return f"within {numeral(sentence.last)} s "
    return f"from {numeral(sentence.first)} s to {numeral(sentence.last)} s "


@final
class _Reading:
    """The words of a sentence, read from left to right."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._words, faults = words_of(text)
        self._next = 0
        if faults:
            raise RequirementError(*faults)

    def formula(self, depth: int) -> Sentence:
        """An implication, or what is joined by `or`."""
        if depth > DEEPEST:
            raise self._fault("S370", "the sentence nests too deep", "say it in several sentences")
        if not self._take("if"):
            return self._joined("or", depth)[0]
        premise = self._joined("or", depth)[0]
        if not self._take("then"):
            raise self._fault("S370", f"after `if ...` comes `then`, not {self._shown()}", IF)
        return Compound("implies", (premise, self.formula(depth + 1)))

    def end(self) -> None:
        """Nothing may follow."""
        word = self._here()
        if word is None:
            return
        if word.text in WINDOWS:
            raise self._misplaced_window()
        joined = "join two by `and`, `or` or `until`"
        remedy = "remove it, or open a bracket" if word.text == ")" else joined
        raise self._fault("S370", f"the sentence should end before {self._shown()}", remedy)

    def _joined(self, word: str, depth: int) -> tuple[Sentence, bool]:
        """What is joined by `or`, by `and`, or by `until`; whether it ends in an open prefix."""
        tighter = {"or": "and", "and": "until", "until": ""}[word]
        left, is_open = self._joined(tighter, depth) if tighter else self._unary(depth)
        while (here := self._here()) is not None and here.text == word:
            if is_open:
                raise self._ambiguous(here)
            self._next += 1
            first, last = self._window() if word == "until" else (0.0, None)
            right, is_open = self._joined(tighter, depth) if tighter else self._unary(depth)
            left = Compound(word, (left, right), first, last)
            is_open = is_open or word == "until"
        return left, is_open

    def _unary(self, depth: int) -> tuple[Sentence, bool]:
        word = self._here()
        if depth > DEEPEST:
            raise self._fault("S370", "the sentence nests too deep", "say it in several sentences")
        if word is not None and word.text == "not":
            self._next += 1
            inner, is_open = self._unary(depth + 1)
            return Compound("not", (inner,)), is_open
        if word is not None and word.text in TEMPORAL:
            self._next += 1
            first, last = self._window()
            following = self._here()
            if following is not None and following.text == "if":
                return Compound(word.text, (self.formula(depth + 1),), first, last), True
            inner, _ = self._unary(depth + 1)
            return Compound(word.text, (inner,), first, last), True
        if word is not None and word.text == "(" and self._is_group():
            self._next += 1
            inner = self.formula(depth + 1)
            if not self._take(")"):
                raise self._fault(
                    "S370", f"a bracket should close before {self._shown()}", "add ')'"
                )
            return inner, False
        return self._predicate(), False

    def _window(self) -> tuple[float, float | None]:
        """When a temporal operator looks, in seconds from now."""
        word = self._here()
        if self._take("within"):
            return 0.0, self._time()
        if self._take("after"):
            return self._time(), None
        if not self._take("from"):
            return 0.0, None
        first = self._time()
        if not self._take("to"):
            raise self._fault("S373", f"after `from` comes `to`, not {self._shown()}", FROM)
        last = self._time()
        if last <= first:
            assert word is not None, "`from` was read"
            end = self._words[self._next - 1].end
            message = "the window ends before it begins"
            raise RequirementError(Fault(word.start, end, "S373", message, "exchange the two"))
        return first, last

    def _time(self) -> float:
        word = self._here()
        if word is None or not word.is_quantity:
            remedy = "write it as in `within 60 s`"
            raise self._fault("S373", f"a window is told by times, not {self._shown()}", remedy)
        self._next += 1
        try:
            return quantity_in(word.text, SECOND)
        except UnitFault as error:
            raise RequirementError(moved(error.fault, word.start)) from None

    def _predicate(self) -> Sentence:
        self._refuse_misspelled()
        begin, depth = self._next, 0
        while (word := self._here()) is not None:
            if depth == 0 and (word.text in KEYWORDS or word.text == ")"):
                break
            depth += {"(": 1, ")": -1}.get(word.text, 0)
            self._next += 1
        words = self._words[begin : self._next]
        if not words:
            here = self._here()
            if here is not None and here.text in WINDOWS:
                raise self._misplaced_window()
            remedy = "write e.g. `r.clearance > 5 cm`"
            raise self._fault("S370", f"a comparison is wanted before {self._shown()}", remedy)
        condition = compared(self._text, words)
        return _links(condition, words[0].start, words[-1].end)

    def _refuse_misspelled(self) -> None:
        """A bare word that is nearly a keyword."""
        word = self._here()
        if word is not None and word.is_name and "." not in word.text:
            meant = did_you_mean(word.text, sorted(KEYWORDS))
            if meant and word.text not in FUNCTIONS | KEYWORDS:
                raise self._fault("S370", f"{quoted(word.text)} is no word of requirements", meant)

    def _is_group(self) -> bool:
        """Whether the bracket here holds a formula, not a part of an expression."""
        depth = 0
        for word in self._words[self._next :]:
            depth += {"(": 1, ")": -1}.get(word.text, 0)
            if word.text in KEYWORDS or word.text in COMPARISONS.values():
                return True
            if depth == 0:
                return False
        return False

    def _here(self) -> Word | None:
        return self._words[self._next] if self._next < len(self._words) else None

    def _take(self, text: str) -> bool:
        word = self._here()
        taken = word is not None and word.text == text
        self._next += taken
        return taken

    def _shown(self) -> str:
        word = self._here()
        return quoted(word.text) if word is not None else "the end"

    def _fault(self, code: str, message: str, remedy: str) -> RequirementError:
        word = self._here()
        end = len(self._text)
        start, stop = (word.start, word.end) if word is not None else (max(0, end - 1), end)
        return RequirementError(Fault(start, max(stop, start + 1), code, message, remedy))

    def _misplaced_window(self) -> RequirementError:
        remedy = "write `eventually within 60 s ...`"
        message = "a window stands right after `always`, `eventually` or `until`"
        return self._fault("S373", message, remedy)

    def _ambiguous(self, word: Word) -> RequirementError:
        message = f"it is open whether {quoted(word.text)} is inside what stands before it"
        remedy = f"use brackets: `always (a {word.text} b)`, or `(always a) {word.text} b`"
        return RequirementError(Fault(word.start, word.end, "S372", message, remedy))


def _links(condition: Expr, start: int, end: int) -> Sentence:
    """A comparison, or the two of a chain such as `0 < x < 1`."""
    if isinstance(condition, Apply) and condition.op == "and":
        one, two = (_links(part, start, end) for part in condition.operands)
        return Compound("and", (one, two))
    return Predicate(condition, start, end)

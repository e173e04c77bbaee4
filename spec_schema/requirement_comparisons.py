"""Expressions over a run, of names such as `r.lamp.light` and `5 cm`; comparisons among them.

The reader of expressions knows neither dots nor units. So it is given the text with stand-ins of
the same lengths in their places, and what it says is told of the names that were meant.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from spec_schema.expressions.parse import parse
from spec_schema.expressions.tree import COMPARISONS, Apply, Expr, Name, fold
from spec_schema.faults import ExpressionError, Fault, UnitFault
from spec_schema.requirement_words import KEYWORDS, RequirementError, Word, words_of
from spec_schema.units import parse_quantity

SENTENCES: Final = KEYWORDS - {"not", "and", "or"}
"""Words that stand in sentences alone."""


def compared(text: str, words: list[Word]) -> Expr:
    """The comparison that some words make, placed in the whole sentence `text`.

    Raises:
        RequirementError: they can't be read, or compare nothing.
    """
    condition, faults = _read(text, words)
    if not _is_comparison(condition):
        remedy = "compare two quantities: `r.clearance > 5 cm`"
        start, end = words[0].start, words[-1].end
        faults.append(Fault(start, end, "S374", "nothing is compared here", remedy))
    if faults:
        raise RequirementError(*faults)
    return condition


def quantified(text: str) -> Expr:
    """The expression over a run that a whole text is: `hypot(r.x - 5 m, r.y)`.

    Raises:
        RequirementError: it can't be read, or says more than an expression can.
    """
    words, faults = words_of(text, "an expression over a run")
    faults += [_of_sentences(word) for word in words if word.text in SENTENCES]
    if faults:
        raise RequirementError(*faults)
    if not words:
        raise RequirementError(Fault(0, 1, "S370", "nothing is measured here", "name a quantity"))
    expr, faults = _read(text, words)
    if faults:
        raise RequirementError(*faults)
    return expr


def _of_sentences(word: Word) -> Fault:
    message = f"'{word.text}' is a word of sentences, and an expression belongs here"
    return Fault(word.start, word.end, "S370", message, "a sentence is measured by `robustness`")


def _read(text: str, words: list[Word]) -> tuple[Expr, list[Fault]]:
    """The expression that words make, and what is wrong with its units.

    Raises:
        RequirementError: they can't be read.
    """
    start, end = words[0].start, words[-1].end
    named = [word for word in words if word.is_quantity or ("." in word.text and word.is_name)]
    stand_ins = _stand_ins([word.end - word.start for word in named], text)
    shown, back = text[start:end], {}
    for word, stand_in in zip(named, stand_ins, strict=True):
        shown = shown[: word.start - start] + stand_in + shown[word.end - start :]
        back[stand_in] = word.text
    try:
        tree = parse(shown)
    except ExpressionError as error:
        raise RequirementError(*(_named(moved(f, start), back) for f in error.faults)) from None
    faults = list(_bad_units([word for word in named if word.is_quantity]))
    return _with_names(tree, back, start), faults


def moved(fault: Fault, by: int) -> Fault:
    """The fault, so many characters further on."""
    return replace(fault, start=fault.start + by, end=fault.end + by)


def _is_comparison(condition: Expr) -> bool:
    if not isinstance(condition, Apply):
        return False
    if condition.op == "and":
        return all(map(_is_comparison, condition.operands))
    return condition.op in COMPARISONS


def _bad_units(words: list[Word]) -> Iterator[Fault]:
    for word in words:
        try:
            parse_quantity(word.text)
        except UnitFault as error:
            yield moved(error.fault, word.start)


def _stand_ins(lengths: list[int], text: str) -> list[str]:
    """Names of given lengths, each another one, and none that stands in the text."""
    found: list[str] = []
    for length in lengths:
        digits = length - 1
        name = next(
            name
            for first in "QZXWKJHGYVUTSRPONMLFEDCBA"
            for count in range(min(36**digits, 1000))
            for name in [first + _in_base_36(count).rjust(digits, "0")]
            if name not in found and name not in text
        )
        found.append(name)
    return found


def _in_base_36(number: int) -> str:
    signs = "0123456789abcdefghijklmnopqrstuvwxyz"
    return signs[number] if number < 36 else _in_base_36(number // 36) + signs[number % 36]


def _with_names(tree: Expr, back: dict[str, str], offset: int) -> Expr:
    """The tree with the names that were meant, placed in the whole sentence."""

    def placed(node: Expr, operands: tuple[Expr, ...]) -> Expr:
        start, end = node.start + offset, node.end + offset
        if isinstance(node, Name):
            return Name(back.get(node.name, node.name), start, end)
        if isinstance(node, Apply):
            mark = (node.mark[0] + offset, node.mark[1] + offset)
            return Apply(node.op, operands, start, end, mark)
        return replace(node, start=start, end=end)

    return fold(tree, placed)


def _named(fault: Fault, back: dict[str, str]) -> Fault:
    message, remedy = fault.message, fault.help
    for stand_in, meant in back.items():
        message, remedy = message.replace(stand_in, meant), remedy.replace(stand_in, meant)
    return replace(fault, message=message, help=remedy)

"""`if c then a else b`: how other languages choose between two values, and what to write here."""

from collections.abc import Sequence
from typing import Protocol

from spec_schema.faults import Fault

OPENING = frozenset("([{")
CLOSING = frozenset(")]}")


class Piece(Protocol):
    """A piece of the text and where it stands."""

    @property
    def text(self) -> str:
        """What is written."""
        ...

    @property
    def start(self) -> int:
        """The offset of its first character."""
        ...

    @property
    def end(self) -> int:
        """The offset after its last character."""
        ...


def choice_in(text: str, tokens: Sequence[Piece]) -> Fault | None:
    """The fault of the first `if ... then` or `if(...)`; None where there is none.

    Python's own `a if c else b` has no `then`, and is refused where the tree is read.
    """
    for i, token in enumerate(tokens):
        if token.text == "if" and (i == 0 or tokens[i - 1].text in {*OPENING, ",", "=", "else"}):
            end = _end(tokens, i)
            stop = tokens[end - 1].end
            written = _where(text, tokens, i, end)
            what = "'if ... then ... else'"
            if written is None and i + 1 < end and tokens[i + 1].text == "(":
                what, written = "'if(...)'", f"where{text[tokens[i + 1].start : stop]}"
            advice = f"write {written or 'where(c, a, b)'}"
            return Fault(token.start, stop, "S134", f"{what} is not part of the language", advice)
    return None


def _end(tokens: Sequence[Piece], start: int) -> int:
    """The index after the last token of what begins at `start`: up to a bracket or comma of it."""
    depth = 0
    for k in range(start, len(tokens)):
        depth += (tokens[k].text in OPENING) - (tokens[k].text in CLOSING)
        if depth < 0 or (depth == 0 and tokens[k].text == ","):
            return k
    return len(tokens)


def _where(text: str, tokens: Sequence[Piece], start: int, end: int) -> str | None:
    """The choice from `if` at `start` as a call of `where`; None where a part is missing."""
    then, other = _divider("then", tokens, start + 1, end), None
    if then is not None:
        other = _divider("else", tokens, then + 1, end)
    if then is None or other is None:
        return None
    parts = [(start + 1, then), (then + 1, other), (other + 1, end)]
    written = [_part(text, tokens, *part) for part in parts]
    return f"where({', '.join(written)})" if all(written) else None


def _divider(word: str, tokens: Sequence[Piece], start: int, end: int) -> int | None:
    """Where `word` stands that belongs to this choice, not to one within it."""
    depth = 0
    for k in range(start, end):
        if depth == 0 and tokens[k].text == word:
            return k
        depth += (tokens[k].text in {*OPENING, "if"}) - (tokens[k].text in {*CLOSING, "else"})
    return None


def _part(text: str, tokens: Sequence[Piece], start: int, end: int) -> str:
    """The text of some tokens; a choice within it is written anew, too."""
    if start >= end:
        return ""
    if tokens[start].text == "if":
        return _where(text, tokens, start, end) or ""
    return text[tokens[start].start : tokens[end - 1].end]

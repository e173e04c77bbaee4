"""What can be told of an expression's text token by token, before Python's own parser sees it.

The scan bounds what the parser gets (so that no text can exhaust it) and finds the mistakes that
Python would stop at: signs of other languages, missing values and operators, brackets. Signs are
repaired at equal length, so that the rest of the text can be read and judged as well.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import final

from spec_schema.expressions.choices import choice_in
from spec_schema.faults import Fault
from spec_schema.unit_names import table

LONGEST = 10_000
"""Characters in an expression."""

MOST_OPERATORS = 1_000
"""Operators and commas in an expression."""

DEEPEST_BRACKETS = 50
"""Brackets within brackets."""

REPAIRS: dict[str, tuple[str, str]] = {
    "&&": ("& ", "and"),
    "||": ("| ", "or"),
    "!": ("~", "not"),
    "=": ("<", "=="),
    "=<": ("<=", "<="),
    "=>": (">=", ">="),
    "<>": ("!=", "!="),
    "≤": ("<", "<="),
    "≥": (">", ">="),
    "≠": ("<", "!="),
    "×": ("*", "*"),
    "·": ("*", "*"),
    "⋅": ("*", "*"),
    "÷": ("/", "/"),
    "−": ("-", "-"),
    "∧": ("&", "and"),
    "∨": ("|", "or"),
    "¬": ("~", "not"),
    "²": (" ", "**2"),
    "³": (" ", "**3"),
}
"""Signs of other languages: what stands in for them while the rest is read; what to write."""

HELP: dict[str, str] = {
    "?": "write where(c, a, b) for 'a if c, else b'",
    "#": "a comment belongs outside the expression's text",
    "√": "write sqrt(...)",
    "°": "angles are in radians; write *pi/180",
    "$": "a name stands as it is, without a sign before it",
}

OPERAND_KEYWORDS = frozenset({"lambda", "await", "yield", "for", "while", "import", "def", "async"})
BINARY_KEYWORDS = frozenset({"and", "or", "if", "else", "in", "is"})
POSTFIX = frozenset("²³")
UNARY = frozenset({"-", "+", "~", "!", "¬", "−", "not"})
CLOSING = {"(": ")", "[": "]", "{": "}"}

UNIT = re.compile(r"(?P<name>[^\W\d]\w*?)(?:(?:\*\*|\^)-?\d+|[²³])?(?!\w)")
"""A unit's name with its power, as a quantity has it."""

TOKEN = re.compile(
    r"(?P<space>\s+)"
    r"|(?P<number>(?:\d[\d_]*\.?[\d_]*|\.\d[\d_]*)(?:[eE][+-]?\d+)?)"
    r"|(?P<pair>not\s+in\b|is\s+not\b)"
    r"|(?P<name>[^\W\d²³¹⁰-⁹][^\W²³¹⁰-⁹]*)"
    r"|(?P<text>'[^'\\\n]*'|\"[^\"\\\n]*\")"
    r"|(?P<sign>\*\*|//|<=|>=|==|!=|=<|=>|<>|&&|\|\||:=|->|[-+*/%<>=!&|^~@.,:()\[\]{}≤≥≠×·⋅÷−∧∨¬²³])"
    r"|(?P<other>.)",
    re.DOTALL,
)


@final
@dataclass(frozen=True, slots=True)
class Token:
    """A piece of the text; `kind` is number, pair, name, text, sign or other."""

    kind: str
    text: str
    start: int
    end: int

    @property
    def is_operand(self) -> bool:
        """Whether a value stands here."""
        return self.kind in {"number", "text"} or (
            self.kind == "name" and self.text not in BINARY_KEYWORDS and self.text != "not"
        )

    def fault(self, message: str, advice: str = "") -> Fault:
        """A syntax fault at this token."""
        return Fault(self.start, self.end, "S133", message, advice)


@final
@dataclass(frozen=True, slots=True)
class Scan:
    """A scanned text: `repaired` is as long as the text; None where reading on makes no sense."""

    repaired: str | None
    faults: tuple[Fault, ...]


def scan(text: str) -> Scan:
    """All faults that the tokens show, and the text with the harmless ones repaired."""
    if not text.strip():
        return Scan(None, (Fault(0, max(1, len(text)), "S131", "the expression is empty"),))
    if len(text) > LONGEST:
        return Scan(None, (_too_large(f"has {len(text)} characters (at most {LONGEST})"),))
    tokens = list(_tokens(text))
    operators = sum(t.kind == "sign" or t.text in BINARY_KEYWORDS | {"not"} for t in tokens)
    if operators > MOST_OPERATORS:
        return Scan(None, (_too_large(f"has {operators} operators (at most {MOST_OPERATORS})"),))
    if _depth(tokens) > DEEPEST_BRACKETS:
        return Scan(None, (_too_large(f"has over {DEEPEST_BRACKETS} brackets within brackets"),))
    choice = choice_in(text, tokens)
    if choice is not None:
        return Scan(None, (choice,))
    strange = [_strange(t) for t in tokens if t.kind == "other"]
    structure = [] if strange else [*_brackets(tokens), *_order(text, tokens)]
    repairs = [
        t.fault(f"'{t.text}' is not an operator here", f"write {REPAIRS[t.text][1]}")
        for t in tokens
        if t.text in REPAIRS
    ]
    found = tuple(sorted([*strange, *structure, *repairs]))
    return Scan(None if strange or structure else _repaired(text, tokens), found)


def _tokens(text: str) -> Iterator[Token]:
    for match in TOKEN.finditer(text):
        kind = str(match.lastgroup)
        if kind == "name" and not match.group().isidentifier():
            kind = "other"
        if kind != "space":
            yield Token(kind, match.group(), match.start(), match.end())


def _too_large(what: str) -> Fault:
    return Fault(
        0, 1, "S132", f"the expression {what}", "write it more briefly, or as a `module` field"
    )


def _strange(token: Token) -> Fault:
    if token.text in {"'", '"'}:
        return token.fault("this text is not closed on its line", "texts hold no quotes and no \\")
    shown = token.text if token.text.isprintable() else ascii(token.text)[1:-1]
    return token.fault(f"'{shown}' is not part of the language", HELP.get(token.text, ""))


def _depth(tokens: list[Token]) -> int:
    depth = deepest = 0
    for token in tokens:
        depth += (token.text in CLOSING) - (token.text in CLOSING.values())
        deepest = max(deepest, depth)
    return deepest


def _brackets(tokens: list[Token]) -> Iterator[Fault]:
    opened: list[Token] = []
    for token in tokens:
        if token.kind != "sign":
            continue
        if token.text in CLOSING:
            opened.append(token)
        elif token.text in CLOSING.values():
            if not opened or CLOSING[opened[-1].text] != token.text:
                yield token.fault(f"'{token.text}' closes nothing", "remove it, or open a bracket")
            else:
                opened.pop()
    yield from (t.fault(f"'{t.text}' is never closed", f"add '{CLOSING[t.text]}'") for t in opened)


def _order(text: str, tokens: list[Token]) -> Iterator[Fault]:
    """Values and operators must take turns; what is missing is said where it is missing."""
    before: Token | None = None
    needs_value = True
    for token in tokens:
        if token.text in OPERAND_KEYWORDS or token.text in {":", ":="}:
            return  # none of ours: the parser says what it is
        judge = _missing_value if needs_value else _missing_operator
        fault = judge(before, token)
        if fault and (literal := _literal_with_unit(text, before, token)):
            fault = literal
        if fault:
            yield fault
        needs_value = _needs_value_after(token, needs_value=needs_value)
        before = token
    if needs_value and before:
        advice = f"write it, or remove '{before.text}'"
        yield before.fault(f"a value is missing after '{before.text}'", advice)


def _missing_value(before: Token | None, token: Token) -> Fault | None:
    if token.is_operand or token.text in UNARY or token.text in CLOSING:
        return None
    if token.text in CLOSING.values() and before and before.text in {*CLOSING, ","}:
        # `()` is a call without arguments or an empty tuple, `,)` a trailing comma.
        return None
    if before is None or before.text in {*CLOSING, ","}:
        advice = f"write it, or remove '{token.text}'"
        return token.fault(f"a value is missing before '{token.text}'", advice)
    message = f"a value is missing between '{before.text}' and '{token.text}'"
    return Fault(before.start, token.end, "S133", message, "write it, or remove one of both")


def _missing_operator(before: Token | None, token: Token) -> Fault | None:
    if not before or not token.is_operand:
        return None
    if before.kind == "number" and token.kind == "name":
        advice = f"write {before.text}*{token.text}"
    else:
        advice = "write * for a product"
    message = f"an operator is missing between '{before.text}' and '{token.text}'"
    return Fault(before.start, token.end, "S133", message, advice)


def _literal_with_unit(text: str, before: Token | None, token: Token) -> Fault | None:
    """A fault where a unit follows a number: `5 cm`, or `5 m/s**2`."""
    unit = UNIT.match(text, token.start)
    if not before or before.kind != "number" or unit is None or unit["name"] not in table():
        return None
    end = unit.end()
    while text[end : end + 1] == "/" and (per := UNIT.match(text, end + 1)):
        if per["name"] not in table():
            break
        end = per.end()
    advice = (
        f"name it under `constants` (`margin: {{value: {before.text} {text[token.start : end]}, "
        f"unit: {text[token.start : end]}}}`) and write `margin` here"
    )
    if len(token.text) == 1:
        advice += f"; for a product with '{token.text}' write {before.text}*{token.text}"
    return Fault(before.start, end, "S133", "a number in an expression has no unit", advice)


def _needs_value_after(token: Token, *, needs_value: bool) -> bool:
    if token.is_operand or token.text in CLOSING.values():
        return False
    if token.text in POSTFIX:
        return needs_value
    return True


def _repaired(text: str, tokens: list[Token]) -> str:
    characters = [" " if c.isspace() else c for c in text]
    for token in tokens:
        if token.text in REPAIRS:
            characters[token.start : token.end] = REPAIRS[token.text][0]
    return "".join(characters)

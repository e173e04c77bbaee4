"""Which words can name a variable: ASCII identifiers that mean nothing else in an expression."""

import keyword
import re

from spec_schema.expressions.tree import FUNCTIONS

PATTERN = r"^[A-Za-z_][A-Za-z0-9_]{0,63}$"
"""Of the names of behaviors and variables."""

RESERVED = FUNCTIONS | frozenset(keyword.kwlist) | {"pi", "inhibit", "t"}
"""Words that an expression, or every behavior, already uses."""

_NAME = re.compile(PATTERN)


def why_no_name(text: str) -> str:
    """Why `text` can't name a variable; empty where it can."""
    if not _NAME.fullmatch(text):
        return "write at most 64 letters (a-z, A-Z), digits and '_', with no digit in front"
    return ""


def why_reserved(text: str) -> str:
    """What `text` already means in a spec; empty where it is free."""
    if text in FUNCTIONS:
        return "is a function of the expression language"
    meanings = {
        "pi": "is the number 3.14159...",
        "inhibit": "is the control parameter that every behavior has",
        "t": "is kept for time",
    }
    return meanings.get(text) or (
        "is a word of the expression language" if text in RESERVED else ""
    )

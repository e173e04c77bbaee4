"""Words for messages: how a user's text, a value or a list of words is shown."""

import json
import re
from collections.abc import Iterable

from spec_schema.scalars import resolve

_UNQUOTED = re.compile(r"(?:[\w/(.]|-\w)[^:#,\[\]{}\"'\n]*(?<! )")

LONGEST = 60
"""How many characters of a user's text a message repeats."""


def quoted(text: str) -> str:
    r"""The text in single quotes, short and harmless to a terminal.

    >>> quoted("gian"), quoted(chr(7))
    ("'gian'", "'\\x07'")
    """
    shown = text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}…"
    harmless = "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in shown)
    return f"'{harmless}'"


def described(value: object) -> str:
    """What a value is, for "expected a mapping, got ..."."""
    match value:
        case None:
            words = "nothing"
        case bool():
            words = "true" if value else "false"
        case int() | float():
            words = f"the number {number(value)}"
        case str():
            words = f"the text {quoted(value)}"
        case list() | tuple():
            words = "a list"
        case _:
            words = "a mapping"
    return words


def counted(count: int, noun: str) -> str:
    """A number of things.

    >>> counted(1, "axis"), counted(2, "axis"), counted(3, "number")
    ('1 axis', '2 axes', '3 numbers')
    """
    if count == 1:
        return f"1 {noun}"
    return f"{count} axes" if noun == "axis" else f"{count} {noun}s"


def with_article(noun: str) -> str:
    """A thing that is named for the first time.

    >>> with_article("saddle"), with_article("unstable focus")
    ('a saddle', 'an unstable focus')
    """
    return f"an {noun}" if noun[:1] in "aeiou" else f"a {noun}"


def number(value: float) -> str:
    """A number as the user would write it.

    >>> number(3.0), number(1e-3), number(float("inf"))
    ('3', '0.001', '.inf')
    """
    if value != value:  # noqa: PLR0124  # only nan differs from itself
        return ".nan"
    if value in (float("inf"), float("-inf")):
        return "-.inf" if value < 0 else ".inf"
    return f"{value:.12g}"


def listed(words: Iterable[str], *, last: str = "or") -> str:
    """The words as a sentence lists them.

    >>> listed(["a", "b", "c"])
    'a, b or c'
    """
    *most, end = words
    return f"{', '.join(most)} {last} {end}" if most else end


def as_yaml(value: object) -> str:
    """An example value as one writes it in a spec.

    >>> as_yaml([-2, 2]), as_yaml({"unit": "1", "domain": [0, 1]})
    ('[-2, 2]', '{unit: "1", domain: [0, 1]}')
    """
    match value:
        case dict():
            return "{" + ", ".join(f"{key}: {as_yaml(item)}" for key, item in value.items()) + "}"
        case list() | tuple():
            return "[" + ", ".join(map(as_yaml, value)) + "]"
        case str():
            return value if _is_plain(value) else json.dumps(value, ensure_ascii=False)
        case float() | int():
            return number(value)
    return str(value)


def _is_plain(text: str) -> bool:
    """Whether `text` needs no quotes anywhere in a spec, flow or block."""
    return isinstance(resolve(text), str) and _UNQUOTED.fullmatch(text) is not None

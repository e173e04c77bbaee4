"""What a plain YAML scalar means: the core schema of YAML 1.2 (section 10.3.2), and nothing else.

YAML 1.1, which most readers still follow, makes `no` false, `010` eight, `1:30` ninety and `1e-3` a
text. In a file of names and gains that is a trap.
"""

import re
from typing import TypeAlias

ScalarValue: TypeAlias = bool | int | float | str | None

_CONSTANTS: dict[str, ScalarValue] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL"), None),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys(
        (f"{sign}.{word}" for sign in ("", "+") for word in ("inf", "Inf", "INF")), float("inf")
    ),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), float("-inf")),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), float("nan")),
}
_DECIMAL = re.compile(r"[-+]?[0-9]{1,19}")
_BASED = re.compile(r"0(?:o[0-7]{1,21}|x[0-9a-fA-F]{1,16})")
_FLOAT = re.compile(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?")


def resolve(text: str) -> ScalarValue:
    """The value of an unquoted scalar; integers of more than 19 digits become floats.

    >>> [resolve(text) for text in ("1e-3", "010", "no", "1_000", "~")]
    [0.001, 10, 'no', '1_000', None]
    """
    if text in _CONSTANTS:
        return _CONSTANTS[text]
    if _DECIMAL.fullmatch(text):
        return int(text)
    if _BASED.fullmatch(text):
        return int(text, base=0)
    if _FLOAT.fullmatch(text):
        return float(text)
    return text

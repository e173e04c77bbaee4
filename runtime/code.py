"""Code: an expression in postfix form, as text that people can read and the machine can run.

`Code("x v * 2 pow")` is (x v)². A token is an operation of `ARITY`, a number, or the name of an
entry of the register. Comparisons and logic give 1 or 0.
"""

from dataclasses import dataclass
from typing import final

ARITY: dict[str, int] = {
    "add": 2,
    "sub": 2,
    "mul": 2,
    "div": 2,
    "mod": 2,
    "pow": 2,
    "neg": 1,
    "lt": 2,
    "le": 2,
    "gt": 2,
    "ge": 2,
    "eq": 2,
    "ne": 2,
    "and": 2,
    "or": 2,
    "not": 1,
    "where": 3,
    "abs": 1,
    "sign": 1,
    "min": 2,
    "max": 2,
    "clip": 3,
    "sqrt": 1,
    "hypot": 2,
    "exp": 1,
    "log": 1,
    "sin": 1,
    "cos": 1,
    "tan": 1,
    "asin": 1,
    "acos": 1,
    "atan": 1,
    "atan2": 2,
    "sinh": 1,
    "cosh": 1,
    "tanh": 1,
    "floor": 1,
    "wrap": 1,
}
"""Every operation and how many operands it takes. `wrap` maps an angle to (-pi, pi]."""


@final
@dataclass(frozen=True, slots=True)
class Code:
    """Postfix code; `text` is its tokens, separated by single spaces."""

    text: str

    @property
    def tokens(self) -> tuple[str, ...]:
        """The tokens in order."""
        return tuple(self.text.split(" "))


ONE = Code("1")

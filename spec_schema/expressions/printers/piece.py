"""A printed part of an expression, and when it needs brackets."""

from dataclasses import dataclass
from typing import final

OR, AND, NOT, COMPARISON, SUM, TERM, SIGN, POWER, ATOM = range(1, 10)
"""How tightly an operator binds; what binds less needs brackets inside what binds more."""

ARITHMETIC: dict[str, tuple[str, int]] = {
    "add": (" + ", SUM),
    "sub": (" - ", SUM),
    "mul": (" * ", TERM),
    "div": (" / ", TERM),
}
"""As C and Python write it, and how tightly it binds."""


@final
@dataclass(frozen=True, slots=True)
class Piece:
    """The text of a part, and how tightly its outermost operator binds."""

    text: str
    level: int = ATOM

    def inside(self, least: int) -> str:
        """The text, in brackets where it binds less tightly than `least`."""
        return self.text if self.level >= least else f"({self.text})"


def literal(value: float) -> Piece:
    """A number, exact to the last bit."""
    return Piece(repr(value), SIGN) if value < 0 else Piece(repr(value))


def joined(symbol: str, level: int, left: Piece, right: Piece) -> Piece:
    """Two parts with an operator between that groups from the left."""
    return Piece(f"{left.inside(level)}{symbol}{right.inside(level + 1)}", level)


def call(name: str, operands: tuple[Piece, ...]) -> Piece:
    """A function applied to the parts."""
    return Piece(f"{name}({', '.join(part.text for part in operands)})")

"""A printed part of an expression, and when it needs brackets."""

from dataclasses import dataclass
from typing import final

OR, AND, NOT, COMPARISON, SUM, TERM, SIGN, POWER, ATOM = range(1, 10)
"""How tightly an operator binds; what binds less needs brackets inside what binds more."""


@final
@dataclass(frozen=True, slots=True)
class Piece:
    """The text of a part, and how tightly its outermost operator binds."""

    text: str
    level: int = ATOM

    def inside(self, least: int) -> str:
        """The text, in brackets where it binds less tightly than `least`."""
        return self.text if self.level >= least else f"({self.text})"


def joined(symbol: str, level: int, left: Piece, right: Piece) -> Piece:
    """Two parts with an operator between that groups from the left."""
    return Piece(f"{left.inside(level)}{symbol}{right.inside(level + 1)}", level)


def call(name: str, operands: tuple[Piece, ...]) -> Piece:
    """A function applied to the parts."""
    return Piece(f"{name}({', '.join(part.text for part in operands)})")

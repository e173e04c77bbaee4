"""A text, and places in it. Lines and columns count from 1; ends are exclusive."""

from dataclasses import dataclass
from typing import final


@final
@dataclass(frozen=True, slots=True, order=True)
class Span:
    """From (line, column) up to but not including (end_line, end_column)."""

    line: int
    column: int
    end_line: int
    end_column: int


@final
@dataclass(frozen=True, slots=True)
class Source:
    """A spec's text and the name under which the user knows it."""

    name: str
    text: str

    def line(self, number: int) -> str:
        """The line `number`, without its end; empty where there is none."""
        lines = self.text.splitlines()
        return lines[number - 1] if 1 <= number <= len(lines) else ""

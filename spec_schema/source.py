"""A text, and places in it. Lines and columns count from 1; ends are exclusive."""

import re
from dataclasses import dataclass
from functools import lru_cache
from typing import final

_LINE_END = re.compile(r"\r\n|\n|\r")


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
        lines = _lines(self.text)
        return lines[number - 1] if 1 <= number <= len(lines) else ""


@lru_cache(maxsize=8)
def _lines(text: str) -> tuple[str, ...]:
    """The lines as YAML 1.2 and editors count them: a form feed, say, ends none."""
    return tuple(_LINE_END.split(text))

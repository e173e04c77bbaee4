"""What a report's page says, as data: texts are plain and get escaped, only figures are markup."""

from dataclasses import dataclass
from typing import final

from markupsafe import Markup


@final
@dataclass(frozen=True, slots=True)
class Plot:
    """A figure and how to read it."""

    svg: Markup
    caption: str


@final
@dataclass(frozen=True, slots=True)
class Table:
    """A table whose first column names its rows; words are set to the left, numbers to the right.

    first: so many columns after the names are words; last: so many at the end.
    """

    titles: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    first: int = 0
    last: int = 0

    def is_number(self, column: int) -> bool:
        """Whether a column holds numbers."""
        return self.first < column < len(self.titles) - self.last


@final
@dataclass(frozen=True, slots=True)
class Row:
    """One variable in the main table."""

    name: str
    standing: str
    cells: tuple[str, ...]


@final
@dataclass(frozen=True, slots=True)
class VariablePart:
    """The section of one variable."""

    name: str
    sentences: tuple[str, ...]
    figures: tuple[Plot, ...]
    horizons: Table | None


@final
@dataclass(frozen=True, slots=True)
class Block:
    """A piece of a part: sentences, then a figure, then a table; `title` may be empty."""

    title: str
    sentences: tuple[str, ...] = ()
    is_list: bool = False
    figure: Plot | None = None
    table: Table | None = None


@final
@dataclass(frozen=True, slots=True)
class Part:
    """A section of the page that explains the verdict."""

    title: str
    blocks: tuple[Block, ...]


@final
@dataclass(frozen=True, slots=True)
class Page:
    """The report of one trace, in the order in which it is read; word: for the verdict, if another.

    explanations: why the robot departs, and what else speaks of the robot. limits: how far the
    verdict reaches.
    """

    title: str
    verdict: str
    sign: str
    headline: str
    reasons: tuple[str, ...]
    columns: tuple[str, ...]
    rows: tuple[Row, ...]
    how: str
    overview: Plot | None
    explanations: tuple[Part, ...]
    variables: tuple[VariablePart, ...]
    coverage: tuple[str, ...]
    coverage_figure: Plot | None
    limits: tuple[Part, ...]
    exclusions: Table | None
    losses: Table | None
    notes: tuple[str, ...]
    provenance: tuple[tuple[str, str], ...]
    advice: tuple[str, ...]
    word: str = ""


@final
@dataclass(frozen=True, slots=True)
class RunRow:
    """One trace in the table of all: a link to its page, or why it can't be used.

    word: for the verdict, if another.
    """

    anchor: str
    source: str
    verdict: str
    sign: str
    cells: tuple[tuple[str, str], ...]
    reason: str
    word: str = ""


@final
@dataclass(frozen=True, slots=True)
class RunsTable:
    """Rows of like kind. columns: the titles of the rows' cells; a cell has a standing.

    words: whether cells are words, not numbers.
    """

    title: str
    first: str
    columns: tuple[str, ...]
    rows: tuple[RunRow, ...]
    how: str
    words: bool = False


@final
@dataclass(frozen=True, slots=True)
class RunsPage:
    """Many traces, or the parts of one, on one page; word: for the verdict, if another."""

    title: str
    verdict: str
    sign: str
    headline: str
    reasons: tuple[str, ...]
    advice: tuple[str, ...]
    tables: tuple[RunsTable, ...]
    pages: tuple[tuple[str, Page], ...]
    word: str = ""

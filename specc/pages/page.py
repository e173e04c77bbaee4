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
    """A table whose first column names its rows."""

    titles: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


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
class Page:
    """The whole page, in the order in which it is read."""

    title: str
    verdict: str
    sign: str
    headline: str
    reasons: tuple[str, ...]
    columns: tuple[str, ...]
    rows: tuple[Row, ...]
    how: str
    overview: Plot | None
    variables: tuple[VariablePart, ...]
    coverage: tuple[str, ...]
    coverage_figure: Plot | None
    exclusions: Table | None
    losses: Table | None
    notes: tuple[str, ...]
    provenance: tuple[tuple[str, str], ...]
    advice: tuple[str, ...]

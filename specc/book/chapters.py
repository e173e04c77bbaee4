"""What a page of a book says, as data: the HTML and the PDF are both laid out from it.

Texts are plain, with `code` in backticks and links as [words](page): a page by its name, or a file
of the book by its path. Anything else in them is shown as it stands.
"""

from dataclasses import dataclass
from typing import TypeAlias, final


@final
@dataclass(frozen=True, slots=True)
class Paragraph:
    """Sentences. is_small: an explanation beside what it explains."""

    text: str
    is_small: bool = False


@final
@dataclass(frozen=True, slots=True)
class Heading:
    """A title within a section."""

    text: str


@final
@dataclass(frozen=True, slots=True)
class Bullets:
    """A list; is_ordered: of steps, in order."""

    items: tuple[str, ...]
    is_ordered: bool = False


@final
@dataclass(frozen=True, slots=True)
class Table:
    """A table whose first column names its rows. numbers: the columns that are set to the right."""

    titles: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numbers: tuple[int, ...] = ()


@final
@dataclass(frozen=True, slots=True)
class Figure:
    """A picture of the book, by its name in `figures/`; caption: how to read it.

    alt: what it shows, to those who can't see it. width: of the PDF's text width, at most.
    is_wide: at its own size: on pages it is scrolled, in the PDF it has a page of that size.
    """

    name: str
    caption: str
    alt: str
    width: float = 1.0
    is_wide: bool = False


@final
@dataclass(frozen=True, slots=True)
class Formulas:
    """Equations, each a left and a right side and a remark."""

    rows: tuple[tuple[str, str, str], ...]


@final
@dataclass(frozen=True, slots=True)
class Listing:
    """Text of a file, with what it is written in: yaml, python or shell."""

    text: str
    language: str


Block: TypeAlias = Heading | Paragraph | Bullets | Table | Figure | Formulas | Listing


@final
@dataclass(frozen=True, slots=True)
class Section:
    """A part of a page."""

    title: str
    blocks: tuple[Block, ...]


@final
@dataclass(frozen=True, slots=True)
class Chapter:
    """A page: `name` is what links say, `kind` stands above its title, `lead` below."""

    name: str
    kind: str
    title: str
    lead: str
    sections: tuple[Section, ...]

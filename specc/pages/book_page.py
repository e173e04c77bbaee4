"""The pages of a book as HTML files that link to one another, also without a server."""

import re
from collections.abc import Mapping
from functools import partial
from typing import Final

import jinja2
from markupsafe import Markup

from specc.book.chapters import Block, Chapter
from specc.pages.listing import listing
from specc.pages.prose import prose

FRONT: Final = "index.html"
LINK: Final = re.compile(r"\[([^\]\[\n]+)\]\(([\w./-]+)\)")
"""A link to a page, or to a file of the book."""


def book_pages(
    title: str, chapters: tuple[Chapter, ...], files: frozenset[str]
) -> dict[str, bytes]:
    """Every page by its path: the first chapter is `index.html`, the others lie in `pages/`.

    files: those of the book that texts may link to.
    """
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("specc.pages"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["kind"] = kind_of
    environment.filters["listing"] = listing
    template = environment.get_template("book.html.j2")
    sheets = [environment.get_template(name).render() for name in ("report.css", "book.css")]
    style = Markup("\n".join(sheets))  # noqa: S704  the style sheets are ours
    places = {c.name: FRONT if k == 0 else f"pages/{c.name}.html" for k, c in enumerate(chapters)}
    found = {}
    for k, chapter in enumerate(chapters):
        up = "" if k == 0 else "../"
        targets = {file: up + file for file in files} | {n: up + p for n, p in places.items()}
        page = template.render(
            book=title,
            chapter=chapter,
            chapters=chapters,
            before=chapters[k - 1] if k else None,
            after=chapters[k + 1] if k + 1 < len(chapters) else None,
            targets=targets,
            said=partial(said, targets=targets),
            up=up,
            style=style,
        )
        found[places[chapter.name]] = page.encode()
    return found


def said(text: str, targets: Mapping[str, str]) -> Markup:
    """A text with its code and its links; a link to what is not in the book is its words alone.

    >>> str(said("`a < b`, see [this](x)", {"x": "pages/x.html"}))
    '<code>a &lt; b</code>, see <a href="pages/x.html">this</a>'
    """
    pieces = LINK.split(text)
    found = Markup("")
    for k in range(0, len(pieces), 3):
        found += prose(pieces[k])
        if k + 2 < len(pieces):
            words, target = pieces[k + 1 : k + 3]
            place = targets.get(target)
            found += (
                Markup('<a href="{}">{}</a>').format(place, prose(words)) if place else prose(words)
            )
    return found


def kind_of(block: Block) -> str:
    """What a block is, as the template asks for it."""
    return type(block).__name__

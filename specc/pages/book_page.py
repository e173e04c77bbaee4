"""The pages of a book as HTML files that link to one another, also from a folder of files."""

from typing import Final

import jinja2
from markupsafe import Markup

from specc.book.chapters import Chapter
from specc.pages.prose import prose

FRONT: Final = "index.html"


def book_pages(title: str, chapters: tuple[Chapter, ...]) -> dict[str, bytes]:
    """Every page by its path: the first chapter is `index.html`, the others lie in `pages/`."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("specc.pages"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["prose"] = prose
    template = environment.get_template("book.html.j2")
    sheets = [environment.get_template(name).render() for name in ("report.css", "book.css")]
    style = Markup("\n".join(sheets))  # noqa: S704  the style sheets are ours
    places = {c.name: FRONT if k == 0 else f"pages/{c.name}.html" for k, c in enumerate(chapters)}
    found = {}
    for chapter in chapters:
        up = "" if places[chapter.name] == FRONT else "../"
        page = template.render(
            book=title, chapter=chapter, chapters=chapters, places=places, up=up, style=style
        )
        found[places[chapter.name]] = page.encode()
    return found

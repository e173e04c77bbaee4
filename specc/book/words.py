"""The pages of a book, in the order in which they are read."""

from specc.book.chapters import Chapter, Figure, Section, Table
from specc.book.contents import Contents, Drawn, Shown
from specc.book.naming import Names


def chapters_of(contents: Contents, names: Names) -> tuple[Chapter, ...]:
    """All chapters; the first one is the book's front page."""
    pages = [_node(of, shown, names) for of in contents.architectures for shown in of.nodes]
    rows = tuple((f"[{page.title}]({page.name})", page.kind, page.lead) for page in pages)
    table = Table(("module", "is", "does"), rows)
    front = Chapter("index", "book", contents.name, contents.about, (Section("Modules", (table,)),))
    return (front, *pages)


def _node(of: Drawn, shown: Shown, names: Names) -> Chapter:
    node, made = shown.node, of.architecture
    figures = tuple(
        Figure(names.portrait(made, node, k), setting.name)
        for k, (setting, _) in enumerate(shown.portraits)
    )
    return Chapter(
        names.stem(made, node), "behavior", node.name, "", (Section("Portraits", figures),)
    )

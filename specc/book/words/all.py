"""All pages of a book, in the order in which they are read."""

from specc.book.chapters import Chapter
from specc.book.contents import Contents, Drawn, Shown
from specc.book.naming import Names
from specc.book.words.arbiter import arbiter_chapter, module_chapter
from specc.book.words.behavior import behavior_chapter
from specc.book.words.building import building_chapter
from specc.book.words.front import front_chapter
from specc.book.words.overview import overview_chapter
from specc.book.words.required import scenario_chapter


def chapters_of(contents: Contents, names: Names, *, with_pdf: bool) -> tuple[Chapter, ...]:
    """All chapters; the first one is the book's front page, which names book.pdf if it is made."""
    found: list[Chapter] = [building_chapter(contents, names)]
    if contents.scenario is not None:
        found.append(scenario_chapter(contents, contents.scenario, names))
    for of in contents.architectures:
        found.append(overview_chapter(of, names))
        nodes = sorted(of.nodes, key=lambda shown: shown.node.level)
        found += [_of_node(of, shown, names) for shown in nodes]
    return (front_chapter(contents, tuple(found), with_pdf=with_pdf), *found)


def _of_node(of: Drawn, shown: Shown, names: Names) -> Chapter:
    if shown.node.behavior >= 0:
        return behavior_chapter(of, shown, names)
    if shown.node.arbiter >= 0:
        return arbiter_chapter(of, shown, names)
    return module_chapter(of, shown, names)

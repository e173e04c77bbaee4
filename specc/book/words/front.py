"""The front page: what the book is about, what is in it, and how it is read."""

from collections.abc import Iterator

from specc.book.chapters import Block, Bullets, Chapter, Paragraph, Section, Table
from specc.book.contents import Contents
from specc.book.words.prose import prose
from specc.figures.quantities import seconds
from verifier.report.requirement_results import Outcome


def front_chapter(contents: Contents, chapters: tuple[Chapter, ...], *, with_pdf: bool) -> Chapter:
    """The first page, with links to all others."""
    modules = sum(len(of.nodes) for of in contents.architectures)
    files = Table(("file", "what it holds"), tuple(_files(contents, with_pdf=with_pdf)))
    return Chapter(
        "index",
        f"specifications of {'an architecture' if contents.scenario is None else 'a scenario'}",
        contents.name,
        contents.about,
        (
            Section("What this book is", tuple(_about(contents, modules))),
            Section("Contents", tuple(_contents(chapters))),
            *_result(contents),
            Section("Files", (files,)),
            Section("How to read it", (Bullets(prose("reading")),)),
        ),
    )


def _about(contents: Contents, modules: int) -> Iterator[Block]:
    yield Paragraph(
        f"It specifies the {modules} modules of {contents.name} so completely that a robot can be"
        " built from it alone: each behavior by its phase space, the field on it and its control"
        " interface, each control module by its decisions, and how they are wired. It says nothing"
        " about how any of it is implemented."
    )
    yield Paragraph(
        "All of it was generated from the specs in the folder `specs/`, and from what was computed"
        " from them; no number was typed by hand. Begin with the [architecture](architecture)"
        " to see the whole, with [how to build it](building) to see what to do."
        if len(contents.architectures) == 1
        else "All of it was generated from the specs in the folder `specs/`, and from what was"
        " computed from them. Begin with [how to build it](building)."
    )


def _contents(chapters: tuple[Chapter, ...]) -> Iterator[Block]:
    rows = tuple((f"[{c.title}]({c.name})", c.kind, c.lead) for c in chapters)
    yield Table(("page", "is", "about"), rows)


def _result(contents: Contents) -> Iterator[Section]:
    if contents.scenario is None or not contents.results:
        return
    met = sum(each.outcome is Outcome.SATISFIED for each in contents.results)
    of = len(contents.results)
    count = "what is required was met" if met == of == 1 else f"{met} of {of} requirements were met"
    lasts = seconds(contents.scenario.duration)
    yield Section(
        "What a run showed",
        (
            Paragraph(
                f"In the scenario's own run (seed {contents.scenario.seed}, {lasts}) {count}:"
                " see [the scenario](scenario)."
            ),
        ),
    )


def _files(contents: Contents, *, with_pdf: bool) -> Iterator[tuple[str, str]]:
    yield ("[book.json](book.json)", "everything here that programs may want, with checksums")
    if with_pdf:
        yield ("`pages/`, [book.pdf](book.pdf)", "these pages; the same as one document")
    else:
        yield ("`pages/`", "these pages")
    yield ("`specs/`", "every spec, as its author wrote it: " + _specs(contents))
    name = contents.artifact_name
    yield (f"[{name}]({name})", "the compiled program, which specc runs and verifies against")
    yield (
        "`data/`",
        "fields and outputs as tables, with [a reader](data/read_table.py); test procedures",
    )
    yield ("`figures/`", "the figures as SVG, for light and for dark pages")


def _specs(contents: Contents) -> str:
    return ", ".join(f"[{n.partition('/')[2]}]({n})" for n in contents.sources.names.values())

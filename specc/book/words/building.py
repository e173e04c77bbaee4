"""The page on how to build the robot and check it: stages 5 and 6 of the approach."""

from collections.abc import Iterator

from specc.book.chapters import Block, Bullets, Chapter, Listing, Paragraph, Section, Table
from specc.book.contents import Contents, Drawn
from specc.book.naming import Names
from specc.book.words.prose import prose
from specc.book.words.quantities import listed
from specc.book.words.recording import TITLE, recording_section
from specc.book.words.wiring import link

LEAD = "What to do with this book: build each module by itself, check it, then join them."


def building_chapter(contents: Contents, names: Names) -> Chapter:
    """Stages 5 and 6, module by module."""
    return Chapter(
        "building",
        "guide",
        "How to build it and check it",
        LEAD,
        (
            Section("The idea", _paragraphs("building_idea")),
            Section("Stage 5: the base behaviors", tuple(_behaviors(contents, names))),
            Section("Stage 6: the control architecture", tuple(_modules(contents, names))),
            recording_section(contents, names),
            Section("Checking with specc", tuple(_checking(contents))),
            Section("Checking without specc", _paragraphs("building_without")),
            Section("Where robot and book differ", (Bullets(prose("building_differing")),)),
        ),
    )


def _paragraphs(name: str) -> tuple[Block, ...]:
    return tuple(map(Paragraph, prose(name)))


def _behaviors(contents: Contents, names: Names) -> Iterator[Block]:
    yield Bullets(prose("building_behaviors"), is_ordered=True)
    rows = [row for of in contents.architectures for row in _rows(of, names)]
    yield Table(("behavior", "needs a measurement of", "moves", "may be off by"), tuple(rows))


def _rows(of: Drawn, names: Names) -> Iterator[tuple[str, ...]]:
    made = of.architecture
    for node in made.nodes:
        if node.behavior < 0:
            continue
        program = made.programs[node.behavior]
        sensed = [s.name for s in program.states if any(w.entry == s.name for w in node.inputs)]
        driven = [s.name for s in program.states if s.is_driven and s.name != program.field.mode]
        tolerances = "–"
        if program.fidelity is not None:
            units = {s.name: s.unit for s in program.states}
            tolerances = listed(
                f"`{name}` {value / units[name].scale:.4g} {units[name].text}"
                for name, value in program.fidelity.tolerance.items()
            )
        yield (
            link(made, node, names),
            listed(f"`{name}`" for name in sensed),
            listed(f"`{name}`" for name in driven),
            tolerances,
        )


def _modules(contents: Contents, names: Names) -> Iterator[Block]:
    yield Bullets(prose("building_modules"), is_ordered=True)
    levels: dict[int, list[str]] = {}
    for of in contents.architectures:
        for node in of.architecture.nodes:
            if node.behavior < 0:
                levels.setdefault(node.level, []).append(link(of.architecture, node, names))
    rows = tuple((f"level {level}", listed(levels[level])) for level in sorted(levels))
    if rows:
        yield Table(("build", "modules"), rows)


def _checking(contents: Contents) -> Iterator[Block]:
    yield Paragraph("Whoever has specc judges all modules against all recordings at once:")
    yield Listing("specc verify book/ runs/*.csv", "shell")
    yield Paragraph(
        f"`runs` holds recordings as above (“{TITLE}”), of any of the modules, and of any"
        " format. It says of every module whether it is done, fails, or lacks data: its recordings"
        " together get PASS, FAIL or INCONCLUSIVE; one that fails by itself fails the module. Of"
        " what lacks data it says what is still to be recorded; of modules of which nothing was"
        " recorded `--procedures` prints that. With `--only NAME,NAME` these modules count alone,"
        " and the exit status is 0 as soon as they are done. `-o report.html` writes a page with"
        " what explains each verdict."
    )
    yield Paragraph(
        "The program in this book is"
        f" [{contents.artifact_name}]({contents.artifact_name}); the same one is made from the"
        " specs in it, byte for byte:"
    )
    yield Listing(
        f"specc compile book/\ncmp {contents.name}.specc book/{contents.artifact_name}", "shell"
    )
